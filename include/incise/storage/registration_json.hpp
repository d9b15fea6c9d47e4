#pragma once

#include <incise/registration/register_clouds.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// A cloud that was registered.
struct RegistrationInput {
  std::string key;   ///< key of its digest in the file: source_sha256 or target_sha256
  std::string path;  ///< as given to `incise register`
  std::string sha256;
};

/// Adds the key `digest_sha256`: SHA-256 of the document's compact text without this key. By it, read_registration
/// distinguishes a file of `incise register` from one that was typed or changed. It protects against slips, not against
/// forgery.
void seal_registration(nlohmann::ordered_json& document);

/// Content of a registration file. A file from another program may hold the transform alone.
struct RegistrationRecord {
  std::optional<Mat4> T_target_source;  ///< similarity, mm; absent: null in the file, none was found
  double scale = 1.0;                   ///< of the matrix
  double camera_scale = 1.0;            ///< scale that `incise surface` removed from the target before
  std::optional<double> rmse_mm;
  std::optional<double> inlier_fraction;
  std::optional<bool> is_converged;
  std::optional<double> scale_sd;  ///< relative
  std::vector<RegistrationInput> inputs;  ///< the clouds for which the file states path and digest
  std::string target_sha256;       ///< of the measured cloud; empty: not stated
  bool is_sealed = false;          ///< the file carries the digest of seal_registration
  std::vector<std::string> doubts;  ///< objections of `incise register`, worst first, for a person
};

/// Reads registration.json.
/// @throws DataError if the file is missing or damaged; has no key T_target_source; has a value of the wrong type or an
///         impossible number (a negative residual, an inlier fraction above 1); contradicts itself (a scale that is not
///         the matrix's; `converged` with another outcome, with a scale at its limit, or without a matrix); or has
///         changed since it was written (its digest differs).
[[nodiscard]] RegistrationRecord read_registration(const std::filesystem::path& file);

}  // namespace incise
