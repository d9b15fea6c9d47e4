#include <incise/core/error.hpp>
#include <incise/evaluation/evaluation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

/// Position of a point of the incision relative to the intended line.
struct Abreast {
  double along_mm = 0.0;    ///< arc length of its foot point; below 0 or above the length if it lies beyond an end
  double lateral_mm = 0.0;  ///< signed, positive = left
};

/// Unit direction of a segment. @pre its ends differ.
Vec3 direction_of(const Contour& line, std::size_t segment) {
  return (line.points[segment + 1] - line.points[segment]).normalized();
}

Abreast place(const Vec3& p, const Contour& line, const std::vector<double>& arc, const Vec3& up) {
  const ContourPoint foot = nearest_on(line, p);
  const std::size_t last = line.points.size() - 2;
  const Vec3 tangent = direction_of(line, foot.segment);
  const Vec3 offset = p - foot.position_mm;
  double along = arc[foot.segment] + foot.fraction * (arc[foot.segment + 1] - arc[foot.segment]);
  Vec3 course = tangent;
  if (foot.fraction == 1.0 && foot.segment < last) {
    course += direction_of(line, foot.segment + 1);  // at a corner, one segment alone may give the wrong side
  } else if (foot.fraction == 0.0 && foot.segment > 0) {
    course += direction_of(line, foot.segment - 1);
  } else if (foot.fraction == 0.0 || foot.fraction == 1.0) {
    along += offset.dot(tangent);  // beyond an end of the line
  }
  const bool is_left = up.dot(course.cross(offset)) >= 0.0;
  return {along, is_left ? foot.distance_mm : -foot.distance_mm};
}

Contour without_repeats(const Contour& line) {
  Contour result{.points = {}, .is_closed = false};
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    INCISE_REQUIRE(line.points[i].allFinite(), fmt::format("point {} of the line is not finite", i));
    if (result.points.empty() || line.points[i] != result.points.back()) result.points.push_back(line.points[i]);
  }
  return result;
}

}  // namespace

Evaluation evaluate_line(const std::optional<Contour>& incision, const Contour& line,
                         const EvaluationSettings& settings) {
  require_none(validate(settings));
  const Contour intended = without_repeats(line);
  INCISE_REQUIRE(!line.is_closed && intended.points.size() >= 2,
                 "expected an open line of at least 2 different points");
  Evaluation result;
  result.contour = settings.contour;
  if (!incision) return result;
  INCISE_REQUIRE(!incision->is_closed, "expected an open incision, found a closed one");

  const std::vector<double> arc = arclengths_mm(intended.points);
  const double length = arc.back();
  const Vec3 up = -settings.approach.normalized();
  const Contour points = resample_by_step(*incision, settings.step_mm);
  result.hausdorff = hausdorff_distance(*incision, intended, settings.approach, settings.step_mm);
  result.errors.points.is_closed = false;
  double first = length;
  double last = 0.0;
  for (const Vec3& p : points.points) {
    const Abreast abreast = place(p, intended, arc, up);
    first = std::min(first, std::clamp(abreast.along_mm, 0.0, length));
    last = std::max(last, std::clamp(abreast.along_mm, 0.0, length));
    if (abreast.along_mm < 0.0 || abreast.along_mm > length) continue;
    result.errors.points.points.push_back(p);
    result.errors.signed_distance_mm.push_back(abreast.lateral_mm);
    result.errors.signed_error_mm.push_back(abreast.lateral_mm);
  }
  result.start_gap_mm = std::min(first, length);
  result.end_gap_mm = length - last;
  result.coverage = std::max(0.0, last - first) / length;
  result.n_points = result.errors.signed_error_mm.size();
  if (result.n_points > 0) {
    std::vector<double> magnitudes;
    for (const double error : result.errors.signed_error_mm) magnitudes.push_back(std::abs(error));
    result.signed_error_mm = summarize(result.errors.signed_error_mm);
    result.abs_error_mm = summarize(magnitudes);
  }
  const bool is_complete = result.n_points > 0 && *result.start_gap_mm <= settings.end_tolerance_mm &&
                           *result.end_gap_mm <= settings.end_tolerance_mm;
  result.outcome = is_complete ? Outcome::Success : Outcome::OpenLoop;
  return result;
}

}  // namespace incise
