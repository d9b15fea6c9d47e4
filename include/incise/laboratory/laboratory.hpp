#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise::laboratory {

/// How a step of an experiment ended.
enum class StepEnd {
  Done,
  NotAcceptable,  ///< it ran, but its result is of no use
  Unusable,       ///< a reading or a case could not be used
};

struct StepAnswer {
  StepEnd end = StepEnd::Done;
  nlohmann::ordered_json result;  ///< result of the step; if unusable: `outcome` and the reason
};

/// A laboratory that holds one specimen, as a planner sees it: only through readings and photographs.
class Laboratory {
 public:
  virtual ~Laboratory() = default;
  /// Scans, photographs and pulls the stretched specimen. @param folder  receives ct/, rgb.png, depth.png, camera.json.
  /// @returns a result with `stretch_force_n`, N.
  virtual StepAnswer take_readings(const std::filesystem::path& folder) = 0;
  /// Cuts the specimen by a robot program. @param power_w  of the generator. @param folder  receives photo.png.
  /// @param tag  name of the cut.
  virtual StepAnswer cut(const std::filesystem::path& program, double power_w, const std::filesystem::path& folder,
                         const std::string& tag) = 0;
};

}  // namespace incise::laboratory
