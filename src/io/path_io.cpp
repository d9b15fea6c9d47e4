#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/io/transform_json.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kSchema = "incise.path/1";
constexpr const char* kVerdict = "verdict";
constexpr const char* kDigest = "digest_sha256";
constexpr double kUnitAxisTolerance = 1e-4;  // an axis typed with four digits passes; 0.5 µm at 5 mm depth

/// The content of `path.json` without the verdict.
struct PathFile {
  ToolPath path;
};

/// A waypoint as stored in a file: its axis is a unit vector.
struct WaypointEntry {
  Waypoint waypoint;
};
void describe(Visitor& v, WaypointEntry& entry) {
  describe(v, entry.waypoint);
  const double length = entry.waypoint.axis.norm();
  if (v.sets() && std::abs(length - 1.0) > kUnitAxisTolerance)
    v.refuse({"axis"}, fmt::format("a vector of length {:.6g}", length), "a unit vector");
}

/// Describes an optional text; an empty one is not written.
template <class IsGood>
void describe_stated(Visitor& v, Field field, std::string& text, const IsGood& is_good, std::string_view expected) {
  field.is_omitted = true;
  if (!v.optional(field, !text.empty())) return;
  v(field, text);
  if (v.sets() && !is_good(text)) v.refuse(field, "'" + text + "'", std::string(expected));
}

bool is_hash(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

void describe(Visitor& v, PathFile& file) {
  ToolPath& p = file.path;
  const Field schema{.name = "schema", .meaning = "Format and version of this file.", .is_omitted = true};
  if (v.optional(schema, true)) constant(v, schema, kSchema);
  v("frame", p.frame, "Frame of the path's coordinates.");
  v("kind", p.kind, "What the tool does along the path.");
  v("closed", p.is_closed, "Whether the last waypoint leads back to the first.");
  std::vector<WaypointEntry> waypoints;
  for (const Waypoint& waypoint : p.waypoints) waypoints.push_back({waypoint});
  v("waypoints", waypoints, "Waypoints in the order of travel.");
  const std::size_t least = p.is_closed ? 3 : 2;
  if (waypoints.size() < least)
    v.refuse({"waypoints"}, fmt::format("{} items", waypoints.size()), fmt::format("at least {}", least));
  const Field edge{
      .name = "tumor_edge", .meaning = "Tumour edge, in the same frame.", .unit = "mm", .is_omitted = true};
  if (v.optional(edge, true)) v(edge, p.tumor_edge.points);
  const Field edge_closed{
      .name = "tumor_edge_closed", .meaning = "Whether the tumour edge is closed; default: yes.", .is_omitted = true};
  if (v.optional(edge_closed, !p.tumor_edge.is_closed)) v(edge_closed, p.tumor_edge.is_closed);
  const Field transform{
      .name = "T_robot_sim", .meaning = "Transform by rows; p_robot = T p_sim, mm.", .is_omitted = true};
  v(transform, p.T_robot_sim);
  if (v.sets() && p.T_robot_sim) require_similarity(v, transform, *p.T_robot_sim);
  describe_stated(v, {"source_sha256", "SHA-256 of the path's source."}, p.source_sha256, is_hash,
                  "64 lower-case hex digits");
  describe_stated(v, {"specimen_id", "Specimen on which the path was planned."}, p.specimen_id, is_specimen_id,
                  kSpecimenIdForm);
  static constexpr std::array<std::string_view, 2> kOrigins{"real", "virtual"};
  const Field origin{
      .name = "specimen_is", .meaning = "Virtual: the specimen is a synthetic body.", .is_omitted = true};
  if (v.optional(origin, p.is_virtual)) {
    std::size_t place = p.is_virtual ? 1 : 0;
    v.choice(origin, place, kOrigins);
    if (v.sets()) p.is_virtual = place == 1;
  }
  v.pass_over({kVerdict});
  if (!v.sets()) return;
  p.waypoints.clear();
  for (const WaypointEntry& entry : waypoints) p.waypoints.push_back(entry.waypoint);
}

ToolPath path_in(const ordered_json& document, const std::filesystem::path& name) {
  PathFile file;
  JsonReader(document, name).refuse_unknown_keys()(Field{}, file);
  return file.path;
}

ordered_json document_of(const ToolPath& path) {
  return incise::to_json(PathFile{path});
}

/// Returns a digest of a path and its verdict; it changes with either.
std::string digest_of(const ToolPath& path, const Verdict& verdict) {
  return sha256_of_text(document_of(path).dump() + to_json(verdict).dump());
}

}  // namespace

ToolPath tool_path_from_json(std::string_view text, const std::filesystem::path& name) {
  return path_in(parse_json(text, name), name);
}

ToolPath read_tool_path(const std::filesystem::path& path) {
  return tool_path_from_json(read_text(path), path);
}

void require_tumor_size(const ToolPath& path, const std::filesystem::path& file) {
  if (path.tumor_edge.points.empty()) return;
  if (const auto problem = size_problem(path.tumor_edge, "a tumour", kLargestTumorMm)) throw DataError(file, "/tumor_edge", problem->found, problem->expected, "Lengths are mm");
}

std::string path_json(const ToolPath& path) {
  const ordered_json document = document_of(path);
  // A path that cannot be read back must not be written, so the reader's rules apply.
  try {
    static_cast<void>(path_in(document, "tool path"));
  } catch (const DataError& error) {
    throw InvalidArgument(error.what());
  }
  return json_text(document);
}

void write_tool_path(const std::filesystem::path& file, const ToolPath& path) {
  write_atomically(file, path_json(path));
}

void write_tool_path(const std::filesystem::path& file, const ToolPath& path, const Verdict& verdict) {
  ordered_json document = parse_json(path_json(path), file);
  document[kVerdict] = to_json(verdict);
  document[kVerdict][kDigest] = digest_of(path, verdict);
  write_json(file, document);
}

Verdict read_path_verdict(const std::filesystem::path& file) {
  const ordered_json document = read_json(file);
  const ToolPath path = path_in(document, file);
  if (!document.contains(kVerdict))
    return refusals_of({},
                       "the path's file holds no verdict, as after `incise compensate --no-verify`: no simulated "
                       "cut along it is known");
  Verdict verdict;
  std::string digest;
  JsonReader reader(document.at(kVerdict), file, "/verdict");
  reader.begin({});
  describe(reader, verdict);
  reader(kDigest, digest);
  if (digest == digest_of(path, verdict)) return verdict;
  return refusals_of(verdict,
                     "the path was changed after its cut was simulated: the verdict in its file is of another path");
}

}  // namespace incise
