#pragma once

#include <incise/geometry/surface_query.hpp>
#include <incise/imaging/made_skin.hpp>
#include <incise/planning/plan_path.hpp>

#include <optional>
#include <span>
#include <string>

namespace incise {

/// The skin of a specimen as it lies now, stretched or not, which knows which of its places are not the specimen's own.
class PlacedSkin {
 public:
  /// @param at_rest  closed. @param now  where its vertices lie now. @pre one place for each vertex.
  PlacedSkin(TriMesh at_rest, std::span<const Vec3> now, MadeSkin made);

  [[nodiscard]] const SurfaceQuery& surface() const { return surface_; }
  /// As MadeSkin, for the point of the skin that is nearest to a place as it lies now.
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

/// Steps in which a margin is looked for, and the greatest that is tried.
inline constexpr double kMarginStepMm = 0.5;
inline constexpr double kMostMarginMm = 20.0;

/// How much lateral margin a ring round an edge can have.
struct MarginRoom {
  std::optional<double> greatest_mm;  ///< nothing: none of those that were tried fits
  bool is_more_possible = false;      ///< greatest_mm is kMostMarginMm, and nothing beyond was tried
  bool is_edge_cut = false;           ///< the edge itself lies on skin that the region or the scan's end has made
};

/// The greatest lateral margin, of kMarginStepMm, twice that, and so on up to kMostMarginMm, at which plan_ring finds a
/// path round an edge, at the depth that the settings have, and no point of the path is on skin that the region or the
/// scan's end has made. It is found by bisection: a margin that fits is taken to fit with less, too.
/// @param edge  closed, on the skin, mm. @param above_mm  margins up to it are not tried: a case asks for more than the
/// electrode's radius. O(log(steps)) plans.
[[nodiscard]] MarginRoom margin_room(const PlacedSkin& skin, const Contour& edge, const PlanSettings& settings,
                                     double above_mm);

/// The same as a sentence without its full stop: "A lateral margin of at most 3.5 mm fits here".
[[nodiscard]] std::string in_words(const MarginRoom& room);

}  // namespace incise
