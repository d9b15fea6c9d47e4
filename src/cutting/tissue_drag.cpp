#include "kerf.hpp"
#include "point_lattice.hpp"

#include <algorithm>
#include <map>

namespace incise {
namespace {

constexpr int kHalvings = 60;  // of the interval in which a phase's end is searched: to rounding

/// The tool's course for lag and drift: travel of the tip along the path, and its direction.
class Course {
 public:
  Course(const ToolPath& path, const IncisionSettings& settings)
      : program_(path, settings.cut, settings.tool),
        least_span_s_(0.5 * settings.cut.step_s()),
        begin_s_(last_moment([](ToolProgram::Phase phase) { return phase == ToolProgram::Phase::Plunge; })),
        end_s_(last_moment([](ToolProgram::Phase phase) { return phase != ToolProgram::Phase::Dwell; })) {
    // Outwards on a ring, whichever way round it runs; to the left of an open cut.
    const bool is_outside_right = path.is_closed && signed_area_mm2(entry_contour(path), settings.approach) > 0.0;
    to_the_right_ = is_outside_right ? 1.0 : -1.0;
  }

  [[nodiscard]] double arclength_mm(double time_s) const {
    return program_.way_mm_at(on_path(time_s)) - program_.way_mm_at(begin_s_);
  }

  /// Unit direction of the tip's motion at a time. During the plunge: the direction in which it then sets out; during
  /// the dwell: the direction in which it arrived. nullopt if the tip does not move.
  [[nodiscard]] std::optional<Vec3> direction(double time_s) const {
    for (double span = least_span_s_; span < 2.0 * (end_s_ - begin_s_); span *= 2.0) {
      const Vec3 moved =
          program_.pose_at(on_path(time_s + span)).tip_mm - program_.pose_at(on_path(time_s - span)).tip_mm;
      if (moved.norm() > 1e-9) return moved.normalized();
    }
    return std::nullopt;
  }
  /// Unit vector perpendicular to the course, in the plane across the approach, in the direction of positive drift.
  [[nodiscard]] Vec3 across(const Vec3& direction, const Vec3& approach) const {
    return to_the_right_ * approach.cross(direction).stableNormalized();
  }

 private:
  [[nodiscard]] double on_path(double time_s) const { return std::clamp(time_s, begin_s_, end_s_); }

  template <class Holds>
  [[nodiscard]] double last_moment(Holds holds) const {
    double low = 0.0;
    double high = program_.duration_s();
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (holds(program_.phase_at(middle)) ? low : high) = middle;
    }
    return low;
  }

  ToolProgram program_;
  double least_span_s_;
  double begin_s_;  // when the tip leaves the first waypoint
  double end_s_;    // when it stops
  double to_the_right_ = 1.0;
};

/// Sums over the tissue that was cut in one step.
struct StepSum {
  double time_s = 0.0;
  double volume_mm3 = 0.0;
  Vec3 moment = Vec3::Zero();  // displacement · volume
};

/// Sums over the tissue that was cut in each step, by the step's number.
std::map<int, StepSum> sums_of(const TissueModel& model, const PointLattice* lattice, std::span<const Vec3> stretched,
                               const IncisionSettings& settings, const CutState& state) {
  std::map<int, StepSum> sums;
  if (lattice != nullptr) {
    for (std::size_t i = 0; i < lattice->size(); ++i) {
      const int number = state.points.parted_step[i];
      if (number < 0) continue;
      StepSum& step = sums[number];
      step.time_s = number * settings.cut.step_s();
      step.volume_mm3 += lattice->volume_mm3(i);
      step.moment += lattice->volume_mm3(i) * (state.points.parted_mm[i] - lattice->position(i, stretched));
    }
    return sums;
  }
  for (const Removal& removal : state.record.removals) {
    if (removal.cause == RemovalCause::LooseFragment) continue;  // it moved with its surroundings, not with the tool
    Vec3 place = Vec3::Zero();
    for (const VertexId v : model.mesh.tets[removal.tet.index()]) place += 0.25 * stretched[v.index()];
    StepSum& step = sums[removal.step];
    step.time_s = removal.time_s;
    step.volume_mm3 += removal.rest_volume_mm3;
    step.moment += removal.rest_volume_mm3 * (removal.centroid_mm - place);
  }
  return sums;
}

}  // namespace

std::optional<TissueDrag> tissue_drag(const TissueModel& model, const PointLattice* lattice,
                                      std::span<const Vec3> stretched, const ToolPath& path,
                                      const IncisionSettings& settings, const CutState& state) {
  const Course course(path, settings);
  TissueDrag drag;
  std::vector<double> volumes;
  for (const auto& [number, step] : sums_of(model, lattice, stretched, settings, state)) {
    const std::optional<Vec3> direction = course.direction(step.time_s);
    if (!direction || step.volume_mm3 == 0.0) continue;
    const Vec3 displacement = step.moment / step.volume_mm3;
    drag.time_s.push_back(step.time_s);
    drag.arclength_mm.push_back(course.arclength_mm(step.time_s));
    drag.lag_mm.push_back(displacement.dot(*direction));
    drag.drift_mm.push_back(displacement.dot(course.across(*direction, settings.approach)));
    volumes.push_back(step.volume_mm3);
  }
  if (volumes.empty()) return std::nullopt;
  drag.lag = spread_of(drag.lag_mm, volumes);
  drag.drift = spread_of(drag.drift_mm, volumes);
  return drag;
}

}  // namespace incise
