#pragma once

#include <string_view>

namespace incise {

/// Version of the library, "0.1.0".
[[nodiscard]] std::string_view version();
/// Commit of the sources that this was built from, 40 hex digits, "-dirty" appended when files were changed; "unknown" outside a repository.
[[nodiscard]] std::string_view source_commit();
/// SHA-256 of the names and contents of the sources that this was built from, whether they are committed or not, of the
/// version, and of compiler, build type and flags; 64 hex digits: the code version in a cache's keys. Two commits that
/// differ in documents or tests alone share it.
[[nodiscard]] std::string_view source_digest();

}  // namespace incise
