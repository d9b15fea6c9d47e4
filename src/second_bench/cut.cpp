#include "second_bench/body_state.hpp"

#include <incise/core/defaults.hpp>
#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/second_bench/cut.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>

namespace incise::second_bench {
namespace {

constexpr double kNeedleMm = kElectrodeRadiusMm;
constexpr double kContactKpaMm = 100.0;  // pressure per depth of tissue inside the needle
constexpr double kShellMm = 0.25;        // beyond the metal: tissue within it sticks to the needle
constexpr double kStickMm = 0.1;         // slip at which adhesion has 1/√2 of its strength
constexpr double kEngagedMm = 5.0;       // length of needle that must be in tissue to use the arc's whole power
constexpr double kHalfSpeedMmS = 7.0;    // at which adhesion has half its strength at high speed
constexpr double kCookedMm = 1.0;        // beyond the arc's reach: tissue within it is heated enough to shrink
constexpr double kBreathS = 4.0;
constexpr double kDwellStepS = 0.5;
constexpr double kCuttingShare = 0.9;  // of a cut's time; the rest is settling
constexpr double kOnAxisMm = 1e-6;     // nearer than this a push has no direction
constexpr double kLeastDamping = 0.12;
constexpr int kRenewed = 8;  // iterations between two updates of the masses
constexpr double kPhotographS = 34.0;  // after the cut
constexpr int kMostSettling = 600;
constexpr double kAtRest = 3e-3;  // free forces over reactions

struct Needle {
  Vec3 tip = Vec3::Zero();
  Vec3 axis = -Vec3::UnitZ();
  /// Returns the vector from the nearest point of the needle's axis to a point, mm.
  [[nodiscard]] Vec3 offset(const Vec3& p) const {
    const double above = std::max(0.0, -(p - tip).dot(axis));
    return p - (tip - above * axis);
  }
};

struct NearVoxel {
  Rider rider;
  std::size_t brick = 0;
  int bit = 0;
  double volume_mm3 = 0.0;
  double area_mm2 = 0.0;       // of a face, about
  Vec3 before = Vec3::Zero();  // position at the step's start
  Vec3 drag = Vec3::Zero();    // the needle's force on it in the last iteration, mN
};

Needle between(const TipPose& a, const TipPose& b, double share) {
  return {a.tip_mm + share * (b.tip_mm - a.tip_mm), (a.axis + share * (b.axis - a.axis)).normalized()};
}

class Cutting {
 public:
  Cutting(const Body& body, double power_w)
      : specimen_(body.specimen), resolution_(body.resolution), state_(*body.state), power_w_(power_w) {}

  Cut run(const std::vector<TipPose>& course, Monitor& monitor) {
    const std::vector<TipPose> poses = steps_of(course);
    for (const std::int32_t node : state_.suture_nodes)
      suture_start_.push_back(state_.tissue.position[static_cast<std::size_t>(node)]);
    result_.steps = static_cast<int>(poses.size()) - 1;
    for (std::size_t n = 1; n < poses.size(); ++n) {
      throw_if_cancelled(monitor, "cutting");
      const double share = static_cast<double>(n) / static_cast<double>(result_.steps);
      creep(share);
      step(poses[n - 1], poses[n], poses[n].time_s - poses[n - 1].time_s);
      travelled_mm_ += (poses[n].tip_mm - poses[n - 1].tip_mm).norm();
      monitor.progress("cutting", kCuttingShare * share);
    }
    result_.mean_force_mn /= result_.steps;
    settle(monitor);
    if (!(result_.residual < kAtRest)) result_.outcome = Outcome::NotConverged;
    result_.after = std::make_shared<const BodyState>(std::move(state_));
    return std::move(result_);
  }

 private:
  /// Returns the poses at the ends of steps, at most way_mm and half a second apart, relative to the swaying tissue.
  [[nodiscard]] std::vector<TipPose> steps_of(const std::vector<TipPose>& course) const {
    std::vector<TipPose> part;
    std::vector<double> done;  // per pose: steps until it
    for (const TipPose& pose : course) {
      if (!pose.is_cutting) continue;
      const double way = part.empty() ? 0.0 : (pose.tip_mm - part.back().tip_mm).norm() / resolution_.way_mm;
      const double time = part.empty() ? 0.0 : (pose.time_s - part.back().time_s) / kDwellStepS;
      done.push_back(part.empty() ? 0.0 : done.back() + std::max(way, time));
      part.push_back(pose);
    }
    INCISE_REQUIRE(part.size() >= 2 && done.back() > 0.0 && part.back().time_s > part.front().time_s,
                   "expected a course that cuts");
    const int steps = static_cast<int>(std::ceil(done.back()));
    std::vector<TipPose> poses;
    std::size_t segment = 0;
    for (int n = 0; n <= steps; ++n) {
      const double at = done.back() * n / steps;
      while (segment + 2 < part.size() && done[segment + 1] <= at) ++segment;
      const TipPose &a = part[segment], &b = part[segment + 1];
      const double span = done[segment + 1] - done[segment];
      const double share = span > 0.0 ? std::min(1.0, (at - done[segment]) / span) : 1.0;
      const Needle needle = between(a, b, share);
      const double time = a.time_s + share * (b.time_s - a.time_s);
      const double whole_s = part.back().time_s - part.front().time_s;
      const double since_s = time - part.front().time_s;
      poses.push_back({time, needle.tip + swayed_mm(since_s, since_s / whole_s), needle.axis, true});
    }
    return poses;
  }

  /// Returns the displacement of the tool relative to tissue that breathes and drifts, mm.
  [[nodiscard]] Vec3 swayed_mm(double time_s, double share) const {
    const double phase = Random(stream_of(specimen_.seed, "breath")).uniform(0.0, 2.0 * units::kPi);
    const double breath = std::sin(2.0 * units::kPi * time_s / kBreathS + phase);
    return {-share * specimen_.drift_mm, 0.0, -specimen_.breathing_mm * breath};
  }

  /// The suture cuts into the tissue: its grip moves back towards the root.
  void creep(double share) {
    for (std::size_t n = 0; n < suture_start_.size(); ++n)
      state_.tissue.position[static_cast<std::size_t>(state_.suture_nodes[n])][1] =
          suture_start_[n][1] + static_cast<float>(share * specimen_.suture_creep_mm);
  }

  void find_near(const Needle& from, const Needle& to) {
    near_.clear();
    BrickTissue& tissue = state_.tissue;
    const double reach = kNeedleMm + specimen_.reach_mm + kCookedMm + 0.5 * (to.tip - from.tip).norm();
    const Needle middle{0.5 * (from.tip + to.tip), (from.axis + to.axis).normalized()};
    for (std::size_t p = 0; p < tissue.piece_count(); ++p) {
      if (tissue.voxels_of[p] == 0) continue;
      Vec3 low = Vec3::Constant(1e9), high = -low;
      for (int c = 0; c < 8; ++c) {
        const auto& q = tissue.position[static_cast<std::size_t>(tissue.node(static_cast<int>(p), c))];
        const Vec3 at(q[0], q[1], q[2]);
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
      }
      const double half = 0.5 * (high - low).norm();
      if (middle.offset(0.5 * (low + high)).norm() > reach + half) continue;
      const std::array<int, 3> place = tissue.grid.place_of(tissue.brick_of[p]);
      const double volume = tissue.grid.size_mm(place).prod() / kVoxels;
      for (Voxels left = tissue.voxels_of[p]; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        NearVoxel voxel;
        voxel.rider = tissue.rider_on(static_cast<int>(p), tissue.grid.voxel_mm(place, bit));
        voxel.before = tissue.position_of(voxel.rider);
        if (middle.offset(voxel.before).norm() > reach) continue;
        voxel.brick = tissue.brick_of[p];
        voxel.bit = bit;
        voxel.volume_mm3 = volume;
        voxel.area_mm2 = std::cbrt(volume * volume);
        near_.push_back(voxel);
      }
    }
  }

  /// The greatest traction of adhesion at the present speed, kPa.
  [[nodiscard]] double adhesion_kpa() const {
    return specimen_.adhesion_kpa * (1.0 + specimen_.char_per_mm * travelled_mm_) * speed_mm_s_ /
           (speed_mm_s_ + kHalfSpeedMmS);
  }

  /// Adds the needle's forces on tissue. @returns their sum, mN.
  Vec3 add_needle(const Needle& needle, const Vec3& way) {
    const double adhesion = adhesion_kpa();
    Vec3 sum = Vec3::Zero();
    for (NearVoxel& voxel : near_) {
      const Vec3 p = state_.tissue.position_of(voxel.rider);
      const Vec3 offset = needle.offset(p);
      const double d = offset.norm();
      voxel.drag.setZero();
      if (d > kNeedleMm + kShellMm) continue;
      if (d < kNeedleMm && d > kOnAxisMm) voxel.drag += kContactKpaMm * voxel.area_mm2 * (kNeedleMm - d) / d * offset;
      const Vec3 slip = way - (p - voxel.before);
      voxel.drag += adhesion * voxel.area_mm2 / std::sqrt(slip.squaredNorm() + kStickMm * kStickMm) * slip;
      sum += voxel.drag;
      add_force(state_.tissue, voxel.rider, voxel.drag);
    }
    return sum;
  }

  /// Adds the fictitious masses for the stiffness of these forces.
  void add_needle_masses(const Needle& needle) {
    const double adhesion = adhesion_kpa();
    for (const NearVoxel& voxel : near_) {
      const double d = needle.offset(state_.tissue.position_of(voxel.rider)).norm();
      if (d > kNeedleMm + kShellMm) continue;
      add_mass(state_.tissue, voxel.rider,
               voxel.area_mm2 * ((d < kNeedleMm ? kContactKpaMm : 0.0) + adhesion / kStickMm));
    }
  }

  void step(const TipPose& from, const TipPose& to, double step_s) {
    BrickTissue& tissue = state_.tissue;
    // The needle bends under the force of the previous step.
    const Vec3 bent = -1e-3 * specimen_.bending_mm_n * force_mn_;
    TipPose first = from, last = to;
    first.tip_mm += bent_mm_;
    last.tip_mm += bent;
    bent_mm_ = bent;
    speed_mm_s_ = (to.tip_mm - from.tip_mm).norm() / step_s;
    const Needle start{first.tip_mm, first.axis}, end{last.tip_mm, last.axis};
    find_near(start, end);
    const float gain = begin_step(tissue, state_.viscous_ratio, state_.viscous_time_s, static_cast<float>(step_s));
    const int count = resolution_.relaxations;
    for (int n = 0; n < count; ++n) {
      const double share = std::min(1.0, (n + 1.0) / (0.5 * count));  // rests at the step's end in the second half
      const Needle needle = between(first, last, share);
      const Vec3 way = share * (last.tip_mm - first.tip_mm);
      if (n % kRenewed == 0) {
        bound_masses(tissue, gain);
        add_platform_masses(tissue, state_.platform);
        add_needle_masses(needle);
      }
      set_tissue_forces(tissue, gain, static_cast<float>(kWeightMnMm3));
      add_platform(tissue, state_.platform);
      force_mn_ = add_needle(needle, way);
      relaxer_.iterate(tissue, kLeastDamping);
      ++result_.iterations;
    }
    end_step(tissue, gain);
    result_.mean_force_mn += force_mn_.norm();
    result_.max_force_mn = std::max(result_.max_force_mn, force_mn_.norm());
    burn(end, last.tip_mm - first.tip_mm, step_s);
    if (specimen_.shrinking > 0.0) cook(end);
  }

  /// Adds the effects of heat and force to the dose of tissue in reach, and removes voxels whose dose is full.
  void burn(const Needle& needle, const Vec3& way, double step_s) {
    BrickTissue& tissue = state_.tissue;
    const double reach = kNeedleMm + specimen_.reach_mm;
    std::vector<double> weights(near_.size(), 0.0);
    double sum = 0.0;
    for (std::size_t n = 0; n < near_.size(); ++n) {
      const double d = needle.offset(tissue.position_of(near_[n].rider)).norm();
      if (d >= reach) continue;
      const double share = 1.0 - d * d / (reach * reach);
      weights[n] = share * near_[n].volume_mm3;
      sum += weights[n];
    }
    // A full arc needs an eighth of the disc in reach, over the engaged length of the needle; weights average 1/2.
    const double least = 0.5 * 0.125 * units::kPi * reach * reach * kEngagedMm;
    const double heat_j = std::max(0.0, power_w_ - specimen_.lost_power_w) * step_s;
    std::map<int, Voxels> gone;
    for (std::size_t n = 0; n < near_.size(); ++n) {
      NearVoxel& voxel = near_[n];
      auto& dose = dose_[voxel.brick];
      float& taken = dose[static_cast<std::size_t>(voxel.bit)];
      const double energy = static_cast<double>(state_.energy_j[voxel.brick]);
      const double heat = heat_j * weights[n] / std::max(sum, least) / energy;
      const double slip_work = voxel.drag.dot(way - (tissue.position_of(voxel.rider) - voxel.before));
      const double torn = std::max(0.0, slip_work) / (specimen_.toughness_j_m2 * voxel.area_mm2);  // J/m² are mN/mm
      taken += static_cast<float>(heat + torn);
      if (taken < 1.0F) continue;
      gone[voxel.rider.piece] |= Voxels{1} << voxel.bit;
      ++(heat > torn ? result_.parted_by_heat : result_.parted_by_force);
    }
    if (gone.empty()) return;
    remove_voxels(tissue, {gone.begin(), gone.end()});
    remove_loose(tissue);
  }

  /// Shrinks heated tissue.
  void cook(const Needle& needle) {
    BrickTissue& tissue = state_.tissue;
    const double reach = kNeedleMm + specimen_.reach_mm + kCookedMm;
    std::set<std::size_t> bricks;
    for (const NearVoxel& voxel : near_) {
      const int piece = tissue.piece_with(voxel.brick, voxel.bit);
      if (piece < 0) continue;
      if (needle
              .offset(tissue.position_of(
                  tissue.rider_on(piece, tissue.grid.voxel_mm(tissue.grid.place_of(voxel.brick), voxel.bit))))
              .norm() >= reach)
        continue;
      Voxels& cooked = cooked_[voxel.brick];
      const Voxels before = cooked;
      cooked |= Voxels{1} << voxel.bit;
      if (cooked != before) bricks.insert(voxel.brick);
    }
    for (const std::size_t brick : bricks)
      for (const int piece : tissue.pieces_of[brick]) {
        const Voxels voxels = tissue.voxels_of[static_cast<std::size_t>(piece)];
        const double share = static_cast<double>(std::popcount(voxels & cooked_[brick])) / std::popcount(voxels);
        shrink(tissue, piece, static_cast<float>(1.0 - specimen_.shrinking * share));
      }
  }

  /// Lets the tissue come to rest, the needle out, in the time until the photograph.
  void settle(const Monitor& monitor) {
    for (const double step_s : {1.0, 3.0, 10.0, kPhotographS - 14.0}) {
      const float gain =
          begin_step(state_.tissue, state_.viscous_ratio, state_.viscous_time_s, static_cast<float>(step_s));
      result_.residual =
          come_to_rest(state_.tissue, state_.platform, gain, kAtRest, kMostSettling, result_.iterations, monitor);
      end_step(state_.tissue, gain);
    }
  }

  const Specimen& specimen_;
  const Resolution& resolution_;
  BodyState state_;
  double power_w_;
  Relaxer relaxer_;
  std::vector<NearVoxel> near_;
  std::map<std::size_t, std::array<float, kVoxels>> dose_;
  std::vector<std::array<float, 4>> suture_start_;
  std::map<std::size_t, Voxels> cooked_;
  Vec3 force_mn_ = Vec3::Zero();  // of the needle on tissue
  Vec3 bent_mm_ = Vec3::Zero();
  double speed_mm_s_ = 0.0;
  double travelled_mm_ = 0.0;
  Cut result_;
};

}  // namespace

Cut cut_specimen(const Body& body, const std::vector<TipPose>& course, double power_w, Monitor& monitor) {
  INCISE_REQUIRE(body.outcome == Outcome::Success, "expected a body at rest");
  INCISE_REQUIRE(power_w > 0.0 && std::isfinite(power_w), fmt::format("expected a power above 0 W, found {}", power_w));
  return Cutting(body, power_w).run(course, monitor);
}

Contour tumor_edge_rest_of(const BodyState& state) {
  return {state.tumor_edge_rest, true};
}

Contour tumor_edge_of(const BodyState& state) {
  Contour edge;
  for (const Vec3& rest : state.tumor_edge_rest) {
    const Rider rider = state.tissue.rider_at(rest);
    INCISE_REQUIRE(rider.piece >= 0, "expected tissue within three bricks of the tumour's edge");
    edge.points.push_back(state.tissue.position_of(rider));
  }
  return edge;
}

}  // namespace incise::second_bench
