#include <incise/core/error.hpp>
#include <incise/geometry/neighbours.hpp>

#include <fmt/format.h>
#include <nanoflann.hpp>

#include <algorithm>

namespace incise {
namespace {

bool comes_first(const Neighbour& a, const Neighbour& b) {
  return a.squared_mm2 != b.squared_mm2 ? a.squared_mm2 < b.squared_mm2 : a.index < b.index;
}

}  // namespace

struct NeighbourSearch::Tree {
  /// The interface that nanoflann requires of a set of points.
  struct PointSource {
    Points points;
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t axis) const { return points[index][static_cast<Eigen::Index>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSource>, PointSource, 3, std::size_t>;

  PointSource source;
  Index index;
  explicit Tree(Points points)
      : source{std::move(points)}, index(3, source, nanoflann::KDTreeSingleIndexAdaptorParams(12)) {}
};

NeighbourSearch::NeighbourSearch(std::span<const Vec3> points) {
  INCISE_REQUIRE(!points.empty(), "expected at least 1 point, found none");
  for (std::size_t i = 0; i < points.size(); ++i) {
    INCISE_REQUIRE(points[i].allFinite(), fmt::format("point {} is not finite", i));
  }
  tree_ = std::make_shared<Tree>(Points(points.begin(), points.end()));
}

Neighbour NeighbourSearch::nearest(const Vec3& p) const {
  Neighbour found;
  nanoflann::KNNResultSet<double, std::size_t> result(1);
  result.init(&found.index, &found.squared_mm2);
  tree_->index.findNeighbors(result, p.data(), nanoflann::SearchParams());
  return found;
}

std::vector<Neighbour> NeighbourSearch::nearest(const Vec3& p, std::size_t count) const {
  count = std::min(count, tree_->source.points.size());
  std::vector<std::size_t> indices(count);
  std::vector<double> squared(count);
  if (count > 0) tree_->index.knnSearch(p.data(), count, indices.data(), squared.data());
  std::vector<Neighbour> found(count);
  for (std::size_t i = 0; i < count; ++i) found[i] = {indices[i], squared[i]};
  std::sort(found.begin(), found.end(), comes_first);
  return found;
}

std::vector<Neighbour> NeighbourSearch::within(const Vec3& p, double radius_mm) const {
  INCISE_REQUIRE(radius_mm >= 0.0, fmt::format("expected a radius of 0 mm or more, found {}", radius_mm));
  std::vector<std::pair<std::size_t, double>> matches;
  tree_->index.radiusSearch(p.data(), radius_mm * radius_mm, matches, nanoflann::SearchParams(32, 0.0F, false));
  std::vector<Neighbour> found;
  found.reserve(matches.size());
  for (const auto& [index, squared] : matches) found.push_back({index, squared});
  std::sort(found.begin(), found.end(), comes_first);
  return found;
}

}  // namespace incise
