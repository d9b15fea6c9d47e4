#pragma once

#include <incise/core/monitor.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace incise::cli {

/// Writes a folder with a virtual specimen, all or nothing: the CT (dicom: ct/, nrrd: ct.nrrd, nifti: ct.nii.gz), tumor.csv (the edge,
/// marked where it is to lie on the stretched tissue), case.yaml, and truth.json for tests.
/// @returns the summary: volume, spacing_mm, size.
nlohmann::ordered_json write_phantom_case(const std::filesystem::path& folder, std::uint64_t seed, const std::string& format,
                                          Monitor& monitor);

}  // namespace incise::cli
