#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace incise::studio {

/// What a request says of itself, as far as it decides whether it is answered. Header fields that are missing are
/// empty.
struct Asked {
  std::string_view method;        ///< GET, POST, …
  std::string_view target;        ///< path and query
  std::string_view host;          ///< `Host`
  std::string_view token;         ///< `X-Incise-Token`
  std::string_view content_type;  ///< `Content-Type`
  std::string_view origin;        ///< `Origin`: where a page that asks comes from
  std::string_view fetch_site;    ///< `Sec-Fetch-Site`: how the browser sees that page
};

struct Refusal {
  unsigned status = 403;  ///< of HTTP
  std::string why;        ///< one sentence
};

/// Whether a request is answered: it names this machine as `localhost` or `127.0.0.1`, with any port; comes from no
/// foreign page; is a GET, or a POST of JSON; and below /api/ has the token. Nothing: it is answered.
/// @param token  of this server; not empty.
[[nodiscard]] std::optional<Refusal> refusal_of(const Asked& asked, std::string_view token);

/// A new token: 128 random bits of the system as 32 hex digits. @throws Error where the system gives none.
[[nodiscard]] std::string new_token();

}  // namespace incise::studio
