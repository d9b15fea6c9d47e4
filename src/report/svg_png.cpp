#include <incise/core/error.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/report/svg_png.hpp>

#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>
#include <vector>

namespace incise {
namespace {

struct Release {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
template <class Thing>
using Owned = std::unique_ptr<Thing, Release>;

[[noreturn]] void refuse(GError* error) {
  const std::string text = error != nullptr ? error->message : "unknown reason";
  if (error != nullptr) g_error_free(error);
  throw Error("a figure could not be drawn as PNG: " + text);
}

/// Cairo's pixels are native 32-bit words, 0xAARRGGBB.
std::vector<std::uint8_t> rgb_of(cairo_surface_t* surface, int width, int height) {
  cairo_surface_flush(surface);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  std::vector<std::uint8_t> pixels;
  pixels.reserve(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(data + y * stride);
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      for (const int shift : {16, 8, 0}) pixels.push_back(static_cast<std::uint8_t>(row[x] >> shift & 0xFF));
    }
  }
  return pixels;
}

}  // namespace

std::string png_of_svg(std::string_view svg, double scale) {
  INCISE_REQUIRE(scale > 0.0 && scale <= 10.0, fmt::format("found a scale of {}, expected one in (0, 10]", scale));
  GError* error = nullptr;
  const Owned<RsvgHandle> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!handle) refuse(error);
  double wide = 0.0;
  double high = 0.0;
  if (rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &wide, &high) == FALSE) {
    throw Error("a figure could not be drawn as PNG: it has no size");
  }
  const int width = static_cast<int>(std::lround(wide * scale));
  const int height = static_cast<int>(std::lround(high * scale));
  INCISE_REQUIRE(width >= 1 && height >= 1 && width <= 20'000 && height <= 20'000,
                 fmt::format("found a figure of {} x {} pixels, expected sides of 1 to 20000", width, height));
  const Owned<cairo_surface_t> surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  const Owned<cairo_t> context(cairo_create(surface.get()));
  cairo_set_source_rgb(context.get(), 1.0, 1.0, 1.0);
  cairo_paint(context.get());
  const RsvgRectangle whole{0.0, 0.0, static_cast<double>(width), static_cast<double>(height)};
  if (rsvg_handle_render_document(handle.get(), context.get(), &whole, &error) == FALSE) refuse(error);
  if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS) {
    throw Error(std::string("a figure could not be drawn as PNG: ") +
                cairo_status_to_string(cairo_status(context.get())));
  }
  return encode_png(rgb_of(surface.get(), width, height), width, height, 3);
}

}  // namespace incise
