#pragma once

#include <incise/calibration/calibration.hpp>
#include <incise/core/described_json.hpp>
#include <incise/io/table_io.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/calibrate.hpp>
#include <incise/workflow/robust_correction.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise {

/// Table I: speed, dullness, drag length, stiffness, each specimen's absolute error, the pooled columns, per cent.
/// Header with units; a failure is an empty field and `failure` in the column outcome.
[[nodiscard]] TextTable calibration_table(const Calibration& calibration);
/// The same rounded as the paper prints it, for LaTeX.
[[nodiscard]] TextTable calibration_table_rounded(const Calibration& calibration);

/// What `incise calibrate` wrote, without the contours of its runs and the rows of its table.
/// @throws DataError naming the file and the place that is missing, of another kind, or out of range.
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& path);

/// What it says of the next specimen. @param path  of the file, for the message.
/// @throws DataError for a calibration without a posterior (--method paper), without a setting that worked, without
/// rings (of an older version), or with profiles that do not go together.
[[nodiscard]] CalibratedBelief belief_of(const Calibration& calibration, const std::filesystem::path& path);

/// What it says of its specimens, to hold a further one against. A modulus counts only where the pull was measured.
[[nodiscard]] CalibratedRange range_of(const Calibration& calibration);

}  // namespace incise
