#include <incise/core/error.hpp>
#include <incise/core/sha256.hpp>
#include <incise/io/camera_scale.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/storage/registration_json.hpp>

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDigestKey = "digest_sha256";

/// Returns the SHA-256 of the document's compact JSON without its digest.
std::string digest_of(Json document) {
  document.erase(kDigestKey);
  return sha256_of_text(document.dump());
}

/// @returns whether the document carries its digest.  @throws DataError if the digest is wrong.
bool has_its_digest(const Json& document, const std::filesystem::path& file) {
  const auto found = document.find(kDigestKey);
  if (found == document.end()) return false;
  const std::string expected = digest_of(document);
  if (!found->is_string() || found->get<std::string>() != expected) {
    throw DataError(file, std::string("/") + kDigestKey, found->dump(),
                    expected + ", the digest of this file's contents",
                    "The file was changed after it was written: register again.");
  }
  return true;
}

std::vector<std::string> doubts_in(const Json& document, const std::filesystem::path& file) {
  const auto found = document.find("reasons");
  if (found == document.end()) return {};
  const bool is_list_of_texts = found->is_array() && std::all_of(found->begin(), found->end(),
                                                                 [](const Json& reason) { return reason.is_string(); });
  if (!is_list_of_texts) throw DataError(file, "/reasons", fmt::format("{:.60}", found->dump()), "a list of texts");
  return found->get<std::vector<std::string>>();
}

/// Returns a number in [least, most] of an object; nothing if the key is missing or null.
std::optional<double> number_of(const Json& object, const char* key, const std::filesystem::path& file, double least,
                                double most, const std::string& at = "") {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return std::nullopt;
  if (!found->is_number()) throw DataError(file, at + "/" + key, found->dump(), "a number");
  const double value = found->get<double>();
  if (!(value >= least && value <= most)) {
    throw DataError(
        file, at + "/" + key, found->dump(),
        std::isfinite(most) ? fmt::format("a number from {} to {}", least, most) : fmt::format("at least {}", least));
  }
  return value;
}

std::optional<bool> truth_of(const Json& object, const char* key, const std::filesystem::path& file) {
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  if (!found->is_boolean()) throw DataError(file, std::string("/") + key, found->dump(), "true or false");
  return found->get<bool>();
}

/// Refuses a file whose statements contradict each other.
void require_no_contradiction(const Json& document, const RegistrationRecord& record,
                              const std::filesystem::path& file) {
  constexpr double kSameScale = 1e-4;  // relative: numbers may have been shortened
  if (const auto scale = number_of(document, "scale", file, 0.0, std::numeric_limits<double>::infinity());
      scale && record.T_target_source && std::abs(*scale / record.scale - 1.0) > kSameScale) {
    throw DataError(file, "/scale", fmt::format("{:.6g}", *scale),
                    fmt::format("{:.6g}, the scale of T_target_source", record.scale));
  }
  const bool is_converged = record.is_converged.value_or(false);
  if (const auto found = document.find("outcome"); found != document.end() && record.is_converged) {
    const std::string converged(to_string(RegistrationOutcome::Converged));
    if (is_converged != (found->is_string() && found->get<std::string>() == converged))
      throw DataError(file, "/outcome", found->dump(),
                      fmt::format("an outcome that fits \"converged\": {}", is_converged));
  }
  if (!is_converged) return;
  if (!record.T_target_source)
    throw DataError(file, "/T_target_source", "null", "the transform that the registration converged to");
  if (truth_of(document, "scale_at_limit", file).value_or(false)) {
    throw DataError(file, "/scale_at_limit", "true with \"converged\": true", "a scale that is within its range",
                    "Register again.");
  }
}

}  // namespace

void seal_registration(Json& document) {
  document[kDigestKey] = digest_of(document);
}

RegistrationRecord read_registration(const std::filesystem::path& file) {
  const Json document = read_json(file);
  if (!document.is_object()) throw DataError(file, "", "no JSON object", "what `incise register` writes");
  RegistrationRecord record;
  record.is_converged = truth_of(document, "converged", file);
  if (const auto found = document.find("T_target_source"); found == document.end() || !found->is_null()) {
    record.T_target_source = transform_in(document, "T_target_source", file);
    record.scale = std::cbrt(record.T_target_source->topLeftCorner<3, 3>().determinant());
  }
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  record.rmse_mm = number_of(document, "rmse_mm", file, 0.0, kNoLimit);
  record.inlier_fraction = number_of(document, "inlier_fraction", file, 0.0, 1.0);
  record.camera_scale = number_of(document, "camera_scale", file, kLeastCameraScale, kMostCameraScale).value_or(1.0);
  if (const auto found = document.find("certificate"); found != document.end() && !found->is_null()) {
    if (!found->is_object()) throw DataError(file, "/certificate", fmt::format("{:.60}", found->dump()), "an object");
    record.scale_sd = number_of(*found, "scale_sd", file, 0.0, kNoLimit, "/certificate");
  }
  if (const auto found = document.find("target_sha256"); found != document.end()) {
    if (!found->is_string()) throw DataError(file, "/target_sha256", found->dump(), "64 hex digits");
    record.target_sha256 = found->get<std::string>();
  }
  for (const char* name : {"source", "target"}) {
    const std::string digest = fmt::format("{}_sha256", name);
    const auto path = document.find(name), sha256 = document.find(digest);
    if (path == document.end() || sha256 == document.end()) continue;
    if (!path->is_string()) throw DataError(file, fmt::format("/{}", name), path->dump(), "the name of a file");
    if (!sha256->is_string()) throw DataError(file, "/" + digest, sha256->dump(), "64 hex digits");
    record.inputs.push_back({digest, path->get<std::string>(), sha256->get<std::string>()});
  }
  record.doubts = doubts_in(document, file);
  require_no_contradiction(document, record, file);
  record.is_sealed = has_its_digest(document, file);
  return record;
}

}  // namespace incise
