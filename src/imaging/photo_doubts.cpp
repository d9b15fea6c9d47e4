#include <incise/core/units.hpp>
#include <incise/imaging/photo_doubts.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

namespace incise {
namespace {

constexpr double kStandardErrors = 4.0;  // one sound figure in 16 000 is farther out

/// One figure of a ruler, as a share of the scale, with its text.
struct Finding {
  RulerFigure share;
  std::string text;
};

/// Converts an angle between ticks, or from the normal of their row, to a change of scale: an angle of a radians
/// implies a change of 2 a along a ruler that lies across this one.
RulerFigure share_of_angle(const RulerFigure& degrees) {
  return {2.0 * units::rad_from_deg(degrees.value), 2.0 * units::rad_from_deg(degrees.error)};
}

/// Adds the worst finding that exceeds its limit and is not chance.
template <std::size_t N>
void add_worst(const std::array<Finding, N>& findings, const char* id, const char* meaning, Verdict& verdict) {
  const double limit = *verdict_rule(id).limit;
  const Finding* worst = nullptr;
  for (const Finding& finding : findings) {
    const double share = std::abs(finding.share.value);
    if (share <= limit || share <= kStandardErrors * finding.share.error) continue;
    if (worst == nullptr || share > std::abs(worst->share.value)) worst = &finding;
  }
  if (worst == nullptr) return;
  verdict.add(id, std::abs(worst->share.value), fmt::format("{}: {}", meaning, worst->text));
}

}  // namespace

void add_ruler_doubts(const Ruler& ruler, Verdict& verdict) {
  if (ruler.error_percent > *verdict_rule("photo_scale").limit) {
    verdict.add("photo_scale", ruler.error_percent,
                fmt::format("the scale is known only to {:.1f} %", ruler.error_percent));
  }
  if (!ruler.shape) return;
  const RulerShape& shape = *ruler.shape;
  add_worst<3>({{{shape.spacing_change,
                  fmt::format("the spacing of the ruler's ticks changes by {:.1f} % from one end to the other",
                              100.0 * std::abs(shape.spacing_change.value))},
                 {share_of_angle(shape.convergence_deg),
                  fmt::format("the ruler's first and last tick are {:.1f} degrees from parallel",
                              std::abs(shape.convergence_deg.value))},
                 {share_of_angle(shape.skew_deg),
                  fmt::format("the ruler's ticks lie {:.1f} degrees from the normal of their row",
                              std::abs(shape.skew_deg.value))}}},
               "photo_oblique", "the camera does not look straight down, or its lens was not corrected", verdict);
  add_worst<2>(
      {{{shape.end_stretch, fmt::format("the ruler's spacing at its ends differs by {:.1f} % from that of its middle",
                                        100.0 * std::abs(shape.end_stretch.value))},
        {shape.bow, fmt::format("the ruler is bent by {:.2f} % of its length", 100.0 * std::abs(shape.bow.value))}}},
      "photo_lens", "the picture still contains the lens's distortion", verdict);
}

void add_ring_doubts(const PhotoContours& contours, double max_gap_mm, Verdict& verdict) {
  if (!contours.red.is_closed) return;
  if (const double gap_mm = contours.red.max_gap_mm(); gap_mm > max_gap_mm) {
    verdict.add("photo_ring", gap_mm,
                fmt::format("the red ring is treated as closed although it is not seen for {:.2f} mm, more than {:g}: "
                            "such a gap cannot be distinguished from one of {:g}",
                            gap_mm, max_gap_mm, max_gap_mm));
  }
  if (!contours.odd_stretch) return;
  const OddStretch& odd = *contours.odd_stretch;
  verdict.add(
      "photo_ring", odd.length_mm,
      fmt::format(
          "the red ring is closed by a stretch of {:.2f} mm at pixel {:.0f}, {:.0f} that is unlike its other parts "
          "({}): blood over an opening?",
          odd.length_mm, odd.at_px.x(), odd.at_px.y(), odd.what),
      VerdictPlace{{}, {}, fmt::format("pixel {:.0f}, {:.0f}", odd.at_px.x(), odd.at_px.y())});
}

}  // namespace incise
