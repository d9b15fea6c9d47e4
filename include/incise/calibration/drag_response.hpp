#pragma once

#include <vector>

namespace incise {

/// The signed error round the ring that one simulated cut left (see error_profile).
struct SimulatedProfile {
  double drag_length_mm = 0.0;          ///< speed · dwell, > 0
  double stiffness_factor = 1.0;        ///< Young's modulus over the specimen's reference, > 0
  std::vector<double> signed_error_mm;  ///< one for each sector; empty: no closed ring
};

/// Whether a run is one at the specimen's reference stiffness: a factor of 1, but for rounding.
[[nodiscard]] bool is_reference_stiffness(double stiffness_factor);

/// What the simulation of one specimen says of its profile for any drag length and stiffness within what was simulated:
/// straight lines between neighbouring drag lengths at the reference stiffness, plus ln(stiffness factor) times a slope
/// that is found where a second stiffness was cut with the same drag length.
class DragResponse {
 public:
  /// @param profiles  in any order; those without a ring end the range of drag lengths.
  /// @throws InvalidArgument without two closed rings at the reference stiffness (factor 1), for profiles of different
  /// length, or numbers out of range.
  explicit DragResponse(std::vector<SimulatedProfile> profiles);
  /// Whether there are the two closed rings that it takes.
  [[nodiscard]] static bool can_be_made_of(std::vector<SimulatedProfile> profiles);

  [[nodiscard]] std::size_t sectors() const { return knots_.front().signed_error_mm.size(); }
  /// Least and greatest drag length, mm, between which all cuts at the reference stiffness closed.
  [[nodiscard]] double least_mm() const { return knots_.front().drag_length_mm; }
  [[nodiscard]] double most_mm() const { return knots_.back().drag_length_mm; }
  /// A longer drag length than most_mm() was simulated and left no closed ring.
  [[nodiscard]] bool is_ended_by_failure() const { return is_ended_by_failure_; }
  /// A second stiffness was cut.
  [[nodiscard]] bool knows_stiffness() const { return !slopes_.empty(); }

  /// Profile, mm, at a drag length (clamping is the caller's business) and the reference stiffness.
  /// @pre least_mm() <= drag_length_mm <= most_mm().
  [[nodiscard]] std::vector<double> at(double drag_length_mm) const;
  /// Its change per unit of ln(stiffness factor), mm; zeros without a second stiffness. Outside the drag lengths that
  /// were cut with it: that of the nearest.
  [[nodiscard]] std::vector<double> stiffness_slope(double drag_length_mm) const;

  /// The mesh's grain: sd of one simulated sector, taken from the waves of the knots that are too fast for tissue; mm.
  [[nodiscard]] double grain_mm() const { return grain_mm_; }
  /// Share of one knot's variance that is left at a drag length: 1 at a knot, a half in the middle between two.
  [[nodiscard]] double grain_share(double drag_length_mm) const;

 private:
  std::vector<SimulatedProfile> knots_;   ///< at the reference stiffness, by drag length
  std::vector<SimulatedProfile> slopes_;  ///< per ln(stiffness factor), by drag length
  double grain_mm_ = 0.0;
  bool is_ended_by_failure_ = false;
};

}  // namespace incise
