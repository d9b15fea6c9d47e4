#pragma once

#include <incise/report/report_data.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// One HTML page with everything in it: pictures, figures, tables, the 3D views and the three.js library (MIT,
/// its notice kept) that draws them. It opens from a disk without a network, and its content security policy forbids it
/// to load anything. Without WebGL or scripts still pictures take the place of the 3D views. The cut's frames may take
/// 9 MB of text; when there are more, evenly spaced ones are kept, and the page says how many. Same data, same page.
/// @throws InvalidArgument listing what find_problems(data) finds.
[[nodiscard]] std::string html_report(const ReportData& data);

/// Writes html_report(data), all or nothing. @throws as html_report; DataError if the file cannot be written.
void write_report(const ReportData& data, const std::filesystem::path& path);

/// A still picture (PNG, RGB) of a frame, obliquely from above, with the animation's lines: what the page shows without
/// WebGL.
/// @pre frame < animation.frames.size(); width and height >= 16. @throws InvalidArgument if not so.
[[nodiscard]] std::string frame_png(const ReportAnimation& animation, std::size_t frame, const Vec3& approach,
                                    int width_px, int height_px);

/// The same as a figure: an SVG document that holds the picture, with a title that says "simulated", a legend of what it shows and a scale
/// bar of 10 mm. @pre, @throws as frame_png.
[[nodiscard]] std::string frame_figure_svg(const ReportAnimation& animation, std::size_t frame, const Vec3& approach,
                                           int width_px, int height_px);

}  // namespace incise
