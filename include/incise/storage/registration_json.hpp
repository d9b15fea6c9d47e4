#pragma once

#include <incise/registration/register_clouds.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// A cloud that a registration was made from.
struct RegistrationInput {
  std::string key;   ///< of its digest: source_sha256, target_sha256
  std::string path;  ///< as `incise register` was given it
  std::string sha256;
};

/// Adds `digest_sha256`, that of the document's compact text without this key: by it read_registration knows what
/// `incise register` wrote from what was typed or changed. It guards against slips, not against forgers.
void seal_registration(nlohmann::ordered_json& document);

/// What a file says of a registration. Another program's may hold the transform alone.
struct RegistrationRecord {
  std::optional<Mat4> T_target_source;  ///< similarity, mm; absent where the file has null: none was found
  double scale = 1.0;                   ///< that of the matrix
  double camera_scale = 1.0;            ///< what `incise surface` had taken out of the target before
  std::optional<double> rmse_mm;
  std::optional<double> inlier_fraction;
  std::optional<bool> is_converged;
  std::optional<double> scale_sd;  ///< relative
  std::vector<RegistrationInput> inputs;  ///< those whose name and digest it states
  std::string target_sha256;       ///< of the measured cloud that it was found on; empty: not stated
  bool is_sealed = false;          ///< it carries the digest of what `incise register` wrote
  std::vector<std::string> doubts;  ///< what `incise register` found against it, worst first, for a person
};

/// Reads registration.json. @throws DataError for a file that is missing or damaged, without the key T_target_source,
/// with a number that is none or that nothing has (a negative residual, more than all points), or that contradicts
/// itself: another scale than the matrix has, converged beside another outcome, beside a scale at its limit or without
/// a matrix; and for a digest that is another: it was changed after it was written.
[[nodiscard]] RegistrationRecord read_registration(const std::filesystem::path& file);

}  // namespace incise
