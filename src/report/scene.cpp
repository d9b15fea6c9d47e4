#include "report/scene.hpp"

#include "report/line_kinds.hpp"

#include <incise/core/error.hpp>
#include <incise/io/text_encoding.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSteps = 65535.0;

/// Appends `bytes` low bytes of a number, the lowest first.
void append_number(std::string& bytes, std::uint32_t value, int count) {
  for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xffU);
}

/// Positions as steps within a box.
class Quantiser {
 public:
  explicit Quantiser(const Box3& box) : low_(box.min()), step_(box.sizes().cwiseMax(1e-6) / kSteps) {}

  void append(std::string& bytes, const Vec3& p) const {
    for (int axis = 0; axis < 3; ++axis) {
      append_number(bytes, static_cast<std::uint32_t>(std::lround((p[axis] - low_[axis]) / step_[axis])), 2);
    }
  }
  void describe(Json& json) const {
    json["low"] = json_of(low_);
    json["step_mm"] = json_of(step_);
  }

 private:
  Vec3 low_, step_;
};

/// New, dense numbers for the vertices that are used.
struct Renumbering {
  std::vector<std::int64_t> number;  ///< per old vertex; -1: not used
  std::vector<std::size_t> old;      ///< per new vertex

  void use(VertexId id) {
    if (id.index() >= number.size()) number.resize(id.index() + 1, -1);
    if (number[id.index()] >= 0) return;
    number[id.index()] = static_cast<std::int64_t>(old.size());
    old.push_back(id.index());
  }
  [[nodiscard]] std::uint32_t of(VertexId id) const { return static_cast<std::uint32_t>(number[id.index()]); }
  [[nodiscard]] int index_bytes() const { return old.size() <= 65536 ? 2 : 4; }
};

/// Returns the approximate size of the frames as base64, bytes.
std::size_t text_size(const ReportAnimation& animation, const Renumbering& vertices) {
  std::size_t bytes = 0;
  for (const ReportFrame& frame : animation.frames) {
    bytes += 6 * vertices.old.size() + 3 * static_cast<std::size_t>(vertices.index_bytes()) * frame.skin.size();
  }
  return bytes / 3 * 4;
}

/// `wanted` of `count` frames, evenly spaced, the first and the last among them.
std::vector<std::size_t> evenly_chosen(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < wanted; ++k) chosen.push_back(k * (count - 1) / (wanted - 1));
  return chosen;
}

Json frame_json(const ReportFrame& frame, const Renumbering& vertices, const Quantiser& quantiser, const Vec3& low) {
  std::string positions, outer, kerf;
  for (const std::size_t old : vertices.old) {
    // A vertex that this frame does not have is not in its skin either: any place will do.
    quantiser.append(positions, old < frame.positions_mm.size() ? frame.positions_mm[old] : low);
  }
  for (std::size_t k = 0; k < frame.skin.size(); ++k) {
    std::string& part = frame.is_kerf[k] != 0 ? kerf : outer;
    for (const VertexId id : frame.skin[k]) append_number(part, vertices.of(id), vertices.index_bytes());
  }
  Json json{{"time_s", frame.time_s}, {"phase", frame.phase}, {"positions", base64(positions)},
            {"outer", base64(outer)}, {"kerf", base64(kerf)}, {"axis", json_of(frame.tool_axis)}};
  if (frame.tool_tip_mm) json["tip"] = json_of(*frame.tool_tip_mm);
  return json;
}

Json line_json(const ReportLine& line) {
  const LineLook look = look_of(line.kind);
  Json points = Json::array();
  for (const Vec3& p : line.contour.points) {
    for (int axis = 0; axis < 3; ++axis) points.push_back(std::round(1e4 * p[axis]) / 1e4);
  }
  return {{"label", look.label}, {"color", look.color}, {"closed", line.contour.is_closed}, {"points", points}};
}

}  // namespace

Json json_of(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json animation_json(const ReportAnimation& animation, std::size_t budget) {
  Renumbering vertices;
  for (const ReportFrame& frame : animation.frames) {
    for (const Triangle& t : frame.skin) {
      for (const VertexId id : t) vertices.use(id);
    }
  }
  Box3 box;
  for (const ReportFrame& frame : animation.frames) {
    for (const std::size_t old : vertices.old) {
      if (old < frame.positions_mm.size()) box.extend(frame.positions_mm[old]);
    }
  }
  INCISE_REQUIRE(!box.isEmpty(), "expected an animation with at least one triangle");
  const Quantiser quantiser(box);

  const std::size_t count = animation.frames.size();
  const std::size_t all = text_size(animation, vertices);
  const std::size_t wanted = all <= budget ? count : std::max<std::size_t>(2, count * budget / all);
  std::vector<std::size_t> chosen{0};
  if (count >= 2) chosen = evenly_chosen(count, std::min(count, wanted));

  Json json{{"name", animation.name}, {"vertices", vertices.old.size()}, {"index_bytes", vertices.index_bytes()}};
  quantiser.describe(json);
  json["total_frames"] = count;
  json["frames"] = Json::array();
  for (const std::size_t k : chosen) {
    json["frames"].push_back(frame_json(animation.frames[k], vertices, quantiser, box.min()));
  }
  json["lines"] = Json::array();
  for (const ReportLine& line : animation.lines) {
    if (line.contour.points.size() >= 2) json["lines"].push_back(line_json(line));
  }
  json["tool"] = {{"diameter_mm", animation.tool_diameter_mm}, {"length_mm", animation.tool_length_mm}};
  return json;
}

Json mesh_json(const TetMesh& mesh) {
  Renumbering vertices;
  for (const Tet& tet : mesh.tets) {
    for (const VertexId id : tet) vertices.use(id);
  }
  Box3 box;
  for (const std::size_t old : vertices.old) box.extend(mesh.vertices[old]);
  const Quantiser quantiser(box);
  std::string positions, tets;
  for (const std::size_t old : vertices.old) quantiser.append(positions, mesh.vertices[old]);
  for (const Tet& tet : mesh.tets) {
    for (const VertexId id : tet) append_number(tets, vertices.of(id), vertices.index_bytes());
  }
  Json json{
      {"vertices", vertices.old.size()}, {"index_bytes", vertices.index_bytes()}, {"tet_count", mesh.tets.size()}};
  quantiser.describe(json);
  json["positions"] = base64(positions);
  json["tets"] = base64(tets);
  return json;
}

std::string script_json(const Json& value) {
  std::string text = value.dump();
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace incise
