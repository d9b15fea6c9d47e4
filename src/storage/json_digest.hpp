#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace incise {

/// The key under which a file carries the digest of its other content.
inline constexpr const char* kDigestKey = "digest_sha256";

/// Returns the SHA-256 of the document's compact JSON without that key.
[[nodiscard]] std::string digest_of(nlohmann::ordered_json document);

}  // namespace incise
