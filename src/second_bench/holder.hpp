#pragma once

#include "second_bench/brick_tissue.hpp"

#include <incise/core/monitor.hpp>

namespace incise::second_bench {

inline constexpr double kWeightMnMm3 = 1.06e-6 * 9806.65;  // of muscle

/// The platform under the tissue. It pushes points of the tissue's sole up that sink into it, and exerts friction on
/// them.
struct Platform {
  std::vector<Rider> sole;
  std::vector<float> area_mm2;        ///< per point
  std::vector<double> height_mm;      ///< per point: of the platform under it
  std::vector<Vec2> anchor_mm;        ///< per point: where it sticks
  std::vector<std::uint8_t> is_down;  ///< per point: 1 on the platform
  double friction = 0.0;              ///< coefficient
};
/// Adds the platform's forces. Anchors slide where friction is overcome.
void add_platform(BrickTissue& tissue, Platform& platform);
/// Adds the fictitious mass for the platform's stiffness.
void add_platform_masses(BrickTissue& tissue, const Platform& platform);

/// Distributes a force at a rider to the corners of its piece.
void add_force(BrickTissue& tissue, const Rider& rider, const Vec3& force_mn);
/// Distributes the fictitious mass for a stiffness at a rider to the corners of its piece.
void add_mass(BrickTissue& tissue, const Rider& rider, double stiffness_mn_mm);

/// Norms of the forces in an iteration.
struct Rest {
  double residual_mn = 0.0;  ///< norm of forces on free nodes
  double reaction_mn = 0.0;  ///< norm of forces on held nodes

  /// Returns free forces divided by reactions.
  [[nodiscard]] double residual() const { return residual_mn / reaction_mn; }
};

/// Dynamic relaxation: nodes with fictitious masses move in steps of 1, with the damping that is critical by the last
/// iteration's Rayleigh quotient [Papadrakakis1981].
class Relaxer {
 public:
  /// Does one iteration with the forces in tissue.force.
  /// @param least_damping  lower bound of the damping, [0, 1.9]: about the share of velocity lost in an iteration.
  Rest iterate(BrickTissue& tissue, double least_damping);

 private:
  std::vector<std::array<float, 4>> before_;  // forces of the last iteration
};

/// Lets held tissue on its platform come to rest, starting with zero velocity: until Rest::residual() is below
/// `tolerance`, or for at most `most` iterations.
/// @param viscous_gain  from begin_step(); 0 outside a step.
/// @param iterations    is increased by the number of iterations.
/// @returns the last residual; if above the tolerance or not a number, the tissue did not come to rest.
/// @throws Cancelled
[[nodiscard]] double come_to_rest(BrickTissue& tissue, Platform& platform, float viscous_gain, double tolerance,
                                  int most, int& iterations, const Monitor& monitor);

}  // namespace incise::second_bench
