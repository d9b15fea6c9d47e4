#pragma once

#include <filesystem>

namespace incise {

/// What an output folder of a case holds beside its folders of results (study.json, report.html, manifest.json,
/// figures) has to be of an earlier run, and no link. @throws DataError for one that is not; CaseError for the root of
/// all files.
void require_own_files(const std::filesystem::path& output);

/// The same of a page, and of the figures that are drawn beside it. @throws DataError
void require_own_page(const std::filesystem::path& page);

/// The manifest that is written beside a result of one file. @throws DataError
void require_own_manifest_beside(const std::filesystem::path& result);

/// A robot program in the place of a new one has to be of `incise export`, and no link: what a laboratory wrote itself
/// cannot be made again. @throws DataError
void require_own_program(const std::filesystem::path& program);

}  // namespace incise
