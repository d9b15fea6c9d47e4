#pragma once

#include <string_view>

namespace incise {

/// Returns the version of the library, such as "0.1.0".
[[nodiscard]] std::string_view version();
/// Returns the commit of the sources of this build, 40 hex digits, with "-dirty" appended if tracked files were
/// changed; "unknown" outside a repository.
[[nodiscard]] std::string_view source_commit();
/// Returns the SHA-256 of the names and contents of the sources of this build, committed or not, of the version, and of
/// compiler, build type and flags; 64 hex digits. It is the code version in a cache's keys. Two commits that differ
/// only in documents or tests share it.
[[nodiscard]] std::string_view source_digest();

}  // namespace incise
