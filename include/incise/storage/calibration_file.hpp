#pragma once

#include <incise/calibration/calibration.hpp>
#include <incise/core/described_json.hpp>
#include <incise/io/table_io.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/calibrate.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <filesystem>

namespace incise {

/// Returns Table I, one row per speed and dullness: these two, drag length, outcome, stiffness factor and errors of
/// each specimen, pooled errors, and scores in per cent. Units are in the header. A failed run has empty fields for its
/// absolute errors; its outcome is `failure`, or how the cut ended.
[[nodiscard]] TextTable calibration_table(const Calibration& calibration);
/// Returns the same table rounded as in the paper, for LaTeX.
[[nodiscard]] TextTable calibration_table_rounded(const Calibration& calibration);

/// Reads the file of `incise calibrate`, without the contours of its runs and the rows of its table.
/// @throws DataError naming the file and the place that is missing, of another type, or out of range.
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& path);

/// Returns what a calibration predicts about the next specimen. @param path  its file, for messages
/// @throws DataError for a calibration without a posterior (--method paper), without a setting with which a simulated
///         ring closed, without rings (written by an older version), or with error profiles that differ in length, have
///         fewer than 9 or more than 360 sectors, or exceed 10 mm.
[[nodiscard]] CalibratedBelief belief_of(const Calibration& calibration, const std::filesystem::path& path);

/// Returns the measured values of a calibration's specimens, for comparison with another specimen. Includes the Young's
/// modulus of a specimen only if its pull force was measured.
[[nodiscard]] CalibratedRange range_of(const Calibration& calibration);

}  // namespace incise
