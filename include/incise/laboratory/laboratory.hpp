#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise::laboratory {

/// How a step of an experiment ended.
enum class StepEnd {
  Done,
  NotAcceptable,  ///< it ran, but nothing can be done with what it found
  Unusable,       ///< a reading or a case could not be used
};

struct StepAnswer {
  StepEnd end = StepEnd::Done;
  nlohmann::ordered_json result;  ///< what it found; where unusable: `outcome`, why
};

/// A laboratory that holds one specimen, as whoever plans its cut sees it: readings and photographs.
class Laboratory {
 public:
  virtual ~Laboratory() = default;
  /// Scans, photographs and pulls the stretched specimen. @param folder  gets ct/, rgb.png, depth.png, camera.json.
  /// The result holds `stretch_force_n`.
  virtual StepAnswer take_readings(const std::filesystem::path& folder) = 0;
  /// Cuts the specimen by a robot program. @param folder  gets photo.png.  @param tag  names the cut.
  virtual StepAnswer cut(const std::filesystem::path& program, double power_w, const std::filesystem::path& folder,
                         const std::string& tag) = 0;
};

}  // namespace incise::laboratory
