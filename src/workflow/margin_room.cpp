#include <incise/core/error.hpp>
#include <incise/workflow/margin_room.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace incise {
namespace {

TriMesh moved(const TriMesh& surface, std::span<const Vec3> now) {
  INCISE_REQUIRE(surface.vertices.size() == now.size(), "expected one place for each vertex of the skin");
  return {{now.begin(), now.end()}, surface.triangles};
}

bool has_cut_skin(const PlacedSkin& skin, const Points& places) {
  return std::ranges::any_of(places, [&](const Vec3& place) { return skin.cut_at(place).has_value(); });
}

bool fits(const PlacedSkin& skin, const Contour& edge, PlanSettings settings, double margin_mm) {
  settings.lateral_margin_mm = margin_mm;
  try {
    return !has_cut_skin(skin, entry_contour(plan_ring(skin.surface(), edge, settings)).points);
  } catch (const CaseError&) {
    return false;
  }
}

}  // namespace

PlacedSkin::PlacedSkin(TriMesh at_rest, std::span<const Vec3> now, MadeSkin made)
    : at_rest_(std::move(at_rest)), made_(std::move(made)), surface_(moved(at_rest_, now)) {}

PlacedSkin::AtRest PlacedSkin::at_rest(const Vec3& place) const {
  const SurfacePoint nearest = surface_.nearest(place);
  const auto& [i, j, k] = at_rest_.triangles[nearest.triangle.index()];
  const Vec3 &a = at_rest_.vertices[i.index()], &b = at_rest_.vertices[j.index()], &c = at_rest_.vertices[k.index()];
  const Vec3& share = nearest.barycentric;
  return {share[0] * a + share[1] * b + share[2] * c, (b - a).cross(c - a).stableNormalized()};
}

std::optional<RegionFace> PlacedSkin::cut_at(const Vec3& place) const {
  if (made_.empty()) return std::nullopt;
  const AtRest rest = at_rest(place);
  return made_.cut_at(rest.place, rest.normal);
}

bool PlacedSkin::is_painted(const Vec3& place) const {
  if (made_.empty()) return false;
  const AtRest rest = at_rest(place);
  return made_.is_painted(rest.place, rest.normal);
}

MarginRoom margin_room(const PlacedSkin& skin, const Contour& edge, const PlanSettings& settings, double above_mm) {
  MarginRoom room;
  room.is_edge_cut = has_cut_skin(skin, edge.points);
  if (room.is_edge_cut) return room;
  const int untried = static_cast<int>(std::floor(above_mm / kMarginStepMm));
  const int most = static_cast<int>(kMostMarginMm / kMarginStepMm);
  int fitting = untried, too_many = most + 1;
  while (too_many - fitting > 1) {
    const int steps = (fitting + too_many) / 2;
    (fits(skin, edge, settings, kMarginStepMm * steps) ? fitting : too_many) = steps;
  }
  if (fitting > untried) room.greatest_mm = kMarginStepMm * fitting;
  room.is_more_possible = fitting == most;
  return room;
}

std::string in_words(const MarginRoom& room) {
  if (room.is_edge_cut)
    return "The tumour's edge itself lies where the region of interest or the end of the scan cuts through the tissue";
  if (!room.greatest_mm) return "No lateral margin fits here";
  return fmt::format("A lateral margin of {} {:g} mm fits here", room.is_more_possible ? "at least" : "at most",
                     *room.greatest_mm);
}

}  // namespace incise
