#include "robot/hull.hpp"
#include "robot/joint_motion.hpp"

#include <incise/core/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::robot_detail {
namespace {

constexpr double kTieOfMerit = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The joints along the poses on one branch.
struct Candidate {
  std::vector<Joints> q;
  std::size_t failed_pose = 0;  ///< the number of poses if all can be reached
  InverseOutcome why = InverseOutcome::Solved;
};

std::array<Candidate, 8> follow_all(const RobotProgram& program, const ArmSetup& setup, double spin_rad) {
  const Mat4 T_tool_flange = setup.T_flange_tool.inverse();
  const Mat3 spin = Eigen::AngleAxisd(spin_rad, Vec3::UnitZ()).toRotationMatrix();
  std::array<Candidate, 8> candidates;
  std::array<bool, 8> is_open;
  is_open.fill(true);
  for (std::size_t i = 0; i < program.poses.size(); ++i) {
    Mat4 T_base_tool = Mat4::Identity();
    T_base_tool.topLeftCorner<3, 3>() = program.poses[i].R_robot_tool * spin;
    T_base_tool.topRightCorner<3, 1>() = program.poses[i].tip_mm;
    const InverseResult inverse = inverse_kinematics(setup.arm, T_base_tool * T_tool_flange);
    std::array<bool, 8> is_solved{};
    for (const InverseSolution& solution : inverse.solutions) {
      const auto b = static_cast<std::size_t>(solution.branch.index());
      is_solved[b] = true;
      if (!is_open[b]) continue;
      auto& q = candidates[b].q;
      q.push_back(q.empty() ? solution.q_rad : nearest_turns(solution.q_rad, q.back()));
    }
    for (std::size_t b = 0; b < 8; ++b) {
      if (!is_open[b] || is_solved[b]) continue;
      is_open[b] = false;
      candidates[b].failed_pose = i;
      candidates[b].why = inverse.outcome == InverseOutcome::Solved ? InverseOutcome::TooFar : inverse.outcome;
    }
    if (std::none_of(is_open.begin(), is_open.end(), [](bool open) { return open; })) break;
  }
  for (std::size_t b = 0; b < 8; ++b) {
    if (is_open[b]) candidates[b].failed_pose = program.poses.size();
  }
  return candidates;
}

/// Shifts each joint by whole turns: into its limits if possible, and near to `setup.near_rad`.
void take_nearest_turns(std::vector<Joints>& q, const ArmSetup& setup) {
  for (int j = 0; j < 6; ++j) {
    double low = kInfinity, high = -kInfinity;
    for (const Joints& at : q) {
      low = std::min(low, at[j]);
      high = std::max(high, at[j]);
    }
    double best_shift = 0.0, best_cost = kInfinity;
    for (int turns = -2; turns <= 2; ++turns) {
      const double shift = 2.0 * units::kPi * turns;
      const double outside = std::max({0.0, setup.arm.min_rad[j] - low - shift, high + shift - setup.arm.max_rad[j]});
      const double cost = 1e3 * outside + std::abs(q.front()[j] + shift - setup.near_rad[j]);
      if (cost < best_cost) {
        best_cost = cost;
        best_shift = shift;
      }
    }
    for (Joints& at : q) at[j] += best_shift;
  }
}

/// Merit of a candidate (see choose_branch). Once it is below `floor`, returns any value below `floor`.
double merit_of(const std::vector<Joints>& q, const ArmSetup& setup, const BranchPreferences& preferences,
                double floor) {
  const std::size_t stride = std::max<std::size_t>(1, q.size() / static_cast<std::size_t>(preferences.places));
  const Instrument instrument{setup.T_flange_tool};
  double merit = 1.0;
  for (std::size_t i = 0; i < q.size() && merit >= floor; i += stride) {
    const double margin = std::min((q[i] - setup.arm.min_rad).minCoeff(), (setup.arm.max_rad - q[i]).minCoeff());
    merit = std::min(merit, units::deg_from_rad(margin) / preferences.good_joint_margin_deg);
    merit = std::min(merit, table_clearance_mm(setup.arm, q[i], setup.table_z_mm) / preferences.good_clearance_mm);
    const Hulls hulls = hulls_at(setup.arm, q[i], instrument, setup.table_z_mm);
    const double clearance_mm =
        std::min(least_distance_mm(hulls, base_pairs()), least_distance_mm(hulls, self_pairs()));
    merit = std::min(merit, clearance_mm / preferences.good_arm_clearance_mm);
    merit = std::min(merit, smallest_singular_value(setup.arm, q[i]) / preferences.good_singular_value);
  }
  return merit;
}

double travel_of(const std::vector<Joints>& q, const ArmSetup& setup) {
  double sum = (q.front() - setup.near_rad).cwiseAbs().sum();
  for (std::size_t i = 1; i < q.size(); ++i) sum += (q[i] - q[i - 1]).cwiseAbs().sum();
  return sum;
}

}  // namespace

BranchChoice choose_branch(const RobotProgram& program, const ArmSetup& setup, std::optional<double> spin_deg,
                           const BranchPreferences& preferences) {
  BranchChoice best;
  double best_merit = -kInfinity, best_travel = kInfinity;
  const int spins = spin_deg ? 1 : preferences.spin_steps;
  for (int s = 0; s < spins; ++s) {
    const double spin = spin_deg ? *spin_deg : 360.0 * s / spins;
    auto candidates = follow_all(program, setup, units::rad_from_deg(spin));
    for (int b = 0; b < 8; ++b) {
      Candidate& candidate = candidates[static_cast<std::size_t>(b)];
      if (candidate.failed_pose < program.poses.size()) {
        const bool is_farther = best.outcome == MotionOutcome::Unreachable && candidate.failed_pose >= best.failed_pose;
        if (is_farther && (candidate.failed_pose > best.failed_pose || best.why == InverseOutcome::Solved)) {
          best.failed_pose = candidate.failed_pose;
          best.why = candidate.why;
          best.branch = arm_branch(b);
          best.spin_deg = spin;
        }
        continue;
      }
      take_nearest_turns(candidate.q, setup);
      const double merit = merit_of(candidate.q, setup, preferences, best_merit - kTieOfMerit);
      const double travel = travel_of(candidate.q, setup);
      const bool is_better =
          merit > best_merit + kTieOfMerit || (merit > best_merit - kTieOfMerit && travel < best_travel);
      if (!is_better) continue;
      best_merit = merit;
      best_travel = travel;
      best = {MotionOutcome::Found, 0, InverseOutcome::Solved, arm_branch(b), spin, candidate.q.front()};
    }
  }
  return best;
}

}  // namespace incise::robot_detail
