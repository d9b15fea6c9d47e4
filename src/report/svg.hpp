#pragma once

#include <incise/geometry/types.hpp>
#include <incise/report/number_text.hpp>

#include <span>
#include <string>
#include <string_view>

namespace incise {

/// A number as a person writes it: four significant digits, whole numbers in full, a true minus sign.
[[nodiscard]] std::string number_text(double value);

/// A number with the given count of decimals and a true minus sign; never "−0".
[[nodiscard]] std::string fixed_text(double value, int decimals);

/// A PNG file as a data URI, for use within a page or an SVG.
[[nodiscard]] std::string png_data_uri(std::string_view png);

/// #rrggbb of components in [0, 1].
[[nodiscard]] std::string hex_color(const Vec3& rgb);

/// Writes one SVG document, y downwards. Every coordinate has to be finite (InvalidArgument). `style` is SVG attributes
/// as text, such as `stroke="#111" fill="none"`.
class SvgWriter {
 public:
  /// @param title, description  for screen readers; escaped here.  @param has_ground  whether it has a white
  /// background; if not, it is transparent.
  SvgWriter(double width, double height, std::string_view title, std::string_view description, bool has_ground = true);

  void line(const Vec2& a, const Vec2& b, std::string_view style);
  void polyline(std::span<const Vec2> points, bool is_closed, std::string_view style);
  void rectangle(const Vec2& corner, const Vec2& size, std::string_view style);
  void circle(const Vec2& center, double radius, std::string_view style);
  /// `anchor`: start, middle or end. `extra`: further attributes.
  void text(const Vec2& at, std::string_view content, std::string_view anchor = "start", std::string_view extra = "");
  void image(const Vec2& corner, const Vec2& size, std::string_view data_uri);
  /// `data`: SVG path data.
  void path(std::string_view data, std::string_view style);
  void open_group(std::string_view attributes);
  void close_group();

  /// The finished document. The writer is empty afterwards.
  [[nodiscard]] std::string finish();

 private:
  std::string text_;
};

}  // namespace incise
