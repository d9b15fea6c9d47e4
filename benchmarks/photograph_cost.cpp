// A photograph from file to measures: time beside accuracy, on painted photographs whose contours are known (virtual).
//   incise_photograph_cost [--runs N] [--pixels N] [--csv FILE]
#include "cost_table.hpp"
#include "process_cost.hpp"
#include "support/contour_shapes.hpp"
#include "support/encode_jpeg.hpp"
#include "support/photo_painter.hpp"

#include <incise/evaluation/evaluation.hpp>
#include <incise/evaluation/level_loop.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/io/picture_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace incise::bench {
namespace {

// The bars.
constexpr double kSeconds = 2.0;     // wall, of 3000 x 3000 pixels
constexpr double kContourMm = 0.03;  // mean absolute error of a contour
constexpr double kMeasureMm = 0.02;  // of a measure in mm
constexpr double kHu = 0.01;         // of a Hu score
constexpr double kMmPerPixel = 0.03;

struct Options {
  int runs = 5;
  int pixels = 3000;
  std::string csv;
};

struct Kind {
  const char* name;
  double width_px;
  RedLine red;
};

struct Scene {
  Contour tumor;
  Contour incision;
  std::string jpeg;
};

/// A tumour that fills 40 % of the picture's width, with its incision; JPEG of quality 70.
Scene scene(const Kind& kind, int pixels) {
  testing::PaintedPhoto photo;
  photo.width = photo.height = pixels;
  photo.mm_per_pixel = kMmPerPixel;
  const double side = pixels * kMmPerPixel;
  Scene s;
  s.tumor = testing::moved(testing::irregular_tumor(1440), 0.4, side / 60.0, Vec3(0.5 * side, 0.5 * side, 0.0));
  s.incision = testing::moved(outer_offset(s.tumor, 4.5, -Vec3::UnitZ()), 0.0, 1.0, Vec3(0.4, -0.3, 0.0));
  photo.lines.push_back({.course = s.tumor, .width_mm = 5.0 * kMmPerPixel});
  photo.lines.push_back({.course = s.incision,
                         .width_mm = kind.width_px * kMmPerPixel,
                         .color = {205, 20, 35},
                         .is_outside = kind.red == RedLine::Kerf});
  s.jpeg = testing::encode_jpeg(testing::paint_photo(photo), 70);
  return s;
}

double mean_error_mm(const Contour& found, const Contour& truth) {
  constexpr std::size_t kPoints = 600;
  double sum = 0.0;
  for (const Vec3& p : resample(found, kPoints).points) sum += nearest_on(truth, p).distance_mm;
  return sum / kPoints;
}

bool measure(const Kind& kind, const Options& options, std::string& table) {
  const Scene truth = scene(kind, options.pixels);
  const EvaluationSettings settings{.contour = ContourKind::InnerEdge};
  std::vector<double> decode, find, walls, processors;
  PhotoContours found;
  Evaluation seen;
  for (int run = -1; run < options.runs; ++run) {  // the first one warms up
    const double start = wall_seconds(), processor = processor_seconds();
    const ColorPicture picture = decode_picture(truth.jpeg, "photo.jpg");
    const double decoded = wall_seconds();
    found = find_photo_contours(picture, scale_from_mm_per_pixel(kMmPerPixel, picture.height), {.red = kind.red},
                                "photo.jpg");
    const double traced = wall_seconds();
    seen = evaluate(found.incision, found.tumor_edge, settings);
    if (run < 0) continue;
    decode.push_back(decoded - start);
    find.push_back(traced - decoded);
    walls.push_back(wall_seconds() - start);
    processors.push_back(processor_seconds() - processor);
  }
  const Evaluation real = evaluate(truth.incision, truth.tumor, settings);
  const double green = mean_error_mm(found.tumor_edge, truth.tumor);
  const double red = mean_error_mm(found.incision, truth.incision);
  const double error = std::abs(seen.abs_error_mm->mean - real.abs_error_mm->mean);
  const double hu = std::abs(*seen.hu_score - *real.hu_score);
  const bool is_good = median(walls) <= kSeconds && green < kContourMm && red < kContourMm && error < kMeasureMm &&
                       (seen.hu_unstable || real.hu_unstable || hu < kHu) && seen.outcome == real.outcome;
  const auto [fastest, slowest] = std::minmax_element(walls.begin(), walls.end());
  const std::string line = fmt::format(
      "{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f},{:.4f},{:.5f},{:.0f},{}\n", kind.name,
      options.pixels, options.runs, median(decode), median(find), median(walls), *fastest, *slowest, median(processors),
      green, red, error, hu, peak_bytes() / 1048576.0, is_good ? "yes" : "NO");
  tell(line, table);
  return is_good;
}

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--runs" && i + 1 < argc) {
      options.runs = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--pixels" && i + 1 < argc) {
      options.pixels = std::max(600, std::atoi(argv[++i]));
    } else if (word == "--csv" && i + 1 < argc) {
      options.csv = argv[++i];
    } else {
      throw std::runtime_error(fmt::format("expected --runs N, --pixels N or --csv FILE, found {}", word));
    }
  }
  return options;
}

int run(int argc, char** argv) {
  const Options options = options_of(argc, argv);
  std::string table;
  tell(origin_line("1 thread"), table);
  tell(
      "red_line,pixels,runs,decode_s,find_s,wall_s,wall_least_s,wall_most_s,processor_s,green_error_mm,red_error_mm,"
      "abs_error_change_mm,hu_change,peak_mb,passed\n",
      table);
  bool is_good = true;
  for (const Kind& kind : {Kind{"line 4 px", 4.0, RedLine::Annotation}, Kind{"line 12 px", 12.0, RedLine::Annotation},
                           Kind{"kerf 60 px", 60.0, RedLine::Kerf}}) {
    is_good = measure(kind, options, table) && is_good;
  }
  write_text(options.csv, table);
  return is_good ? 0 : 4;
}

}  // namespace
}  // namespace incise::bench

int main(int argc, char** argv) {
  return incise::bench::reporting_errors("incise_photograph_cost", [&] { return incise::bench::run(argc, argv); });
}
