#pragma once

#include <incise/robot/program_reading.hpp>

#include <string>
#include <string_view>

namespace incise::robot_detail {

inline constexpr const char* kDigestKey = "digest";

/// Returns the header with an entry for the digest, whose digits are still zeros. An empty header stays empty.
[[nodiscard]] ProgramHeader with_digest_entry(ProgramHeader header);

/// Returns the program's text with its digest: SHA-256 over the whole text, with the digest's own 64 digits taken as
/// zeros. A text without an entry for the digest is not changed.
/// @pre the entry from with_digest_entry was written once, as a line or into JSON.
[[nodiscard]] std::string sealed(std::string text);

/// Compares a text with its digest: Matches if it is the sealed text, to the byte.
[[nodiscard]] ProgramDigest digest_state(std::string_view text, const ProgramHeader& header);

}  // namespace incise::robot_detail
