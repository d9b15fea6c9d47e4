#include <incise/storage/result_json.hpp>

namespace incise {

nlohmann::ordered_json correction_summary_json(const Correction& correction) {
  nlohmann::ordered_json json = to_json(correction);
  for (const char* key : {"waypoints", "error_mm", "move_mm"}) json.erase(key);
  if (!correction.iteration) return json;
  for (nlohmann::ordered_json& pass : json["history"])
    for (const char* key : {"offset_mm", "error_mm", "is_limited", "is_interpolated"}) pass.erase(key);
  return json;
}

nlohmann::ordered_json plan_summary_json(const ToolPath& path) {
  return {{"length_mm", length_mm(entry_contour(path))},
          {"waypoints", path.waypoints.size()},
          {"duration_s", duration_s(path)},
          {"closed", path.is_closed}};
}

}  // namespace incise
