#pragma once

#include <incise/report/report_data.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Returns one HTML page that contains everything: pictures, figures, tables, the 3D views and the three.js library
/// (MIT, with its notice) that draws them. The page opens from a disk without a network, and its content security
/// policy forbids it to load anything. Without WebGL or scripts, still pictures replace the 3D views. The frames of all
/// cuts together may take 9 MB of text; beyond that, only evenly spaced frames are kept, and the page says how many.
/// The same data give the same page.
/// @throws InvalidArgument listing what find_problems(data) finds.
[[nodiscard]] std::string html_report(const ReportData& data);

/// Writes html_report(data), all or nothing. @throws as html_report; DataError if the file cannot be written.
void write_report(const ReportData& data, const std::filesystem::path& path);

/// Returns a still picture of a frame (PNG, RGB), seen obliquely from above, with the animation's lines. The page shows
/// it where WebGL is missing.
/// @param approach  direction into the tissue.
/// @pre frame < animation.frames.size(); width and height >= 16; the frame has a skin, or the animation has lines.
/// @throws InvalidArgument otherwise.
[[nodiscard]] std::string frame_png(const ReportAnimation& animation, std::size_t frame, const Vec3& approach,
                                    int width_px, int height_px);

/// Returns frame_png as a figure: an SVG document that holds the picture, with a title that says "simulated", a legend
/// and a scale bar of 10 mm. @pre, @throws as frame_png.
[[nodiscard]] std::string frame_figure_svg(const ReportAnimation& animation, std::size_t frame, const Vec3& approach,
                                           int width_px, int height_px);

}  // namespace incise
