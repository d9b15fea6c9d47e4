#pragma once

#include <incise/geometry/contour.hpp>

#include <optional>
#include <span>
#include <vector>

namespace incise {

/// Sectors of an error profile. All contours are seen along the approach; heights do not count.
struct ProfileSettings {
  double target_mm = 4.5;                 ///< intended distance of the measured contour, >= 0
  Vec3 approach = -Vec3::UnitZ();         ///< direction in which the camera looks; non-zero
  Vec3 start_direction = -Vec3::UnitY();  ///< middle of the first sector; only its part across the approach counts
  double turn_deg = 0.0;                  ///< turns the first sector from there, counter-clockwise for the camera
  int sectors = 36;                       ///< of equal angle about the middle of the tumour edge; 4 to 360
};

/// Computes the signed error, mm, of a ring by direction from the middle of the tumour edge (the centroid of its
/// curve): means over sectors of equal angle, the first about the start direction, then counter-clockwise as the camera
/// sees them. With profiles, two rings round the same tumour, one simulated and one photographed, can be compared
/// direction by direction.
/// @param incision    closed, mm.
/// @param tumor_edge  closed, mm, same frame.
/// @returns one mean for each sector; nothing if a sector is empty, as when the ring does not enclose the middle.
/// @throws InvalidArgument for settings out of range, and as contour_errors.
/// @note O(points · edge points); points 0.1 mm apart.
[[nodiscard]] std::optional<std::vector<double>> error_profile(const Contour& incision, const Contour& tumor_edge,
                                                               const ProfileSettings& settings);

/// Computes the means of `values` over the sectors, by the direction of each value's place. Sectors as in
/// error_profile; here a single one is enough. `target_mm` of the settings is not used. O(places).
/// @param places      mm, seen along the approach.
/// @param values      one for each place, any unit.
/// @param tumor_edge  closed, mm, same frame.
/// @returns one mean for each sector; nothing if a sector is empty.
/// @throws InvalidArgument for settings out of range, or different numbers of values and places.
[[nodiscard]] std::optional<std::vector<double>> sector_means(const Points& places, std::span<const double> values,
                                                              const Contour& tumor_edge,
                                                              const ProfileSettings& settings);

/// Evaluates a profile at places, by their direction from the middle of the tumour edge: linear between the middles of
/// neighbouring sectors, round the ring. A profile of one sector is constant.
/// @param sectors     1 to 360 values, in the order of error_profile.
/// @param places      mm, seen along the approach. The direction of a place on the middle itself is taken as the
///   picture's x.
/// @param tumor_edge  closed, mm, same frame.
/// @param settings    `target_mm` and `sectors` are not used.
/// @returns one value for each place, in the unit of `sectors`.
/// @throws InvalidArgument for no sector or more than 360, or settings out of range.
[[nodiscard]] std::vector<double> values_at(const std::vector<double>& sectors, const Points& places,
                                            const Contour& tumor_edge, const ProfileSettings& settings);

}  // namespace incise
