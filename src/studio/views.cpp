#include "views.hpp"

#include <incise/core/described_json.hpp>
#include <incise/workflow/cut_verdict.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace incise::studio {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json contour_json(const std::optional<Contour>& contour) {
  return contour ? points_json(contour->points) : Json(nullptr);
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json numbers_json(const Case& settings, const SimulatedCut& cut) {
  const auto& error = cut.centerline.abs_error_mm;
  Json json;
  json["nearest_to_tumor_mm"] = or_null(nearest_to_tumor_mm(settings, cut));
  json["least_depth_mm"] = cut.incision.kerf.depth.depth_mm.min;
  json["greatest_error_mm"] = error ? Json(error->max) : Json(nullptr);
  json["mean_error_mm"] = error ? Json(error->mean) : Json(nullptr);
  return json;
}

}  // namespace

void add_room(const MarginRoom& room, Json& json) {
  json["greatest_margin_mm"] = or_null(room.greatest_mm);
  json["margin_note"] = in_words(room) + ".";
}

std::string ended(Outcome outcome) {
  return fmt::format("The cut {}.", in_words(outcome));
}

Skin skin_of(const TetMesh& mesh, std::span<const std::uint8_t> is_live) {
  std::vector<std::int32_t> place(mesh.vertices.size(), -1);
  const std::vector<BoundaryFace> faces = boundary_faces(mesh, is_live);
  for (const BoundaryFace& face : faces) {
    for (const VertexId v : face.corners) place[v.index()] = 0;
  }
  Skin skin;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] < 0) continue;
    place[v] = static_cast<std::int32_t>(skin.vertices.size());
    skin.vertices.emplace_back(v);
  }
  const auto renumbered = [&](VertexId v) { return VertexId(static_cast<std::size_t>(place[v.index()])); };
  for (const BoundaryFace& face : faces) {
    const auto& [a, b, c] = face.corners;
    skin.triangles.push_back({renumbered(a), renumbered(b), renumbered(c)});
  }
  return skin;
}

Points positions_on(const Skin& skin, std::span<const Vec3> positions) {
  Points on;
  on.reserve(skin.vertices.size());
  for (const VertexId v : skin.vertices) on.push_back(positions[v.index()]);
  return on;
}

std::vector<std::uint8_t> held_by(const Skin& skin, const TissueModel& model) {
  std::vector<std::uint8_t> marks;
  for (const VertexId v : skin.vertices) {
    std::uint8_t mark = 0;
    for (const std::int32_t c : model.holder[v.index()]) {
      if (c >= 0 && c < 8) mark = static_cast<std::uint8_t>(mark | 1U << c);
    }
    marks.push_back(mark);
  }
  return marks;
}

std::vector<std::uint8_t> cut_triangles(const MadeSkin& made, std::span<const Vec3> vertices,
                                        std::span<const Triangle> triangles) {
  std::vector<std::uint8_t> cut;
  cut.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    const Vec3 &p = vertices[a.index()], &q = vertices[b.index()], &r = vertices[c.index()];
    const Vec3 middle = (p + q + r) / 3.0, normal = (q - p).cross(r - p).stableNormalized();
    cut.push_back(made.cut_at(middle, normal) ? 1 : made.is_painted(middle, normal) ? 2 : 0);
  }
  return cut;
}

/// Returns a constraint as in a case file: without fields that were left out there, and without words that a result
/// adds.
Json as_written(const Constraint& constraint) {
  Json json = to_json(constraint);
  json["kind"] = names_of(constraint)[constraint.index()];
  if (json.contains("where")) json["where"].erase("kind");
  const Json whole = json.flatten();
  Json kept = Json::object();
  for (const auto& [place, value] : whole.items()) {
    if (!value.is_null()) kept[place] = value;
  }
  return kept.unflatten();
}

namespace {

/// Returns the pull of a constraint as a share of the body's length along the pull; nothing without a pull.
std::optional<double> share_of_length(const Constraint& constraint, std::span<const Vec3> at_rest) {
  const auto* const pulled = std::get_if<DisplacedConstraint>(&constraint);
  if (pulled == nullptr || pulled->displacement_mm.isZero()) return std::nullopt;
  const Vec3 along = pulled->displacement_mm.normalized();
  const auto [low, high] = std::ranges::minmax(at_rest, {}, [&](const Vec3& p) { return along.dot(p); });
  return pulled->displacement_mm.norm() / along.dot(high - low);
}

/// The threshold of this note is a matter of judgement: no law of the tissue has a limit there.
Json note_on_pull(const std::optional<double>& share) {
  constexpr double kMuch = 0.25;
  if (!share || *share <= kMuch) return nullptr;
  return "This pull is large for a body of this length. A smaller pull deforms the tissue less.";
}

}  // namespace

Json constraints_json(const TissueModel& model) {
  std::vector<std::size_t> counts(model.constraints.size(), 0);
  for (const auto& holders : model.holder) {
    for (std::size_t c = 0; c < counts.size(); ++c)
      counts[c] += std::count(holders.begin(), holders.end(), static_cast<std::int32_t>(c)) > 0 ? 1 : 0;
  }
  Json list = Json::array();
  for (std::size_t c = 0; c < counts.size(); ++c) {
    const std::optional<double> share = share_of_length(model.constraints[c], model.mesh.vertices);
    list.push_back({{"kind", names_of(model.constraints[c])[model.constraints[c].index()]},
                    {"vertices", counts[c]},
                    {"share_of_length", or_null(share)},
                    {"note", note_on_pull(share)},
                    {"setting", as_written(model.constraints[c])}});
  }
  return list;
}

Json grid_json(const VolumeGrid& grid) {
  Json axes = Json::array();
  for (int a = 0; a < 3; ++a) axes.push_back(vector_json(grid.direction.col(a)));
  return {{"size", grid.size},
          {"spacing_mm", vector_json(grid.spacing_mm)},
          {"origin_mm", vector_json(grid.origin_mm)},
          {"axes", std::move(axes)}};
}

Json points_json(std::span<const Vec3> points) {
  Json json = Json::array();
  for (const Vec3& p : points) json.push_back(vector_json(p));
  return json;
}

Json surface_json(BlobFolder& blobs, const std::string& slot, std::span<const Vec3> vertices,
                  std::span<const Triangle> triangles) {
  return {{"vertices", blobs.put(slot + ".vertices", vertices)},
          {"triangles", blobs.put(slot + ".triangles", triangles)}};
}

Json tool_path_json(const ToolPath& path) {
  Json axes = Json::array(), depths = Json::array();
  for (const Waypoint& w : path.waypoints) {
    axes.push_back(vector_json(w.axis));
    depths.push_back(w.depth_mm);
  }
  return {{"points_mm", points_json(entry_contour(path).points)},
          {"axes", std::move(axes)},
          {"depth_mm", std::move(depths)},
          {"closed", path.is_closed}};
}

Json cut_json(const Case& settings, const SimulatedCut& cut, const ToolPath& followed) {
  const DepthReached& depth = cut.incision.kerf.depth;
  const ContourErrors& errors = cut.centerline.errors;
  Json json;
  json["path"] = tool_path_json(followed);
  json["outcome"] = to_string(cut.outcome);
  json["ended"] = ended(cut.outcome);
  json["centerline"] = contour_json(cut.incision.centerline);
  json["inner_edge"] = contour_json(cut.incision.inner_edge);
  json["errors"] = {{"arclength_mm", arclengths_mm(errors.points.points)}, {"signed_mm", errors.signed_error_mm}};
  json["depth"] = {{"arclength_mm", depth.profile.arclength_mm},
                   {"planned_mm", depth.planned_at_mm},
                   {"reached_mm", depth.profile.depth_mm}};
  json["numbers"] = numbers_json(settings, cut);
  json["verdict"] = to_json(cut.verdict);
  return json;
}

}  // namespace incise::studio
