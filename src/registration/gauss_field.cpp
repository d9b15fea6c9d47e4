#include "registration/gauss_field.hpp"

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr double kMostCellsPerPoint = 8.0;
constexpr std::size_t kPlacesInAChunk = 64;
constexpr long kCellsPerReach = 2;  // cells smaller than the reach approximate the ball better than one cube

}  // namespace

GaussField::GaussField(std::span<const Vec3> points, std::span<const double> weights, double sigma)
    : steepness_(0.5 / (sigma * sigma)), sums_(gauss_sums()) {
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  low_ = points.empty() ? Vec3(Vec3::Zero()) : Vec3(box.min());
  const Vec3 size = points.empty() ? Vec3(Vec3::Zero()) : Vec3(box.sizes());
  // Narrow Gaussians in a large box would need far more cells than there are points; the cells then stay larger.
  cell_ = kReach * sigma / kCellsPerReach;
  const auto cells_for = [&size](double cell) { return ((size / cell).array().floor() + 1.0).prod(); };
  while (cells_for(cell_) > kMostCellsPerPoint * static_cast<double>(points.size()) + 64.0) cell_ *= 1.2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts_[axis] = static_cast<long>(std::floor(size[static_cast<Eigen::Index>(axis)] / cell_)) + 1;
  }
  sort_into_cells(points, weights);
}

void GaussField::sort_into_cells(std::span<const Vec3> points, std::span<const double> weights) {
  const auto cell_of = [this](const Vec3& p) {
    std::array<long, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      at[axis] = std::min(static_cast<long>((p[k] - low_[k]) / cell_), counts_[axis] - 1);
    }
    return static_cast<std::size_t>(at[0] + counts_[0] * (at[1] + counts_[1] * at[2]));
  };
  starts_.assign(static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]) + 1, 0);
  for (const Vec3& p : points) ++starts_[cell_of(p) + 1];
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  const std::size_t padded = points.size() + kGaussPadding;
  for (auto* array : {&x_, &y_, &z_, &weights_}) array->assign(padded, 0.0);
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t at = next[cell_of(points[i])]++;
    x_[at] = points[i].x();
    y_[at] = points[i].y();
    z_[at] = points[i].z();
    weights_[at] = weights.empty() ? 1.0 : weights[i];
  }
}

GaussSum GaussField::at(const Vec3& place) const {
  // Cells within reach on each axis. Along x they are contiguous in memory, so each row of cells is one range.
  std::array<long, 3> first{};
  std::array<long, 3> last{};
  GaussSum sum;
  const double reach = std::sqrt(0.5 / steepness_) * kReach;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const double from = std::floor((place[k] - low_[k] - reach) / cell_);
    const double to = std::floor((place[k] - low_[k] + reach) / cell_);
    if (to < 0.0 || from > static_cast<double>(counts_[axis] - 1)) return sum;
    first[axis] = static_cast<long>(std::max(0.0, from));
    last[axis] = static_cast<long>(std::min(static_cast<double>(counts_[axis] - 1), to));
  }
  constexpr std::size_t kMostRanges = 64;
  std::array<GaussRange, kMostRanges> ranges;
  std::array<double, 5> part{};
  std::size_t count = 0;
  const GaussPoints points{x_.data(), y_.data(), z_.data(), weights_.data()};
  const auto flush = [&] {
    sums_(points, ranges.data(), count, place.data(), steepness_, part.data());
    sum.weight += part[0];
    sum.first += Vec3(part[1], part[2], part[3]);
    sum.second += part[4];
    count = 0;
  };
  for (long z = first[2]; z <= last[2]; ++z) {
    for (long y = first[1]; y <= last[1]; ++y) {
      const auto row = static_cast<std::size_t>(counts_[0] * (y + counts_[1] * z));
      const GaussRange range{starts_[row + static_cast<std::size_t>(first[0])],
                             starts_[row + static_cast<std::size_t>(last[0]) + 1]};
      if (range.begin == range.end) continue;
      ranges[count++] = range;
      if (count == kMostRanges) flush();
    }
  }
  if (count > 0) flush();
  return sum;
}

std::vector<GaussSum> GaussField::at(std::span<const Vec3> places, Workers& workers) const {
  std::vector<GaussSum> sums(places.size());
  workers.for_each(places.size(), kPlacesInAChunk, [&](std::size_t i) { sums[i] = at(places[i]); });
  return sums;
}

}  // namespace incise
