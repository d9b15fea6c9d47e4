#include "robot/check_list.hpp"
#include "robot/hull.hpp"
#include "robot/surface_probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace incise::robot_detail {
namespace {

constexpr double kCloselyMm = 0.05;  // accuracy of a distance that may be the least
constexpr double kRoughShare = 0.1;  // accuracy of the others, as a share of the distance

/// The hulls at every sample of the program's motion.
std::vector<Hulls> hulls_of(const RobotProgram& program, const CheckSettings& settings) {
  const Instrument instrument = instrument_of(program.setup.T_flange_tool, settings);
  std::vector<Hulls> all;
  all.reserve(program.motion.samples.size());
  for (const JointSample& sample : program.motion.samples)
    all.push_back(hulls_at(program.setup.arm, sample.q_rad, instrument, program.setup.table_z_mm));
  return all;
}

/// Greatest distance that a hull can move in half a step to either neighbouring sample, mm.
double half_step_mm(const std::vector<Hulls>& hulls, std::size_t i, Hull hull) {
  double farthest = 0.0;
  if (i > 0) farthest = motion_mm(of(hulls[i - 1], hull), of(hulls[i], hull));
  if (i + 1 < hulls.size()) farthest = std::max(farthest, motion_mm(of(hulls[i], hull), of(hulls[i + 1], hull)));
  return 0.5 * farthest;
}

/// Checks the least distance of some pairs over the whole motion.
void check_pairs(CheckList& list, const char* name, std::span<const HullPair> pairs, const std::vector<Hulls>& hulls,
                 double limit_mm, const char* whose) {
  Worst nearest;
  HullPair worst = pairs.front();
  for (std::size_t i = 0; i < hulls.size(); ++i) {
    for (const HullPair& pair : pairs) {
      const double step_mm = half_step_mm(hulls, i, pair.a) + half_step_mm(hulls, i, pair.b);
      const double least_mm = distance_mm(of(hulls[i], pair.a), of(hulls[i], pair.b)) - step_mm;
      if (-least_mm > nearest.value) worst = pair;
      nearest.see(-least_mm, list.program().motion.samples[i].pose);
    }
  }
  list.at_least(name, -nearest.value, limit_mm, "mm", nearest.pose,
                fmt::format("least distance of {}: {} and {}", whose, to_string(worst.a), to_string(worst.b)));
}

/// The hull nearest to the surface so far.
struct NearestHull {
  Worst worst;  ///< of the negative distance
  Hull hull = Hull::Base;
};

/// Finds the least distance of hulls from the surface, sample by sample. Skips hulls that cannot be nearer than the
/// nearest one so far.
class SurfaceWatch {
 public:
  explicit SurfaceWatch(const SurfaceProbe& probe) : distance_([&probe](const Vec3& p) { return probe.distance_mm(p); }) { forget(); }

  /// Considers one hull at one sample. @param step_mm  distance that it can move in half a step (half_step_mm)
  void see(Hull hull, const Capsule& capsule, double step_mm, std::size_t pose) {
    double& least_mm = least_mm_[static_cast<std::size_t>(hull)];
    least_mm -= 2.0 * step_mm;
    const double best_mm = -nearest_.worst.value;
    if (least_mm - step_mm >= best_mm) return;
    const auto range_to = [&](double tolerance_mm, double share) {
      return segment_distance(distance_, capsule.from_mm, capsule.to_mm, tolerance_mm, share);
    };
    DistanceRange range = range_to(kCloselyMm, kRoughShare);
    least_mm = range.least_mm - capsule.radius_mm;
    if (least_mm - step_mm < best_mm) {
      range = range_to(kCloselyMm, 0.0);
      least_mm = range.least_mm - capsule.radius_mm;
    }
    const double found_mm = range.nearest_mm - capsule.radius_mm - step_mm;
    if (found_mm >= best_mm) return;
    nearest_.worst.see(-found_mm, pose);
    nearest_.hull = hull;
  }
  /// Forgets the bounds of earlier samples; call this when a hull is replaced by another.
  void forget() { least_mm_.fill(-std::numeric_limits<double>::infinity()); }
  [[nodiscard]] const NearestHull& nearest() const { return nearest_; }

 private:
  PointDistance distance_;
  NearestHull nearest_;
  std::array<double, kHullCount> least_mm_{};  ///< lower bound of each hull's distance now
};

/// The part of the needle that must stay clear of the tissue: in the air all of it, in the tissue the part higher than
/// the clearance above the entry.
Capsule needle_in_air(const RobotProgram& program, std::size_t pose, const Capsule& needle) {
  const std::size_t next = std::min(pose + 1, program.poses.size() - 1);
  const double depth_mm = std::max(program.poses[pose].depth_mm, program.poses[next].depth_mm);
  const double in_tissue_mm = std::max(0.0, depth_mm + program.settings.clearance_mm);
  const double length_mm = (needle.to_mm - needle.from_mm).norm();
  Capsule part = needle;
  part.from_mm += std::min(1.0, length_mm > 0.0 ? in_tissue_mm / length_mm : 1.0) * (needle.to_mm - needle.from_mm);
  return part;
}

void check_surface(CheckList& list, const TriMesh& surface, const std::vector<Hulls>& hulls,
                   const CheckSettings& settings) {
  constexpr Hull kLinks[]{Hull::UpperArm, Hull::Elbow, Hull::Forearm, Hull::Wrist1, Hull::Wrist2, Hull::Wrist3};
  const RobotProgram& program = list.program();
  const SurfaceProbe probe(surface);
  SurfaceWatch links(probe), shaft(probe), needle(probe);
  const bool has_shaft = !instrument_of(program.setup.T_flange_tool, settings).is_needle_alone();
  for (std::size_t i = 0; i < hulls.size(); ++i) {
    const std::size_t pose = program.motion.samples[i].pose;
    for (const Hull hull : kLinks) links.see(hull, of(hulls[i], hull), half_step_mm(hulls, i, hull), pose);
    if (has_shaft) shaft.see(Hull::Shaft, of(hulls[i], Hull::Shaft), half_step_mm(hulls, i, Hull::Shaft), pose);
    if (i > 0 && pose != program.motion.samples[i - 1].pose) needle.forget();  // another part of the needle
    needle.see(Hull::Needle, needle_in_air(program, pose, of(hulls[i], Hull::Needle)),
               half_step_mm(hulls, i, Hull::Needle), pose);
  }
  const auto add = [&list](const char* name, const SurfaceWatch& watch, double limit_mm, std::string text) {
    list.at_least(name, -watch.nearest().worst.value, limit_mm, "mm", watch.nearest().worst.pose, std::move(text));
  };
  add("surface_collision", links, settings.surface_clearance_mm,
      fmt::format("least distance of the arm's hulls from the surface: {}", to_string(links.nearest().hull)));
  if (has_shaft)
    add("shaft", shaft, settings.shaft_clearance_mm,
        fmt::format("least distance of the instrument's shaft ({} mm thick, from {} mm behind the tip) from the "
                    "surface, straight from there to the flange",
                    2.0 * settings.shaft_radius_mm, settings.needle_length_mm));
  else
    list.not_made("shaft: the tool has none behind its needle");
  add("needle", needle, settings.needle_clearance_mm,
      fmt::format("least distance of the needle from the surface; in the tissue, only of the part more than {} mm "
                  "above the entry",
                  program.settings.clearance_mm));
}

}  // namespace

void check_collisions(CheckList& list, const TriMesh* surface, const CheckSettings& settings) {
  if (list.program().motion.outcome != MotionOutcome::Found)
    return list.not_made("self_collision, base, surface_collision, shaft, needle: no motion of the arm was found");
  const std::vector<Hulls> hulls = hulls_of(list.program(), settings);
  check_pairs(list, "self_collision", self_pairs(), hulls, settings.arm_clearance_mm,
              "the hulls of the arm's links and of the instrument from each other");
  check_pairs(list, "base", base_pairs(), hulls, settings.arm_clearance_mm,
              "the arm's hulls and the instrument from base and shoulder");
  if (surface != nullptr)
    check_surface(list, *surface, hulls, settings);
  else
    list.not_made("surface_collision, shaft, needle against the tissue: no surface was given");
}

}  // namespace incise::robot_detail
