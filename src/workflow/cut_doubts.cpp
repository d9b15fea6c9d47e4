#include <incise/core/error.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/workflow/cut_doubts.hpp>
#include <incise/workflow/margin_room.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

// Above this Poisson's ratio, cuts with volume per_tet are useless; above the limit of the rule `locking`, tets begin
// to lock.
constexpr double kLockedFrom = 0.495;
constexpr double kRatioRounding = 1e-9;
constexpr double kNearPathMm = 1.5;  // tets whose centroid is this near to the tool's way count as met

struct TetRatio {
  double ratio = 0.0;
  std::size_t tet = 0;
};

/// The greatest Poisson's ratio of the tissue, and the first tet that has it.
TetRatio greatest_ratio(const TissueModel& model) {
  TetRatio greatest;
  for (std::size_t t = 0; t < model.lame.size(); ++t) {
    const LameParameters& lame = model.lame[t];
    const double ratio = lame.lambda_kpa / (2.0 * (lame.lambda_kpa + lame.mu_kpa));
    if (ratio > greatest.ratio + kRatioRounding) greatest = {ratio, t};
  }
  return greatest;
}

Vec3 centroid_of(const Tet& tet, std::span<const Vec3> positions) {
  Vec3 sum = Vec3::Zero();
  for (const VertexId corner : tet) sum += positions[corner.index()];
  return 0.25 * sum;
}

double mean_edge_mm(const Tet& tet, std::span<const Vec3> positions) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) sum += (positions[tet[a].index()] - positions[tet[b].index()]).norm();
  }
  return sum / 6.0;
}

/// Finds places near the tool's way, seen along the approach and no deeper than the tool.
class WayOfTool {
 public:
  WayOfTool(const ToolPath& path, const Vec3& approach)
      : view_(view_along(approach)),
        entries_(entry_contour(path)),
        flat_(flat_in_view(entries_, view_)),
        box_(bounding_box(flat_.points)) {
    for (const Waypoint& waypoint : path.waypoints) deepest_mm_ = std::max(deepest_mm_, waypoint.depth_mm);
  }

  [[nodiscard]] bool comes_near(const Vec3& place) const {
    const Vec3 seen = view_.to_view(place);
    const Vec3 flat(seen.x(), seen.y(), 0.0);
    if (box_.exteriorDistance(flat) > kNearPathMm) return false;
    const ContourPoint nearest = nearest_on(flat_, flat);
    if (nearest.distance_mm > kNearPathMm) return false;
    const Vec3& from = entries_.points[nearest.segment];
    const Vec3& to = entries_.points[(nearest.segment + 1) % entries_.points.size()];
    const double below_mm = view_.to_view(from + nearest.fraction * (to - from)).z() - seen.z();
    return below_mm >= 0.0 && below_mm <= deepest_mm_;
  }

 private:
  ViewFrame view_;
  Contour entries_;
  Contour flat_;
  Box3 box_;
  double deepest_mm_ = 0.0;
};

/// Counts the places of a list with a property, and adds an objection if there are any.
template <class Holds, class Text>
void add_places(std::string_view id, std::string_view what, std::span<const Vec3> places, const Holds& holds,
                const Text& text, Verdict& verdict) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (holds(places[i]) && count++ == 0) first = i;
  }
  if (count == 0) return;
  verdict.add(id, static_cast<double>(count),
              fmt::format("{} of {} points of {} {}", count, places.size(), what, text(places[first])),
              VerdictPlace{{}, places[first], fmt::format("point {} of {}", first, what)});
}

/// Adds objections for places on artificial skin, or on skin that a person drew.
void add_made_skin(const Case& settings, const TissueModel& model, const MadeSkin& made,
                   std::span<const Vec3> stretched, const ToolPath& path, Verdict& verdict) {
  if (made.empty()) return;
  const PlacedSkin skin(boundary_surface(model.mesh), stretched, made);
  const auto is_cut = [&](const Vec3& place) { return skin.cut_at(place).has_value(); };
  const auto is_drawn = [&](const Vec3& place) { return skin.is_painted(place); };
  const auto say_cut = [&](const Vec3& place) {  // above and around it lies tissue that the plan does not include
    return fmt::format(
        "lie where the region of interest (ct.roi_box_mm) or the end of the scan cuts through the tissue, "
        "on its {} side. The skin there is artificial: the specimen continues beyond it. Move that face "
        "of the box outwards, take a scan or labels that reach farther, or cut elsewhere",
        to_string(*skin.cut_at(place)));
  };
  const auto say_cut_path = [&](const Vec3& place) {
    const bool is_ring = settings.plan.kind == PlanKind::Ring && path.tumor_edge.points.size() >= 3;
    const MarginRoom room =
        is_ring ? margin_room(skin, path.tumor_edge, settings.plan, radius_mm(settings.tool)) : MarginRoom();
    return say_cut(place) + (room.greatest_mm ? ". " + in_words(room) : "");
  };
  const auto say_drawn = [](const Vec3&) {
    return std::string(
        "lie on skin that strokes of the brush made (ct.edits): only the strokes state where the "
        "specimen's skin is there. Compare it with the scan");
  };
  const Points entries = entry_contour(path).points;
  add_places("cut_face", "the path", entries, is_cut, say_cut_path, verdict);
  add_places("cut_face", "the tumour's edge", path.tumor_edge.points, is_cut, say_cut, verdict);
  add_places("painted_skin", "the path", entries, is_drawn, say_drawn, verdict);
  add_places("painted_skin", "the tumour's edge", path.tumor_edge.points, is_drawn, say_drawn, verdict);
}

}  // namespace

void require_no_locking(const TissueModel& model) {
  if (model.material.volume != VolumeTreatment::PerTet) return;
  const TetRatio greatest = greatest_ratio(model);
  if (greatest.ratio <= kLockedFrom + kRatioRounding) return;
  throw CaseError("case", "specimen.material.volume",
                  fmt::format("per_tet with a Poisson's ratio of {:.6g} (tet {})", greatest.ratio, greatest.tet),
                  fmt::format("averaged, or a Poisson's ratio of at most {}, to cut", kLockedFrom),
                  "Tets that each keep their own volume lock: the cut would look too good");
}

std::optional<double> edge_along_mm(const TissueModel& model, std::span<const Vec3> stretched, const ToolPath& path,
                                    const Vec3& approach) {
  const WayOfTool way(path, approach);
  double sum = 0.0;
  std::size_t count = 0;
  for (const Tet& tet : model.mesh.tets) {
    if (!way.comes_near(centroid_of(tet, stretched))) continue;
    sum += mean_edge_mm(tet, model.mesh.vertices);
    ++count;
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

std::optional<PlatformClearance> platform_clearance(const TissueModel& model, const ToolPath& path) {
  std::optional<PlatformClearance> least;
  for (const Constraint& constraint : model.constraints) {
    const auto* support = std::get_if<SupportConstraint>(&constraint);
    if (support == nullptr || support->holder) continue;
    const Vec3 normal = support->normal.normalized();
    for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
      const Waypoint& waypoint = path.waypoints[i];
      const double height_mm = normal.dot(waypoint.position_mm + waypoint.depth_mm * waypoint.axis - support->point_mm);
      if (!least || height_mm < least->height_mm) least = {height_mm, i};
    }
  }
  return least;
}

Verdict verdict_before_cut(const Case& settings, const TissueModel& model, const MadeSkin& made_skin,
                           std::span<const Vec3> stretched, const ToolPath& path) {
  Verdict verdict;
  const double ratio = greatest_ratio(model).ratio;
  if (model.material.volume == VolumeTreatment::PerTet && ratio > *verdict_rule("locking").limit + kRatioRounding) {
    verdict.add("locking", ratio,
                fmt::format("a Poisson's ratio of {:.6g} with specimen.material.volume: per_tet makes tetrahedra "
                            "lock: the cut's errors are too small. volume: averaged avoids this",
                            ratio));
  }
  if (settings.cut.rule != CutSettings{}.rule) {
    verdict.add(
        "cut_rule", std::nullopt,
        fmt::format("the cut was simulated by rule {} (cut.rule), whose cuts have not been compared with anything. "
                    "Where the tool will cut is better known with rule {}",
                    to_string(settings.cut.rule), to_string(CutSettings{}.rule)));
  }
  const double coarsest_mm = *verdict_rule("mesh_resolution").limit;
  const std::optional<double> edge_mm = edge_along_mm(model, stretched, path, settings.plan.approach);
  if (edge_mm && *edge_mm > coarsest_mm) {
    verdict.add("mesh_resolution", *edge_mm,
                fmt::format("the mesh is coarse for a tool of {:.2g} mm: its edges along the path measure {:.2f} mm "
                            "on average, and above {} mm the mesh affects the cut's error as much as the tissue does. "
                            "Refine it: meshing.tets or meshing.fine_mm",
                            2.0 * radius_mm(settings.tool), *edge_mm, coarsest_mm));
  }
  const std::optional<PlatformClearance> platform = platform_clearance(model, path);
  if (platform && platform->height_mm < *verdict_rule("platform").limit) {
    verdict.add("platform", platform->height_mm,
                fmt::format("the tool's tip goes {:.2f} mm below the platform that supports the tissue, at waypoint {}", -platform->height_mm, platform->waypoint),
                VerdictPlace{{}, path.waypoints[platform->waypoint].position_mm, fmt::format("waypoint {}", platform->waypoint)});
  }
  add_made_skin(settings, model, made_skin, stretched, path, verdict);
  return verdict;
}

}  // namespace incise
