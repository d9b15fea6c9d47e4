#include "robot/replay_measures.hpp"

#include "robot/own_course.hpp"
#include "robot/tip_curve.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace incise::robot_detail {
namespace {

constexpr double kIntendedSpacingMm = 0.05;  // chords deviate by 2e-5 mm at 15 mm radius

}  // namespace

Points intended_course(const ToolPath& path, const WrittenProgram& program) {
  const TipCurve curve(path);
  const double end = curve.length_mm() + (path.is_closed ? program.overlap_mm : 0.0);
  const auto above = [&](const TipSample& place) {
    return Vec3(place.tip_mm - (place.depth_mm + program.approach_height_mm) * place.axis);
  };
  Points course{above(curve.at(0.0))};
  const auto steps = static_cast<std::size_t>(std::ceil(end / kIntendedSpacingMm));
  for (std::size_t i = 0; i <= steps; ++i)
    course.push_back(curve.at(end * static_cast<double>(i) / static_cast<double>(steps)).tip_mm);
  course.push_back(above(curve.at(end)));
  return course;
}

namespace {

/// Distance to the polyline. Samples follow it, so the search covers a window about the last place, and the whole
/// polyline only if nothing near is found there.
class CourseDistance {
 public:
  explicit CourseDistance(const Points& course) : course_(course) {}
  double operator()(const Vec3& p) {
    constexpr std::size_t kWindow = 60;  // 3 mm of the curve either way
    constexpr double kFarOffMm = 0.02;   // beyond it, another part may be nearer: a ring's overlap covers its beginning
    const std::size_t low = last_ > kWindow ? last_ - kWindow : 0;
    double nearest = search(p, low, std::min(course_.size() - 1, last_ + kWindow));
    if (nearest > kFarOffMm) nearest = search(p, 0, course_.size() - 1);
    return nearest;
  }

 private:
  double search(const Vec3& p, std::size_t low, std::size_t high) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = low; i < high; ++i) {
      const double distance = nearest_on_segment(p, course_[i], course_[i + 1]).distance_mm;
      if (distance >= nearest) continue;
      nearest = distance;
      last_ = i;
    }
    return nearest;
  }
  const Points& course_;
  std::size_t last_ = 0;
};

}  // namespace

void measure_deviation(Replay& replay) {
  if (replay.intended_mm.empty()) return;
  CourseDistance distance(replay.intended_mm);
  double sum = 0.0;
  std::size_t count = 0;
  for (ReplaySample& sample : replay.samples) {
    sample.deviation_mm = distance(sample.tip_mm);
    if (sample.deviation_mm > replay.max_deviation_mm) {
      replay.max_deviation_mm = sample.deviation_mm;
      replay.max_deviation_at_s = sample.time_s;
    }
    if (!is_cut(sample.phase)) continue;
    sum += sample.deviation_mm;
    ++count;
  }
  if (count > 0) replay.mean_deviation_mm = sum / static_cast<double>(count);
  // Only in the cut: on the way down and up, the deviation of a tilted tool grows with the distance.
  for (const ReplaySample& sample : replay.samples) {
    if (is_cut(sample.phase) || count == 0)
      replay.max_cut_deviation_mm = std::max(replay.max_cut_deviation_mm, sample.deviation_mm);
  }
}

void measure_speed(Replay& replay, double end_zone_mm) {
  std::vector<double> arc(replay.samples.size(), 0.0);
  double length = 0.0;
  for (std::size_t i = 1; i < replay.samples.size(); ++i) {
    if (is_cut(replay.samples[i].phase)) length += (replay.samples[i].tip_mm - replay.samples[i - 1].tip_mm).norm();
    arc[i] = length;
  }
  SpeedNumbers& speed = replay.tip_speed_mm_s;
  speed.min = std::numeric_limits<double>::infinity();
  std::size_t count = 0;
  for (std::size_t i = 1; i < replay.samples.size(); ++i) {
    const bool is_away = arc[i - 1] > end_zone_mm && arc[i] < length - end_zone_mm;
    if (!is_cut(replay.samples[i].phase) || !is_away) continue;
    const double value = replay.samples[i].tip_speed_mm_s;
    speed.mean += value;
    speed.min = std::min(speed.min, value);
    speed.max = std::max(speed.max, value);
    ++count;
  }
  if (count > 0)
    speed.mean /= static_cast<double>(count);
  else
    speed = {};
}

namespace {

/// Height of a tip above the tissue's surface, mm: along the axis of the nearest place of the course, from the place's
/// entry point.
double height_above_entry_mm(const ToolPath& path, const Vec3& tip_mm) {
  const TipCurve curve(path);
  const auto steps = static_cast<std::size_t>(std::ceil(curve.length_mm() / kIntendedSpacingMm));
  double nearest_mm = std::numeric_limits<double>::infinity(), height_mm = 0.0;
  for (std::size_t i = 0; i <= steps; ++i) {
    const TipSample place = curve.at(curve.length_mm() * static_cast<double>(i) / static_cast<double>(steps));
    const Vec3 way = tip_mm - (place.tip_mm - place.depth_mm * place.axis);
    const double along_mm = way.dot(place.axis), aside_mm = (way - along_mm * place.axis).norm();
    if (aside_mm >= nearest_mm) continue;
    nearest_mm = aside_mm;
    height_mm = -along_mm;
  }
  return height_mm;
}

bool is_in_air(ProgramPhase phase) {
  return phase == ProgramPhase::Approach || phase == ProgramPhase::Exit || phase == ProgramPhase::Retreat;
}

}  // namespace

void judge_deviation(Replay& replay, double max_deviation_mm) {
  if (replay.outcome != ReplayOutcome::Completed || replay.max_cut_deviation_mm <= max_deviation_mm) return;
  end_replay(replay, ReplayOutcome::OffCourse,
             fmt::format("the tip is up to {:.2f} mm off the intended course in the cut; at most {} mm are allowed",
                         replay.max_cut_deviation_mm, max_deviation_mm));
}

void judge_ends(Replay& replay, const ToolPath* path) {
  if (replay.outcome != ReplayOutcome::Completed) return;
  const auto judge = [&](const ReplaySample& sample, ReplayOutcome outcome, const char* verb) {
    if (replay.outcome != ReplayOutcome::Completed) return;
    if (path != nullptr) {
      const double height_mm = height_above_entry_mm(*path, sample.tip_mm);
      if (!(height_mm > 0.0))
        end_replay(replay, outcome,
                   fmt::format("the program {} with the tip {:.2f} mm below the surface", verb, -height_mm));
    } else if (!is_in_air(sample.phase)) {
      end_replay(replay, outcome, fmt::format("the program {} in its phase '{}'", verb, to_string(sample.phase)));
    }
  };
  judge(replay.samples.front(), ReplayOutcome::StartsInTissue, "begins");
  judge(replay.samples.back(), ReplayOutcome::EndsInTissue, "ends");
}

}  // namespace incise::robot_detail
