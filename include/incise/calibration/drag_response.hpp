#pragma once

#include <vector>

namespace incise {

/// Signed error round the ring of one simulated cut (see error_profile).
struct SimulatedProfile {
  double drag_length_mm = 0.0;          ///< speed · dwell, > 0
  double stiffness_factor = 1.0;        ///< Young's modulus over the specimen's reference, > 0
  std::vector<double> signed_error_mm;  ///< one for each sector; empty: no closed ring
};

/// Returns whether a stiffness factor is 1, the specimen's reference, up to rounding.
[[nodiscard]] bool is_reference_stiffness(double stiffness_factor);

/// Simulated error profile of one specimen as a function of drag length and stiffness, within the simulated range:
/// linear between neighbouring drag lengths at the reference stiffness, plus ln(stiffness factor) times a slope. The
/// slope comes from cuts with a second stiffness at the same drag lengths.
class DragResponse {
 public:
  /// @param profiles  in any order. At the reference stiffness (factor 1), the shortest drag length without a ring ends
  /// the range.
  /// @throws InvalidArgument without two closed rings at the reference stiffness within the range, for profiles of
  /// different lengths, or for a drag length or stiffness factor that is not above 0.
  explicit DragResponse(std::vector<SimulatedProfile> profiles);
  /// Returns whether the profiles contain the two closed rings that the constructor requires.
  [[nodiscard]] static bool can_be_made_of(std::vector<SimulatedProfile> profiles);

  [[nodiscard]] std::size_t sectors() const { return knots_.front().signed_error_mm.size(); }
  /// Least and greatest drag length, mm, between which all cuts at the reference stiffness closed.
  [[nodiscard]] double least_mm() const { return knots_.front().drag_length_mm; }
  [[nodiscard]] double most_mm() const { return knots_.back().drag_length_mm; }
  /// Whether cuts with a second stiffness give a slope.
  [[nodiscard]] bool knows_stiffness() const { return !slopes_.empty(); }

  /// Returns the profile, mm, at a drag length and the reference stiffness.
  /// @throws InvalidArgument for a drag length outside [least_mm(), most_mm()].
  [[nodiscard]] std::vector<double> at(double drag_length_mm) const;
  /// Returns the change of the profile per unit of ln(stiffness factor), mm; zeros without a second stiffness. Beyond
  /// the drag lengths that were cut with it, the slope is that at the nearest of them.
  [[nodiscard]] std::vector<double> stiffness_slope(double drag_length_mm) const;

  /// Returns the mesh's grain, mm: the standard deviation of one simulated sector, estimated from those waves of the
  /// knots that are too fast for tissue.
  [[nodiscard]] double grain_mm() const { return grain_mm_; }
  /// Returns the variance of the grain at a drag length, relative to a knot: 1 at a knot, a half midway between two.
  [[nodiscard]] double grain_share(double drag_length_mm) const;

 private:
  std::vector<SimulatedProfile> knots_;   ///< at the reference stiffness, by drag length
  std::vector<SimulatedProfile> slopes_;  ///< per ln(stiffness factor), by drag length
  double grain_mm_ = 0.0;
};

}  // namespace incise
