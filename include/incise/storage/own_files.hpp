#pragma once

#include <filesystem>

namespace incise {

/// Checks that an output folder is no link and that its study.json, manifest.json, report.html and figures, where they
/// exist, are no links and were written by an earlier run.
/// @throws DataError for the first that is not; CaseError if `output` is the root of the file system.
void require_own_files(const std::filesystem::path& output);

/// Checks the same for a page and the folder `figures` beside it. @throws DataError
void require_own_page(const std::filesystem::path& page);

/// Checks the same for the manifest beside a single-file result (manifest_beside). @throws DataError
void require_own_manifest_beside(const std::filesystem::path& result);

/// Checks that an existing robot program, about to be replaced, is no link and was written by incise: a program that a
/// laboratory wrote itself cannot be made again. @throws DataError
void require_own_program(const std::filesystem::path& program);

}  // namespace incise
