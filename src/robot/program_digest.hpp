#pragma once

#include <incise/robot/program_reading.hpp>

#include <string>
#include <string_view>

namespace incise::robot_detail {

inline constexpr const char* kDigestKey = "digest";

/// The header with an entry for the digest, still of zeros; an empty one stays empty.
[[nodiscard]] ProgramHeader with_digest_entry(ProgramHeader header);

/// The program's text with its digest: SHA-256 over all of it, the digest's own 64 digits taken as zeros. A text
/// without an entry for it stays as it is. @pre what with_digest_entry made was written once, as a line or into JSON.
[[nodiscard]] std::string sealed(std::string text);

/// Whether a text is the one that was sealed, to the byte.
[[nodiscard]] ProgramDigest digest_state(std::string_view text, const ProgramHeader& header);

}  // namespace incise::robot_detail
