#pragma once

#include <incise/geometry/surface_query.hpp>
#include <incise/imaging/made_skin.hpp>
#include <incise/planning/plan_path.hpp>

#include <optional>
#include <span>
#include <string>

namespace incise {

/// Skin of a specimen at its current place, stretched or not, which knows which of its places are artificial.
class PlacedSkin {
 public:
  /// @param at_rest  closed, mm. @param now  current positions of its vertices, mm.
  /// @throws InvalidArgument unless there is one position for each vertex.
  PlacedSkin(TriMesh at_rest, std::span<const Vec3> now, MadeSkin made);

  [[nodiscard]] const SurfaceQuery& surface() const { return surface_; }
  /// As in MadeSkin, for the point of the skin nearest to a current place, mm.
  [[nodiscard]] std::optional<RegionFace> cut_at(const Vec3& place) const;
  [[nodiscard]] bool is_painted(const Vec3& place) const;

 private:
  struct AtRest {
    Vec3 place, normal;
  };
  [[nodiscard]] AtRest at_rest(const Vec3& place) const;

  TriMesh at_rest_;
  MadeSkin made_;
  SurfaceQuery surface_;
};

/// Step of the search for a margin, and the greatest margin that is tried.
inline constexpr double kMarginStepMm = 0.5;
inline constexpr double kMostMarginMm = 20.0;

/// Greatest lateral margin of a ring round an edge.
struct MarginRoom {
  std::optional<double> greatest_mm;  ///< nullopt: no margin that was tried fits
  bool is_more_possible = false;      ///< greatest_mm is kMostMarginMm; larger margins were not tried
  bool is_edge_cut = false;           ///< the edge lies on skin that the region of interest or the end of the scan made
};

/// Finds the greatest multiple of kMarginStepMm, up to kMostMarginMm, that is possible as lateral margin: plan_ring
/// finds a path round the edge, at the depth in the settings, and no point of the path lies on skin that the region of
/// interest or the end of the scan made. Found by bisection, which assumes that smaller margins than one that fits also
/// fit.
/// @param edge  closed, on the skin, mm. @param above_mm  margins up to this are not tried: a case requires more than
/// the electrode's radius. O(log(steps)) plans.
[[nodiscard]] MarginRoom margin_room(const PlacedSkin& skin, const Contour& edge, const PlanSettings& settings,
                                     double above_mm);

/// Describes the result in a sentence without its full stop: "A lateral margin of at most 3.5 mm fits here".
[[nodiscard]] std::string in_words(const MarginRoom& room);

}  // namespace incise
