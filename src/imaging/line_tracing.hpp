#pragma once

#include "imaging/ink.hpp"

#include <optional>
#include <vector>

namespace incise::imaging_detail {

using Line = std::vector<Vec2>;  ///< points in pixels

/// Unit tangent at a point, from the points `reach` before and behind it.
[[nodiscard]] Vec2 tangent_at(const Line& line, bool is_closed, std::size_t i, std::size_t reach);
/// To the right of a tangent as seen on a screen: outwards on a ring that runs counter-clockwise there.
[[nodiscard]] inline Vec2 outward(const Vec2& tangent) {
  return {-tangent.y(), tangent.x()};
}
[[nodiscard]] double length_px(const Line& line, bool is_closed);
/// Points about `step_px` apart. @pre at least 2 points, positive length.
[[nodiscard]] Line resampled(const Line& line, bool is_closed, double step_px);
/// `passes` of [1 2 1] / 4; ends of an open line stay.
void smooth(Line& line, bool is_closed, int passes);

/// Pixels of ink: 255 where the likelihood passes one half, specks left out.
[[nodiscard]] cv::Mat ink_mask(const InkMap& map);
/// The mask without connected pieces of fewer pixels.
[[nodiscard]] cv::Mat without_specks(const cv::Mat& above, int least_pixels);

/// Part of the picture that a mask fills, and where it lies.
struct MaskWindow {
  cv::Mat mask;  ///< with a rim of zeros
  Vec2 corner_px = Vec2::Zero();
  double ink_pixels = 0.0;
};
/// nullopt for an empty mask.
[[nodiscard]] std::optional<MaskWindow> window_of(const cv::Mat& mask, int rim_px);

/// What a disc that rolls inside the ink finds.
struct RollingResult {
  Line inner_border;         ///< of the largest enclosed place, counter-clockwise on the screen; empty: none
  double radius_px = 0.0;    ///< of a disc as large as that place
  std::size_t rings = 0;     ///< enclosed places of similar size
  bool rings_touch = false;  ///< they share a border
  double second_radius_px = 0.0;
};
[[nodiscard]] RollingResult roll_inside(const MaskWindow& window, double disc_radius_px);

/// The longest way through the largest piece of ink, from end to end; gaps up to twice the bridge are crossed.
[[nodiscard]] Line longest_way(const MaskWindow& window, double bridge_px);

struct RefineSettings {
  LineEdge edge = LineEdge::Middle;
  double width_px = 0.0;  ///< estimate, of the line or band
  double reach_px = 0.0;  ///< how far from the start the line may lie
  bool reject_outliers = false;
};
/// One pass: every point moves along its normal to where the colour says. `is_seen` tells where it said something.
struct RefinedLine {
  Line points;
  std::vector<bool> is_seen;
  double width_px = 0.0;  ///< median over the points seen; for an inner edge as given
};
[[nodiscard]] RefinedLine refine(const Line& line, bool is_closed, const cv::Mat& likelihood, const cv::Mat& glare,
                                 const RefineSettings& settings);

/// find_marked_line with the colours worked out. @param hidden  8 bits, where another line lies on top; may be empty.
[[nodiscard]] MarkedLine trace_marked_line(const InkMap& map, const cv::Mat& mask, const cv::Mat& glare,
                                           const cv::Mat& hidden, InkColor color, const LineSettings& settings,
                                           const std::filesystem::path& name);

}  // namespace incise::imaging_detail
