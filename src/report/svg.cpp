#include "report/svg.hpp"

#include <incise/core/error.hpp>
#include <incise/io/text_encoding.hpp>

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace incise {
namespace {

void append_coordinate(std::string& text, double value) {
  INCISE_REQUIRE(std::isfinite(value), "expected finite coordinates for a figure");
  fmt::format_to(std::back_inserter(text), "{:.2f}", value);
}

std::string coordinate(double value) {
  std::string text;
  append_coordinate(text, value);
  return text;
}

}  // namespace

std::string png_data_uri(std::string_view png) {
  return "data:image/png;base64," + base64(png);
}

std::string number_text(double value) {
  INCISE_REQUIRE(std::isfinite(value), "expected a finite number");
  const double magnitude = std::abs(value);
  std::string digits;
  if (magnitude < 1e12 && (magnitude == std::floor(magnitude) || magnitude >= 1e4)) {
    digits = fmt::format("{:.0f}", magnitude);
  } else {
    digits = fmt::format("{:.4g}", magnitude);
  }
  return value < 0.0 && digits != "0" ? "−" + digits : digits;
}

std::string fixed_text(double value, int decimals) {
  INCISE_REQUIRE(std::isfinite(value), "expected a finite number");
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool is_zero = digits.find_first_not_of("0.") == std::string::npos;
  return value < 0.0 && !is_zero ? "−" + digits : digits;
}

std::string measure_text(double value, std::string_view unit) {
  const double size = std::abs(value);
  if (size < 1e12 && value == std::round(value)) return fixed_text(value, 0);
  const int decimals = size >= 1000.0 ? 0 : size >= 100.0 ? 1 : unit.empty() && size < 1.0 ? 3 : 2;
  const std::string text = fixed_text(value, decimals);
  return text.find_first_not_of("0.") == std::string::npos ? "0" : text;
}

std::string hex_color(const Vec3& rgb) {
  const auto byte = [](double part) {
    return static_cast<int>(std::lround(255.0 * std::min(1.0, std::max(0.0, part))));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(rgb.x()), byte(rgb.y()), byte(rgb.z()));
}

SvgWriter::SvgWriter(double width, double height, std::string_view title, std::string_view description,
                     bool has_ground) {
  text_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
      "aria-label=\"{2}\" font-family=\"system-ui, Helvetica, Arial, sans-serif\" font-size=\"12\" fill=\"#222\">\n"
      "<title>{2}</title>\n<desc>{3}</desc>\n",
      coordinate(width), coordinate(height), escaped(title), escaped(description));
  if (has_ground) rectangle({0.0, 0.0}, {width, height}, "fill=\"#fff\"");
}

void SvgWriter::line(const Vec2& a, const Vec2& b, std::string_view style) {
  text_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", coordinate(a.x()), coordinate(a.y()),
                       coordinate(b.x()), coordinate(b.y()), style);
}

void SvgWriter::polyline(std::span<const Vec2> points, bool is_closed, std::string_view style) {
  text_ += is_closed ? "<polygon points=\"" : "<polyline points=\"";
  for (const Vec2& p : points) {
    append_coordinate(text_, p.x());
    text_ += ',';
    append_coordinate(text_, p.y());
    text_ += ' ';
  }
  text_ += fmt::format("\" {}/>\n", style);
}

void SvgWriter::rectangle(const Vec2& corner, const Vec2& size, std::string_view style) {
  text_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n", coordinate(corner.x()),
                       coordinate(corner.y()), coordinate(size.x()), coordinate(size.y()), style);
}

void SvgWriter::circle(const Vec2& center, double radius, std::string_view style) {
  text_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", coordinate(center.x()), coordinate(center.y()),
                       coordinate(radius), style);
}

void SvgWriter::text(const Vec2& at, std::string_view content, std::string_view anchor, std::string_view extra) {
  text_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" {}>{}</text>\n", coordinate(at.x()),
                       coordinate(at.y()), anchor, extra, escaped(content));
}

void SvgWriter::image(const Vec2& corner, const Vec2& size, std::string_view data_uri) {
  text_ +=
      fmt::format("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" href=\"{}\"/>\n",
                  coordinate(corner.x()), coordinate(corner.y()), coordinate(size.x()), coordinate(size.y()), data_uri);
}

void SvgWriter::path(std::string_view data, std::string_view style) {
  text_ += fmt::format("<path d=\"{}\" {}/>\n", data, style);
}

void SvgWriter::open_group(std::string_view attributes) {
  text_ += fmt::format("<g {}>\n", attributes);
}
void SvgWriter::close_group() {
  text_ += "</g>\n";
}

std::string SvgWriter::finish() {
  text_ += "</svg>\n";
  return std::move(text_);
}

}  // namespace incise
