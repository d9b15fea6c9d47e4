#include "imaging/ruler_ticks.hpp"

#include "imaging/finer_ticks.hpp"

#include <incise/core/error.hpp>
#include <incise/core/median.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace incise::imaging_detail {
namespace {

constexpr std::size_t kLeastTicks = 8;
constexpr std::size_t kLeastOtherTicks = 6;  // of a second scale, which must be more even than the first
constexpr double kOtherEvenness = 0.04;
constexpr double kEvenness = 0.12;     // greatest deviation of a tick from its place, relative to the spacing
constexpr double kSameSpacing = 0.03;  // of two rows of one unit, on both edges of a ruler or on two rulers
constexpr double kLongestJump = 6.0;   // spacings without a tick; after more, another ruler may begin
constexpr std::size_t kOffPlace = 3;   // strokes between ticks; scratches or letters cause fewer
constexpr std::size_t kCoarseRun = 3;  // consecutive steps of the same multiple of the spacing
const char* const kTwoScalesHint =
    "Cover the other scale, or give the scale with two ticks of known distance: --two-points.";

struct Place {
  double at;  ///< px, across the seed's direction
  std::size_t stroke;
};

/// Returns, in order, the unused strokes that are parallel to the seed and side by side with it.
std::vector<Place> row_about(const Stroke& seed, const std::vector<Stroke>& strokes, const std::vector<bool>& is_used) {
  constexpr double kParallel = 0.9976;  // cosine of 4 degrees
  const Vec2 across(-seed.direction.y(), seed.direction.x());
  std::vector<Place> places;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const Stroke& s = strokes[i];
    const double along = std::abs(seed.direction.dot(s.center - seed.center));
    if (is_used[i] || std::abs(seed.direction.dot(s.direction)) < kParallel) continue;
    if (along > 0.5 * (seed.length + s.length)) continue;
    if (s.length > 4.0 * seed.length || s.length < 0.4 * seed.length) continue;
    places.push_back({across.dot(s.center - seed.center), i});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.at < b.at; });
  return places;
}

double median_step(const std::vector<Place>& places) {
  std::vector<double> steps;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) steps.push_back(places[i + 1].at - places[i].at);
  return median(steps);
}

/// A row of ticks, and evidence of a second spacing in it.
struct CountedRow {
  Comb comb;
  std::size_t off_place = 0;   ///< strokes between two ticks
  std::size_t coarse_run = 0;  ///< longest run of equal steps of more than one spacing
};

/// Numbers the ticks from neighbour to neighbour: errors of the first guess of the spacing, or a slow change of it
/// (perspective), do not add up.
CountedRow counted(const std::vector<Place>& places, const std::vector<Stroke>& strokes, double spacing) {
  constexpr double kOldShare = 0.8;
  CountedRow row;
  std::vector<double> ats{places.front().at};
  row.comb.numbers = {0.0};
  row.comb.used = {places.front().stroke};
  std::size_t off_since = 0, run = 0;
  double last_whole = 1.0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double step = (places[i].at - ats.back()) / spacing;
    const double whole = std::round(step);
    if (whole > kLongestJump) break;
    if (whole < 1.0 || std::abs(step - whole) > kEvenness * whole) {
      // A stroke that touches a tick is a rim, of the tick or of a letter; one between two ticks may be a finer scale.
      if (step > 0.25) ++off_since;
      continue;
    }
    run = whole > 1.0 && whole == last_whole ? run + 1 : (whole > 1.0 ? 1 : 0);
    row.coarse_run = std::max(row.coarse_run, run);
    last_whole = whole;
    row.off_place += std::exchange(off_since, 0);
    spacing = kOldShare * spacing + (1.0 - kOldShare) * (places[i].at - ats.back()) / whole;
    row.comb.numbers.push_back(row.comb.numbers.back() + whole);
    row.comb.used.push_back(places[i].stroke);
    ats.push_back(places[i].at);
  }
  for (const std::size_t s : row.comb.used) row.comb.ticks.push_back(strokes[s]);
  return row;
}

/// Fits the spacing by least squares over all ticks. Returns false if they are not even.
bool fit_spacing(Comb& comb, const Vec2& across, double evenness) {
  const auto n = static_cast<double>(comb.ticks.size());
  double mean_k = 0.0, kk = 0.0, rest = 0.0;
  Vec2 mean = Vec2::Zero(), slope = Vec2::Zero();
  for (std::size_t i = 0; i < comb.ticks.size(); ++i) {
    mean_k += comb.numbers[i] / n;
    mean += comb.ticks[i].center / n;
  }
  for (std::size_t i = 0; i < comb.ticks.size(); ++i) {
    kk += (comb.numbers[i] - mean_k) * (comb.numbers[i] - mean_k);
    slope += (comb.numbers[i] - mean_k) * (comb.ticks[i].center - mean);
  }
  slope /= kk;
  for (std::size_t i = 0; i < comb.ticks.size(); ++i) {
    rest += std::pow(across.dot(comb.ticks[i].center - mean - slope * (comb.numbers[i] - mean_k)), 2);
  }
  comb.spacing_px = across.dot(slope);
  const double deviation = std::sqrt(rest / (n - 2.0));
  comb.error_px = deviation / std::sqrt(kk);
  return deviation <= evenness * comb.spacing_px;
}

/// Returns the longest even row among the unused strokes.
std::optional<CountedRow> longest_row(const std::vector<Stroke>& strokes, const std::vector<bool>& is_used,
                                      std::size_t least_ticks, double evenness) {
  constexpr double kLeastSpacingPx = 3.0;
  std::optional<CountedRow> best;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (is_used[i]) continue;
    const std::vector<Place> places = row_about(strokes[i], strokes, is_used);
    if (places.size() < least_ticks) continue;
    const double spacing = median_step(places);
    if (spacing < kLeastSpacingPx) continue;
    CountedRow row = counted(places, strokes, spacing);
    const Vec2 across(-strokes[i].direction.y(), strokes[i].direction.x());
    if (row.comb.ticks.size() < least_ticks || !fit_spacing(row.comb, across, evenness)) continue;
    if (!best || row.comb.ticks.size() > best->comb.ticks.size()) best = std::move(row);
  }
  return best;
}

/// Returns every row of ticks in a picture (at most 6), longest first.
std::vector<CountedRow> rows_in(const ColorPicture& picture, int window) {
  constexpr std::size_t kMostRows = 6;
  const DarkPixels dark = dark_pixels(picture, window);
  const std::vector<Stroke> strokes = strokes_in(dark.mask, dark.darkness, 2.5);
  std::vector<bool> is_used(strokes.size(), false);
  std::vector<CountedRow> rows;
  while (rows.size() < kMostRows) {
    std::optional<CountedRow> row = rows.empty() ? longest_row(strokes, is_used, kLeastTicks, kEvenness)
                                                 : longest_row(strokes, is_used, kLeastOtherTicks, kOtherEvenness);
    if (!row) break;
    for (const std::size_t s : row->comb.used) is_used[s] = true;
    rows.push_back(std::move(*row));
  }
  return rows;
}

/// Sizes of the surroundings, pixels: narrow and wide, because spacing and width of strokes are unknown beforehand.
constexpr std::array<int, 2> kWindows{31, 81};

std::string text_of(const Comb& comb) {
  const Vec2& at = comb.ticks[comb.ticks.size() / 2].center;
  return fmt::format("{} ticks {:.2f} pixels apart at pixel {:.0f}, {:.0f}", comb.ticks.size(), comb.spacing_px, at.x(),
                     at.y());
}

/// Refuses two spacings: `--ruler-mm` is the distance between the finest ticks, and which ones are meant is unknown.
void require_one_spacing(const std::vector<CountedRow>& rows, const std::filesystem::path& name) {
  const CountedRow& first = rows.front();
  if (first.off_place >= kOffPlace || first.coarse_run >= kCoarseRun) {
    throw DataError(
        name, "",
        fmt::format("a ruler whose ticks have two spacings ({}, and {})", text_of(first.comb),
                    first.off_place >= kOffPlace ? fmt::format("{} between them", first.off_place)
                                                 : fmt::format("{} or more steps of several spacings", kCoarseRun)),
        "ticks of one spacing in view", kTwoScalesHint);
  }
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double ratio = rows[i].comb.spacing_px / first.comb.spacing_px;
    if (std::abs(ratio - 1.0) <= kSameSpacing) continue;
    throw DataError(name, "",
                    fmt::format("ticks of two spacings: {}, and {}", text_of(first.comb), text_of(rows[i].comb)),
                    "one scale in view, seen straight from above", kTwoScalesHint);
  }
}

/// Refuses finer ticks that are too faint or too short to be strokes: the scale would be that of the coarser ticks.
void require_no_finer_ticks(const ColorPicture& picture, const Comb& comb, const std::filesystem::path& name) {
  cv::Mat grey;
  cv::cvtColor(pixels_of(picture), grey, cv::COLOR_RGB2GRAY);
  const std::optional<FinerTicks> finer = finer_ticks(grey, comb);
  if (!finer) return;
  throw DataError(name, "",
                  fmt::format("fainter marks between a ruler's ticks ({}), at {:.2f} of their spacing", text_of(comb),
                              finer->share),
                  "a ruler whose finest ticks are all clear",
                  "Take a sharper or closer photograph, or give the scale with two ticks of known distance: "
                  "--two-points.");
}

}  // namespace

Ruler ruler_of_ticks(const ColorPicture& picture, std::optional<double> length_mm, const std::filesystem::path& name) {
  std::optional<Comb> best;
  for (const int window : kWindows) {
    const std::vector<CountedRow> rows = rows_in(picture, window);
    if (rows.empty()) continue;
    require_one_spacing(rows, name);
    const Comb& comb = rows.front().comb;
    if (best && std::abs(comb.spacing_px / best->spacing_px - 1.0) > kSameSpacing) {
      throw DataError(name, "", fmt::format("ticks of two spacings: {}, and {}", text_of(*best), text_of(comb)),
                      "one scale in view", kTwoScalesHint);
    }
    if (!best || comb.ticks.size() > best->ticks.size()) best = comb;
  }
  if (!best) {
    throw DataError(name, "", "no ruler (fewer than 8 evenly spaced parallel dark lines on a light ground)",
                    "a ruler with its ticks in view",
                    "Give the scale with --mm-per-pixel or two points of known distance instead.");
  }
  require_no_finer_ticks(picture, *best, name);
  if (!length_mm && every_second_is_longer(*best)) {
    throw DataError(name, "", fmt::format("a ruler of which every second tick is longer ({})", text_of(*best)),
                    "millimetre ticks, or a given distance between ticks",
                    "Are they half millimetres, or parts of an inch? Give the distance of its finest ticks: "
                    "--ruler-mm 0.5.");
  }
  Ruler ruler{
      length_mm.value_or(1.0) / best->spacing_px, 100.0 * best->error_px / best->spacing_px, {}, shape_of(*best)};
  for (const Stroke& tick : best->ticks) ruler.marks_px.push_back(tick.center);
  return ruler;
}

void require_no_ticks(const ColorPicture& picture, const std::filesystem::path& name) {
  for (const int window : kWindows) {
    const std::vector<CountedRow> rows = rows_in(picture, window);
    if (rows.empty()) continue;
    throw DataError(name, "", fmt::format("a ruler's ticks ({})", text_of(rows.front().comb)),
                    "a scale bar, and no other scale in view",
                    "Is the bar the ruler's body, or one of its ticks? Use --ruler ticks, or give the two ends of the "
                    "bar: --two-points.");
  }
}

}  // namespace incise::imaging_detail
