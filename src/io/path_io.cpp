#include "io/json_reading.hpp"

#include <incise/core/error.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/described_json.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/specimen_id.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

using io_detail::JsonValue;
using nlohmann::ordered_json;

constexpr const char* kSchema = "incise.path/1";
constexpr const char* kVerdict = "verdict";
constexpr const char* kSpecimenIs = "specimen_is";
constexpr const char* kDigest = "digest_sha256";
constexpr double kUnitAxisTolerance = 1e-4;  // an axis typed with four digits passes; 0.5 µm at 5 mm depth

/// The enumerator that `place` spells. @throws DataError
template <Named E>
E enumerator(const JsonValue& place) {
  if (const auto value = value_of<E>(place.text())) return *value;
  place.expected(fmt::format("one of: {}", fmt::join(names_of(E{}), ", ")));
}

Waypoint read_waypoint(const JsonValue& place) {
  place.require_only({"position_mm", "axis", "depth_mm", "speed_mm_s"});
  Waypoint waypoint;
  waypoint.position_mm = place.at("position_mm").point();
  const JsonValue axis = place.at("axis");
  waypoint.axis = axis.point();
  if (std::abs(waypoint.axis.norm() - 1.0) > kUnitAxisTolerance) {
    axis.fail(fmt::format("a vector of length {:.6g}", waypoint.axis.norm()), "a unit vector");
  }
  const JsonValue depth = place.at("depth_mm");
  waypoint.depth_mm = depth.number();
  if (waypoint.depth_mm < 0.0) depth.expected("a depth of 0 mm or more");
  const JsonValue speed = place.at("speed_mm_s");
  waypoint.speed_mm_s = speed.number();
  if (waypoint.speed_mm_s <= 0.0) speed.expected("a speed above 0 mm/s");
  return waypoint;
}

std::string read_hash(const JsonValue& place) {
  const std::string text = place.text();
  const bool is_hash = text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!is_hash) place.expected("64 lower-case hex digits");
  return text;
}

ToolPath read_path(const JsonValue& root) {
  root.require_only({"schema", "frame", "kind", "closed", "waypoints", "tumor_edge", "tumor_edge_closed", "T_robot_sim",
                     "source_sha256", "specimen_id", kSpecimenIs, kVerdict});
  if (const auto schema = root.find("schema"); schema && schema->text() != kSchema) {
    schema->expected(fmt::format("\"{}\"", kSchema));
  }
  ToolPath path;
  path.frame = enumerator<PathFrame>(root.at("frame"));
  path.kind = enumerator<PathKind>(root.at("kind"));
  path.is_closed = root.at("closed").boolean();
  for (const JsonValue& item : root.at("waypoints").items(path.is_closed ? 3 : 2)) {
    path.waypoints.push_back(read_waypoint(item));
  }
  if (const auto edge = root.find("tumor_edge")) {
    for (const JsonValue& item : edge->items()) path.tumor_edge.points.push_back(item.point());
  }
  if (const auto closed = root.find("tumor_edge_closed")) path.tumor_edge.is_closed = closed->boolean();
  if (const auto transform = root.find("T_robot_sim")) path.T_robot_sim = transform->transform();
  if (const auto hash = root.find("source_sha256")) path.source_sha256 = read_hash(*hash);
  if (const auto id = root.find("specimen_id")) {
    path.specimen_id = id->text();
    if (!is_specimen_id(path.specimen_id)) id->expected(std::string(kSpecimenIdForm));
  }
  if (const auto kind = root.find(kSpecimenIs)) {
    const std::string word = kind->text();
    if (word != "real" && word != "virtual") kind->expected("one of: real, virtual");
    path.is_virtual = word == "virtual";
  }
  return path;
}

ordered_json array_of(const Vec3& p) {
  return ordered_json::array({p.x(), p.y(), p.z()});
}

ordered_json document_of(const ToolPath& path) {
  ordered_json document;
  document["schema"] = kSchema;
  document["frame"] = to_string(path.frame);
  document["kind"] = to_string(path.kind);
  document["closed"] = path.is_closed;
  document["waypoints"] = ordered_json::array();
  for (const Waypoint& waypoint : path.waypoints) {
    document["waypoints"].push_back({{"position_mm", array_of(waypoint.position_mm)},
                                     {"axis", array_of(waypoint.axis)},
                                     {"depth_mm", waypoint.depth_mm},
                                     {"speed_mm_s", waypoint.speed_mm_s}});
  }
  document["tumor_edge"] = ordered_json::array();
  for (const Vec3& point : path.tumor_edge.points) document["tumor_edge"].push_back(array_of(point));
  if (!path.tumor_edge.is_closed) document["tumor_edge_closed"] = false;
  if (path.T_robot_sim) {
    for (int i = 0; i < 4; ++i) {
      const auto row = path.T_robot_sim->row(i);
      document["T_robot_sim"].push_back({row(0), row(1), row(2), row(3)});
    }
  }
  if (!path.source_sha256.empty()) document["source_sha256"] = path.source_sha256;
  if (!path.specimen_id.empty()) document["specimen_id"] = path.specimen_id;
  if (path.is_virtual) document[kSpecimenIs] = "virtual";
  return document;
}

/// Over a path and what is said of it: a change of either shows.
std::string digest_of(const ToolPath& path, const Verdict& verdict) {
  return sha256_of_text(document_of(path).dump() + to_json(verdict).dump());
}

Verdict not_simulated(const char* why) {
  Verdict verdict;
  verdict.add("not_simulated", {}, why);
  return verdict;
}

}  // namespace

ToolPath tool_path_from_json(std::string_view text, const std::filesystem::path& name) {
  const ordered_json document = parse_json(text, name);
  return read_path(JsonValue(document, name));
}

ToolPath read_tool_path(const std::filesystem::path& path) {
  return tool_path_from_json(read_text(path), path);
}

void require_tumor_size(const ToolPath& path, const std::filesystem::path& file) {
  if (path.tumor_edge.points.empty()) return;
  if (const auto problem = size_problem(path.tumor_edge, "a tumour", kLargestTumorMm)) throw DataError(file, "/tumor_edge", problem->found, problem->expected, "Lengths are mm");
}

std::string to_json(const ToolPath& path) {
  const ordered_json document = document_of(path);
  std::string text = json_text(document);
  // What cannot be read back must not be written: the reader's rules are the rules.
  const std::filesystem::path name = "tool path";
  try {
    static_cast<void>(read_path(JsonValue(document, name)));
  } catch (const DataError& error) {
    throw InvalidArgument(error.what());
  }
  return text;
}

void write_tool_path(const std::filesystem::path& file, const ToolPath& path) {
  const std::string text = to_json(path);
  write_atomically(file, text);
}

void write_tool_path(const std::filesystem::path& file, const ToolPath& path, const Verdict& verdict) {
  ordered_json document = parse_json(to_json(path), file);
  document[kVerdict] = to_json(verdict);
  document[kVerdict][kDigest] = digest_of(path, verdict);
  write_json(file, document);
}

Verdict read_path_verdict(const std::filesystem::path& file) {
  const ordered_json document = read_json(file);
  const JsonValue root(document, file);
  const ToolPath path = read_path(root);
  const std::optional<JsonValue> place = root.find(kVerdict);
  if (!place) return not_simulated("the path's file holds no verdict: no simulated cut along it is known");
  const Verdict stated = from_json<Verdict>(document.at(kVerdict), file, "/verdict");
  if (place->at(kDigest).text() == digest_of(path, stated)) return stated;
  // A changed digit does not make a refused path one that can be accepted.
  Verdict verdict =
      not_simulated("the path was changed after its cut was simulated: the verdict in its file is of another path");
  for (const VerdictReason& reason : stated.reasons()) {
    if (reason.severity == VerdictStatus::Refused) verdict.add(reason);
  }
  return verdict;
}

void require_path_unchanged(const std::filesystem::path& file) {
  const ordered_json document = read_json(file);
  const JsonValue root(document, file);
  const std::optional<JsonValue> place = root.find(kVerdict);
  if (!place) return;
  const std::string digest = digest_of(read_path(root), from_json<Verdict>(document.at(kVerdict), file, "/verdict"));
  if (place->at(kDigest).text() != digest)
    throw DataError(file, "/verdict/digest_sha256", "that of another path", digest + ", that of the path in this file");
}

}  // namespace incise
