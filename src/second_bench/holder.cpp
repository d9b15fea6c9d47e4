#include "second_bench/holder.hpp"

#include <algorithm>
#include <cmath>

namespace incise::second_bench {
namespace {

constexpr double kPlatformKpaMm = 20.0;  // pressure per depth
constexpr double kMostDamping = 1.9;     // below 2, at which an iteration keeps no velocity
constexpr int kRenewed = 20;             // iterations between two updates of the masses
constexpr int kLeastIterations = 20;     // before the residual is tested

}  // namespace

void add_force(BrickTissue& tissue, const Rider& rider, const Vec3& force_mn) {
  for (int c = 0; c < 8; ++c) {
    auto& f = tissue.force[static_cast<std::size_t>(tissue.node(rider.piece, c))];
    const float w = rider.weights[static_cast<std::size_t>(c)];
    for (std::size_t axis = 0; axis < 3; ++axis)
      f[axis] += w * static_cast<float>(force_mn[static_cast<Eigen::Index>(axis)]);
  }
}

void add_mass(BrickTissue& tissue, const Rider& rider, double stiffness_mn_mm) {
  for (int c = 0; c < 8; ++c)
    tissue.mass[static_cast<std::size_t>(tissue.node(rider.piece, c))] +=
        std::abs(rider.weights[static_cast<std::size_t>(c)]) * kMassShare * static_cast<float>(stiffness_mn_mm);
}

void add_platform(BrickTissue& tissue, Platform& platform) {
  for (std::size_t n = 0; n < platform.sole.size(); ++n) {
    if (!tissue.is_there(platform.sole[n].piece)) continue;
    const Vec3 p = tissue.position_of(platform.sole[n]);
    const double depth = platform.height_mm[n] - p.z();
    if (depth <= 0.0) {
      platform.is_down[n] = 0;
      continue;
    }
    const double stiffness = kPlatformKpaMm * static_cast<double>(platform.area_mm2[n]);
    const double push = stiffness * depth;
    if (platform.is_down[n] == 0) platform.anchor_mm[n] = p.head<2>();
    platform.is_down[n] = 1;
    const Vec2 way = p.head<2>() - platform.anchor_mm[n];
    const double most = platform.friction * push / stiffness;  // greatest elongation of the spring, mm
    const double drawn = way.norm();
    Vec2 held = way;
    if (drawn > most) {
      held *= most / drawn;
      platform.anchor_mm[n] = p.head<2>() - held;
    }
    add_force(tissue, platform.sole[n], Vec3(-stiffness * held.x(), -stiffness * held.y(), push));
  }
}

void add_platform_masses(BrickTissue& tissue, const Platform& platform) {
  for (std::size_t n = 0; n < platform.sole.size(); ++n)
    if (tissue.is_there(platform.sole[n].piece))
      add_mass(tissue, platform.sole[n], kPlatformKpaMm * static_cast<double>(platform.area_mm2[n]));
}

Rest Relaxer::iterate(BrickTissue& tissue, double least_damping) {
  const std::size_t count = tissue.position.size();
  double curved = 0.0, kinetic = 0.0;
  const std::size_t known = before_.size();
  for (std::size_t n = 1; n < known; ++n) {
    if (tissue.is_held[n] != 0) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const double v = static_cast<double>(tissue.velocity[n][a]);
      curved -= v * static_cast<double>(tissue.force[n][a] - before_[n][a]);
      kinetic += static_cast<double>(tissue.mass[n]) * v * v;
    }
  }
  const double damping = std::clamp(kinetic > 0.0 && curved > 0.0 ? 2.0 * std::sqrt(curved / kinetic) : least_damping,
                                    least_damping, kMostDamping);
  before_ = tissue.force;
  Rest rest;
  double residual = 0.0, reaction = 0.0;
  const auto keep = static_cast<float>((1.0 - 0.5 * damping) / (1.0 + 0.5 * damping));
  const auto gain = static_cast<float>(1.0 / (1.0 + 0.5 * damping));
  for (std::size_t n = 1; n < count; ++n) {
    const float mass = tissue.mass[n];
    auto& f = tissue.force[n];
    const double squared = static_cast<double>(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    if (tissue.is_held[n] != 0) {
      reaction += squared;
      continue;
    }
    if (mass == 0.0F) continue;  // of no piece
    residual += squared;
    for (std::size_t a = 0; a < 3; ++a) {
      float& v = tissue.velocity[n][a];
      v = keep * v + gain * f[a] / mass;
      tissue.position[n][a] += v;
    }
  }
  rest.residual_mn = std::sqrt(residual);
  rest.reaction_mn = std::sqrt(reaction);
  return rest;
}

double come_to_rest(BrickTissue& tissue, Platform& platform, float viscous_gain, double tolerance, int most,
                    int& iterations, const Monitor& monitor) {
  for (auto& velocity : tissue.velocity) velocity = {};
  Relaxer relaxer;
  Rest rest;
  for (int n = 0; n < most; ++n) {
    if (n % kRenewed == 0) {
      throw_if_cancelled(monitor, "letting tissue come to rest");
      bound_masses(tissue, viscous_gain);
      add_platform_masses(tissue, platform);
    }
    set_tissue_forces(tissue, viscous_gain, static_cast<float>(kWeightMnMm3));
    add_platform(tissue, platform);
    rest = relaxer.iterate(tissue, 0.0);
    ++iterations;
    if (n > kLeastIterations && rest.residual() < tolerance) break;
  }
  return rest.residual();
}

}  // namespace incise::second_bench
