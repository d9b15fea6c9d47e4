#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace incise::studio {

/// The parts of an HTTP request that decide whether it is answered. A missing header field is empty.
struct RequestInfo {
  std::string_view method;        ///< GET, POST, …
  std::string_view target;        ///< path and query
  std::string_view host;          ///< `Host`
  std::string_view token;         ///< `X-Incise-Token`
  std::string_view content_type;  ///< `Content-Type`
  std::string_view origin;        ///< `Origin`: the page that made the request
  std::string_view fetch_site;    ///< `Sec-Fetch-Site`: the browser's classification of that page
};

struct Refusal {
  unsigned status = 403;  ///< of HTTP
  std::string why;        ///< one sentence
};

/// Decides whether a request is answered. It is answered if it names this machine as `localhost` or `127.0.0.1`, with
/// any port, does not come from a foreign page, is a GET or a POST of JSON, and has the token if its target is below
/// /api/.
/// @param token  of this server; not empty.
/// @returns why the request is refused; absent: it is answered.
[[nodiscard]] std::optional<Refusal> refusal_of(const RequestInfo& request, std::string_view token);

/// Returns a new token: 128 random bits of the system as 32 hex digits. @throws Error if the system provides none.
[[nodiscard]] std::string new_token();

}  // namespace incise::studio
