#pragma once

#include <incise/geometry/contour.hpp>

#include <optional>
#include <span>
#include <vector>

namespace incise {

/// How a ring's errors become a function of place. All contours are seen along the approach: heights do not count.
struct ProfileSettings {
  double target_mm = 4.5;                 ///< intended distance of the measured contour, >= 0
  Vec3 approach = -Vec3::UnitZ();         ///< direction in which the camera looks; non-zero
  Vec3 start_direction = -Vec3::UnitY();  ///< middle of the first sector; its part across the approach counts
  double turn_deg = 0.0;                  ///< the first sector lies this much farther, counter-clockwise
  int sectors = 36;                       ///< of equal angle about the tumour edge's middle; 4 to 360
};

/// Signed error, mm, of a ring by direction from the middle of the tumour edge (its curve's centroid): means over
/// sectors of equal angle, the first about the start direction, then counter-clockwise against the approach. So two
/// rings round the same tumour, simulated and photographed, can be compared place by place.
/// @param incision    closed, mm.   @param tumor_edge  closed, mm, same frame.
/// @returns one mean for each sector; nothing where a sector is empty: the ring does not go round the tumour's middle.
/// @throws InvalidArgument for settings out of range, and as contour_errors.
/// @note O(points · edge points); points 0.1 mm apart.
[[nodiscard]] std::optional<std::vector<double>> error_profile(const Contour& incision, const Contour& tumor_edge,
                                                               const ProfileSettings& settings);

/// The same of values that are given place by place, seen along the approach.
/// @returns one mean for each sector; nothing where a sector is empty.
/// @throws InvalidArgument for settings out of range or another number of values than places. O(places).
[[nodiscard]] std::optional<std::vector<double>> sector_means(const Points& places, std::span<const double> values,
                                                              const Contour& tumor_edge,
                                                              const ProfileSettings& settings);

/// The other way round: what a profile says of a place, by its direction from the middle of the tumour edge. Linear
/// between the middles of neighbouring sectors, round the ring; one sector says the same everywhere.
/// @param sectors     1 to 360 values, in the order of error_profile.
/// @param places      seen along the approach; a place on the edge's middle has the direction of the first sector.
/// @param tumor_edge  closed, mm, same frame. `target_mm` and `sectors` of the settings are not read.
/// @returns one value for each place.
/// @throws InvalidArgument for no sector or more than 360, or settings out of range.
[[nodiscard]] std::vector<double> values_at(const std::vector<double>& sectors, const Points& places,
                                            const Contour& tumor_edge, const ProfileSettings& settings);

}  // namespace incise
