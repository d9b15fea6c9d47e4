#include <incise/geometry/tool_path.hpp>
#include <incise/io/json_file.hpp>
#include <incise/storage/path_schema.hpp>

#include <nlohmann/json.hpp>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

Json array_of(const Json& item, std::size_t least, const char* meaning) {
  return {{"type", "array"}, {"items", item}, {"minItems", least}, {"description", meaning}};
}

Json point(const char* meaning) {
  Json json = array_of({{"type", "number"}}, 3, meaning);
  json["maxItems"] = 3;
  return json;
}

Json object_of(Json properties, std::vector<std::string> required) {
  return {{"type", "object"}, {"properties", std::move(properties)}, {"required", std::move(required)}, {"additionalProperties", false}};
}

Json waypoint() {
  Json fields;
  fields["position_mm"] = point("Where the tool enters the surface, mm");
  fields["axis"] = point("Unit vector along the tool, into the tissue");
  fields["depth_mm"] = {{"type", "number"}, {"minimum", 0}, {"description", "Depth of the tip below the surface, mm"}};
  fields["speed_mm_s"] = {
      {"type", "number"}, {"exclusiveMinimum", 0}, {"description", "Speed towards the next waypoint, mm/s"}};
  return object_of(std::move(fields), {"position_mm", "axis", "depth_mm", "speed_mm_s"});
}

Json choice(Names names, const char* meaning) {
  return {{"enum", std::vector<std::string_view>(names.begin(), names.end())}, {"description", meaning}};
}

Json fields() {
  Json json;
  json["schema"] = {{"const", "incise.path/1"}};
  json["frame"] = choice(names_of(PathFrame{}), "Frame of positions and axes");
  json["kind"] = choice(names_of(PathKind{}), "Whether the path cuts or only marks");
  json["closed"] = {{"type", "boolean"}, {"description", "Whether the last waypoint leads back to the first; then there are at least 3"}};
  json["waypoints"] = array_of(waypoint(), 2, "Waypoints in the order of travel");
  json["tumor_edge"] = array_of(point("mm"), 0, "The tumour edge in the same frame");
  json["tumor_edge_closed"] = {{"type", "boolean"}, {"default", true}};
  Json row = array_of({{"type", "number"}}, 4, "");
  row["maxItems"] = 4;
  json["T_robot_sim"] = array_of(row, 4, "Rows of the similarity from the simulation's frame to the robot's, mm");
  json["T_robot_sim"]["maxItems"] = 4;
  json["specimen_id"] = {{"type", "string"},
                         {"pattern", "^[A-Za-z0-9._][A-Za-z0-9._-]{0,63}$"},
                         {"description", "Specimen that the path was planned on"}};
  json["specimen_is"] = choice(std::array<std::string_view, 2>{"real", "virtual"},
                               "Virtual: a synthetic body, stated in every program made from the path");
  json["source_sha256"] = {{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}, {"description", "SHA-256 of what the path was made from"}};
  json["verdict"] = {{"type", "object"},
                     {"required", {"status", "reasons", "digest_sha256"}},
                     {"description",
                      "Verdict on the simulated cut along the path; its digest seals the path and the verdict. Written "
                      "by incise: a path that has no verdict, or was changed after the verdict was written, counts as "
                      "not simulated"}};
  return json;
}

}  // namespace

std::string path_schema_json() {
  Json schema;
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "incise.path/1";
  schema["description"] = "A path of the tool, planned or corrected. Lengths in mm, coordinates in LPS unless the frame is the robot's.";
  schema.update(object_of(fields(), {"frame", "kind", "closed", "waypoints"}));
  return json_text(schema);
}

}  // namespace incise
