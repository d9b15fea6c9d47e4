#include <incise/core/error.hpp>
#include <incise/studio/access.hpp>

#include <sys/random.h>

#include <array>

namespace incise::studio {
namespace {

bool is_this_machine(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const std::string_view name = host.substr(0, colon);
  if (name != "localhost" && name != "127.0.0.1") return false;
  if (colon == std::string_view::npos) return true;
  const std::string_view port = host.substr(colon + 1);
  return !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Takes equally long for any text of that length, so its time does not reveal where the texts differ.
bool is_same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

bool is_own_page(const RequestInfo& request) {
  if (!request.origin.empty() && request.origin != "http://" + std::string(request.host)) return false;
  return request.fetch_site.empty() || request.fetch_site == "same-origin" || request.fetch_site == "none";
}

bool is_json(std::string_view content_type) {
  return content_type.substr(0, content_type.find(';')) == "application/json";
}

}  // namespace

std::optional<Refusal> refusal_of(const RequestInfo& request, std::string_view token) {
  INCISE_REQUIRE(!token.empty(), "expected a token");
  if (!is_this_machine(request.host)) return Refusal{403, "The Host of a request must be localhost or 127.0.0.1."};
  const bool is_api = request.target.starts_with("/api/");
  if (request.method != "GET" && !(is_api && request.method == "POST"))
    return Refusal{405, "Only GET is allowed, and POST below /api/."};
  if (!is_api) return std::nullopt;
  if (!is_own_page(request)) return Refusal{403, "A request must come from the studio's own page."};
  if (!is_same(request.token, token))
    return Refusal{401, "The token is missing or from another start: open the address that incise studio printed."};
  if (request.method == "POST" && !is_json(request.content_type))
    return Refusal{415, "A POST must be application/json."};
  return std::nullopt;
}

std::string new_token() {
  std::array<unsigned char, 16> bytes;
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error("the system gave no random numbers for the token");
  static constexpr std::string_view digits = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : bytes) {
    token += digits[byte >> 4];
    token += digits[byte & 15];
  }
  return token;
}

}  // namespace incise::studio
