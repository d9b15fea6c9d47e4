#pragma once

#include "second_bench/brick_tissue.hpp"

#include <incise/core/monitor.hpp>

namespace incise::second_bench {

inline constexpr double kWeightMnMm3 = 1.06e-6 * 9806.65;  // of muscle

/// The platform under the tissue: points of its sole are pushed back up where they sink into it, and rub.
struct Platform {
  std::vector<Rider> sole;
  std::vector<float> area_mm2;    ///< per point
  std::vector<double> height_mm;  ///< per point: of the platform under it
  std::vector<Vec2> anchor_mm;    ///< per point: where it sticks
  std::vector<std::uint8_t> is_down;
  double friction = 0.0;  ///< coefficient
};
/// Adds the platform's forces. Anchors slide where friction is overcome.
void add_platform(BrickTissue& tissue, Platform& platform);
/// Adds its stiffness to masses.
void add_platform_masses(BrickTissue& tissue, const Platform& platform);

/// Spreads a force at a rider to the corners of its piece.
void add_force(BrickTissue& tissue, const Rider& rider, const Vec3& force_mn);
/// Spreads a stiffness to their masses.
void add_mass(BrickTissue& tissue, const Rider& rider, double stiffness_mn_mm);

struct Rest {
  double residual_mn = 0.0;  ///< norm of forces on free nodes
  double reaction_mn = 0.0;  ///< norm of forces on held nodes

  /// Free forces over reactions.
  [[nodiscard]] double residual() const { return residual_mn / reaction_mn; }
};

/// Dynamic relaxation: nodes with fictitious masses move in steps of 1 with the damping that the last iteration's
/// Rayleigh quotient makes critical [Papadrakakis1981].
class Relaxer {
 public:
  /// One iteration with the forces that are set. @param least_damping  share of velocity taken in an iteration.
  Rest iterate(BrickTissue& tissue, double least_damping);

 private:
  std::vector<std::array<float, 4>> before_;  // forces of the last iteration
};

/// Lets held tissue on its platform come to rest, from no velocity: until Rest::residual() is below `tolerance`, or for
/// `most` iterations.
/// @param viscous_gain  of begin_step(); 0 outside a step.  @param iterations  counts up.
/// @returns the last residual; above the tolerance, or not a number: it did not come to rest.  @throws Cancelled
[[nodiscard]] double come_to_rest(BrickTissue& tissue, Platform& platform, float viscous_gain, double tolerance,
                                  int most, int& iterations, const Monitor& monitor);

}  // namespace incise::second_bench
