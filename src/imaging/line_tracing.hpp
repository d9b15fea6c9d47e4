#pragma once

#include "imaging/ink.hpp"

#include <optional>
#include <vector>

namespace incise::imaging_detail {

using Line = std::vector<Vec2>;  ///< points in pixels

/// Returns the unit tangent at point i, from the points `reach` before and after it.
[[nodiscard]] Vec2 tangent_at(const Line& line, bool is_closed, std::size_t i, std::size_t reach);
/// Returns the normal to the right of a tangent on the screen: outwards on a ring that runs counter-clockwise there.
[[nodiscard]] inline Vec2 outward(const Vec2& tangent) {
  return {-tangent.y(), tangent.x()};
}
[[nodiscard]] double length_px(const Line& line, bool is_closed);
/// Returns the line as points about `step_px` apart. @pre at least 2 points, positive length.
[[nodiscard]] Line resampled(const Line& line, bool is_closed, double step_px);
/// Smooths with `passes` of [1 2 1] / 4; the ends of an open line stay.
void smooth(Line& line, bool is_closed, int passes);

/// Returns the pixels of ink: 255 where the likelihood exceeds one half, without specks.
[[nodiscard]] cv::Mat ink_mask(const InkMap& map);
/// Returns the mask without connected pieces of fewer than `least_pixels` pixels.
[[nodiscard]] cv::Mat without_specks(const cv::Mat& above, int least_pixels);
/// Returns the value of each pixel's piece, 8 bits. @param pieces  number of each pixel's piece, 32 bits.
/// @param values  by the number of the piece.
[[nodiscard]] cv::Mat by_piece(const cv::Mat& pieces, const std::vector<std::uint8_t>& values);

/// The part of the picture that a mask fills, and its position.
struct MaskWindow {
  cv::Mat mask;  ///< with a rim of zeros
  Vec2 corner_px = Vec2::Zero();
};
/// Returns nullopt for an empty mask.
[[nodiscard]] std::optional<MaskWindow> window_of(const cv::Mat& mask, int rim_px);

/// The places that ink encloses, found by rolling a disc over everything free of ink.
struct RollingResult {
  Line inner_border;              ///< of the largest enclosed place, counter-clockwise on the screen; empty: none
  double radius_px = 0.0;         ///< of a disc of about the size of that place
  std::size_t rings = 0;          ///< enclosed places of similar size
  bool rings_touch = false;       ///< the two largest border on the same piece of ink
  double second_radius_px = 0.0;  ///< as radius_px, of the second largest place
};
[[nodiscard]] RollingResult roll_inside(const MaskWindow& window, double disc_radius_px);

/// Returns the longest way through the largest piece of ink, from end to end; crosses gaps up to twice `bridge_px`.
[[nodiscard]] Line longest_way(const MaskWindow& window, double bridge_px);

struct RefineSettings {
  LineEdge edge = LineEdge::Middle;
  double width_px = 0.0;  ///< estimated width of the line or band
  double reach_px = 0.0;  ///< greatest distance of the line from its present points
  bool reject_outliers = false;
};
/// Result of one pass of refinement, which moves every point along its normal to the line or edge found in the colour.
struct RefinedLine {
  Line points;
  std::vector<bool> is_seen;  ///< for each point: whether the line was found there
  double width_px = 0.0;  ///< median over the points seen; for an inner edge, as given
};
[[nodiscard]] RefinedLine refine(const Line& line, bool is_closed, const cv::Mat& likelihood, const cv::Mat& glare,
                                 const RefineSettings& settings);

/// As find_marked_line, from computed ink maps. @param hidden  8 bits, not 0 where another line covers this one; may be
/// empty.
[[nodiscard]] MarkedLine trace_marked_line(const InkMap& map, const cv::Mat& mask, const cv::Mat& glare,
                                           const cv::Mat& hidden, InkColor color, const LineSettings& settings,
                                           const std::filesystem::path& name);

}  // namespace incise::imaging_detail
