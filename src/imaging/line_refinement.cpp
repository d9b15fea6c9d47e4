#include "imaging/line_tracing.hpp"

#include <incise/core/median.hpp>

#include <algorithm>
#include <cmath>

namespace incise::imaging_detail {
namespace {

constexpr double kStepPx = 0.5;          // along a profile
constexpr double kLeastPeak = 0.4;       // least likelihood at the line's peak
constexpr double kFoot = 0.3;            // least likelihood that belongs to the line
constexpr double kEdgeMarginPx = 3.0;    // blur on either side of an edge
constexpr double kPlateauPx = 8.0;       // length over which the level beside an edge is averaged
constexpr double kWidthRange = 0.4;      // widths from this share of the median to its inverse are accepted
constexpr std::size_t kMedianReach = 6;  // points on either side

/// Likelihood along the normal: value i lies at -reach + i kStepPx.
struct Profile {
  std::vector<double> values;
  double reach_px;
  [[nodiscard]] double place(double i) const { return -reach_px + kStepPx * i; }
};

Profile profile_at(const cv::Mat& map, const Vec2& p, const Vec2& normal, double reach_px) {
  Profile profile{{}, reach_px};
  const int count = static_cast<int>(2.0 * reach_px / kStepPx) + 1;
  for (int i = 0; i < count; ++i) {
    const Vec2 q = p + profile.place(i) * normal;
    profile.values.push_back(sampled(map, q.x(), q.y()));
  }
  return profile;
}

bool has_glare(const cv::Mat& glare, const Vec2& p, const Vec2& normal, double from, double to) {
  for (double s = from; s <= to; s += 1.0) {
    if (covers(glare, p + s * normal)) return true;
  }
  return false;
}

struct Found {
  double offset_px;
  double from_px, to_px;  ///< part of the normal used for the result
};

/// Returns the centre of mass of the colour around the profile's peak.
std::optional<Found> middle_of(const Profile& profile) {
  const auto& t = profile.values;
  const std::size_t peak = static_cast<std::size_t>(std::max_element(t.begin(), t.end()) - t.begin());
  if (t[peak] < kLeastPeak) return std::nullopt;
  std::size_t first = peak, last = peak;
  while (first > 0 && t[first - 1] > kFoot) --first;
  while (last + 1 < t.size() && t[last + 1] > kFoot) ++last;
  if (first == 0 || last + 1 == t.size()) return std::nullopt;  // continues beyond the reach
  double mass = 0.0, moment = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const double weight = std::min(t[i], 1.2) - kFoot;
    mass += weight;
    moment += weight * profile.place(static_cast<double>(i));
  }
  return Found{moment / mass, profile.place(static_cast<double>(first)), profile.place(static_cast<double>(last))};
}

double mean_between(const Profile& profile, double from, double to) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < profile.values.size(); ++i) {
    const double s = profile.place(static_cast<double>(i));
    if (s < from || s > to) continue;
    sum += profile.values[i];
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

/// Returns the first place, from inside outwards, where the profile rises through a level and stays above it.
std::optional<double> rise_through(const Profile& profile, double level, double from) {
  const auto& t = profile.values;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    if (profile.place(static_cast<double>(i)) < from || !(t[i] < level && t[i + 1] >= level)) continue;
    const double s = profile.place(static_cast<double>(i) + (level - t[i]) / (t[i + 1] - t[i]));
    if (mean_between(profile, s, s + kEdgeMarginPx) >= level) return s;
  }
  return std::nullopt;
}

/// Returns the place where the colour is half-way between the level inside the ring and the level of the band.
std::optional<Found> inner_edge_of(const Profile& profile, double width_px) {
  const std::optional<double> rough = rise_through(profile, 0.5, -profile.reach_px);
  if (!rough) return std::nullopt;
  const double plateau =
      mean_between(profile, *rough + kEdgeMarginPx, *rough + std::min(kEdgeMarginPx + kPlateauPx, 0.6 * width_px));
  const double ground = mean_between(profile, *rough - kEdgeMarginPx - kPlateauPx, *rough - kEdgeMarginPx);
  if (plateau < 0.6 || ground > 0.4) return std::nullopt;
  const std::optional<double> edge = rise_through(profile, 0.5 * (plateau + ground), *rough - kEdgeMarginPx);
  if (!edge) return std::nullopt;
  return Found{*edge, *edge - kEdgeMarginPx, *edge + 2.0 * kEdgeMarginPx};
}

/// Marks points as unseen if their offset differs too much from their neighbours' median: they lie on something else.
void reject_outliers(const std::vector<double>& offsets, std::vector<bool>& is_seen, bool is_closed,
                     double tolerance_px) {
  const std::size_t n = offsets.size();
  const std::vector<bool> seen = is_seen;
  for (std::size_t i = 0; i < n; ++i) {
    if (!seen[i]) continue;
    std::vector<double> around;
    for (std::size_t k = 0; k <= 2 * kMedianReach; ++k) {
      if (!is_closed && (i + k < kMedianReach || i + k - kMedianReach >= n)) continue;
      const std::size_t j = (i + n + k - kMedianReach) % n;
      if (seen[j]) around.push_back(offsets[j]);
    }
    if (std::abs(offsets[i] - median(around)) > tolerance_px) is_seen[i] = false;
  }
}

/// Returns the trusted points: seen, and not next to an unseen one, because what hides it affects its neighbours too.
std::vector<bool> trusted(const std::vector<bool>& is_seen, bool is_closed) {
  constexpr std::size_t kMargin = 4;
  const std::size_t n = is_seen.size();
  std::vector<bool> result = is_seen;
  for (std::size_t i = 0; i < n; ++i) {
    if (is_seen[i]) continue;
    for (std::size_t k = 1; k <= kMargin; ++k) {
      if (is_closed || i + k < n) result[(i + k) % n] = false;
      if (is_closed || i >= k) result[(i + n - k % n) % n] = false;
    }
  }
  return result;
}

/// Returns the mean direction of the trusted points next to i, after or before it; always in the line's direction.
Vec2 direction_beside(const Line& line, const std::vector<bool>& is_trusted, bool is_closed, std::size_t i,
                      bool forwards) {
  constexpr std::size_t kReach = 20;
  const std::size_t n = line.size();
  std::size_t j = i;
  for (std::size_t k = 0; k < kReach; ++k) {
    if (!is_closed && (forwards ? j + 1 >= n : j == 0)) break;
    const std::size_t next = forwards ? (j + 1) % n : (j + n - 1) % n;
    if (!is_trusted[next] || next == i) break;
    j = next;
  }
  const Vec2 along = forwards ? Vec2(line[j] - line[i]) : Vec2(line[i] - line[j]);
  return along.norm() > 0.0 ? Vec2(along.normalized()) : Vec2::Zero();
}

/// Replaces untrusted stretches by Hermite cubics that continue the line's direction at both ends; the ends of an open
/// line stay.
void bridge(Line& line, const std::vector<bool>& is_trusted, bool is_closed) {
  const std::size_t n = line.size();
  const auto first =
      static_cast<std::size_t>(std::find(is_trusted.begin(), is_trusted.end(), true) - is_trusted.begin());
  if (first == n) return;
  std::size_t previous = first;
  for (std::size_t k = 1; k <= (is_closed ? n : n - 1 - first); ++k) {
    const std::size_t i = (first + k) % n;
    if (!is_trusted[i]) continue;
    const std::size_t run = (i + n - previous - 1) % n + 1;  // n where only one point is trusted
    if (run > 1 && run < n) {
      const Vec2 a = line[previous], b = line[i];
      const double span = (b - a).norm();
      const Vec2 leave = span * direction_beside(line, is_trusted, is_closed, previous, false);
      const Vec2 arrive = span * direction_beside(line, is_trusted, is_closed, i, true);
      for (std::size_t j = 1; j < run; ++j) {
        const double t = static_cast<double>(j) / static_cast<double>(run);
        line[(previous + j) % n] = (1 + 2 * t) * (1 - t) * (1 - t) * a + t * t * (3 - 2 * t) * b +
                                   t * (1 - t) * (1 - t) * leave - t * t * (1 - t) * arrive;
      }
    }
    previous = i;
  }
}

}  // namespace

RefinedLine refine(const Line& line, bool is_closed, const cv::Mat& likelihood, const cv::Mat& glare,
                   const RefineSettings& settings) {
  const std::size_t n = line.size();
  const auto reach = static_cast<std::size_t>(std::clamp(settings.width_px / 4.0, 4.0, 12.0));
  std::vector<double> offsets(n, 0.0), widths(n, 0.0), seen_widths;
  std::vector<Vec2> normals(n);
  RefinedLine result{line, std::vector<bool>(n, false), settings.width_px};
  for (std::size_t i = 0; i < n; ++i) {
    normals[i] = outward(tangent_at(line, is_closed, i, reach));
    const Profile profile = profile_at(likelihood, line[i], normals[i], settings.reach_px);
    const auto found =
        settings.edge == LineEdge::Middle ? middle_of(profile) : inner_edge_of(profile, settings.width_px);
    if (!found || has_glare(glare, line[i], normals[i], found->from_px - 1.0, found->to_px + 1.0)) continue;
    offsets[i] = found->offset_px;
    widths[i] = found->to_px - found->from_px;
    seen_widths.push_back(widths[i]);
    result.is_seen[i] = true;
  }
  if (settings.edge == LineEdge::Middle) {
    result.width_px = seen_widths.empty() ? 0.0 : median(seen_widths);
    for (std::size_t i = 0; i < n; ++i) {
      const bool is_odd = widths[i] < kWidthRange * result.width_px || widths[i] > result.width_px / kWidthRange;
      if (settings.reject_outliers && is_odd) result.is_seen[i] = false;
    }
  }
  if (settings.reject_outliers)
    reject_outliers(offsets, result.is_seen, is_closed, 1.5 + 0.1 * std::min(result.width_px, 15.0));
  for (std::size_t i = 0; i < n; ++i) result.points[i] += offsets[i] * normals[i];
  bridge(result.points, trusted(result.is_seen, is_closed), is_closed);
  return result;
}

}  // namespace incise::imaging_detail
