#include "imaging/phantom_tumor.hpp"

#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/imaging/tumor_star.hpp>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

Vec3 on_back(const TongueShape& shape, double x_mm, double y_mm) {
  const std::optional<TissueSpan> span = span_at(shape, x_mm, y_mm);
  INCISE_REQUIRE(span.has_value(), "expected a tumour that fits on the back of the tongue; reduce tumor_diameter_mm");
  return {x_mm, y_mm, span->high_mm};
}

// Rings of points from the centre (one point) to the edge, on the back or on the bowl beneath it; each has as many
// points as the edge.
constexpr int kRings = 8;

Vec3 bowl_point(const TongueShape& shape, const Vec3& center, const Vec3& edge, double share, double depth_mm) {
  const Vec3 flat = center + share * (edge - center);
  Vec3 p = on_back(shape, flat.x(), flat.y());
  p.z() -= depth_mm * std::sqrt(std::max(0.0, 1.0 - share * share));
  return p;
}

VertexId add_vertex(TriMesh& mesh, const Vec3& p) {
  mesh.vertices.push_back(p);
  return VertexId(mesh.vertices.size() - 1);
}

// Adds one side of the tumour inside `rim`: the back for `depth_mm` 0, otherwise the bowl. Faces up if `is_up`.
void add_cap(TriMesh& mesh, const TongueShape& shape, const Vec3& center, const std::vector<VertexId>& rim,
             double depth_mm, bool is_up) {
  const std::size_t sides = rim.size();
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    mesh.triangles.push_back(is_up ? Triangle{a, b, c} : Triangle{a, c, b});
  };
  std::vector<VertexId> outer = rim;
  for (int ring = kRings - 1; ring >= 1; --ring) {
    std::vector<VertexId> inner;
    for (std::size_t n = 0; n < sides; ++n)
      inner.push_back(add_vertex(mesh, bowl_point(shape, center, mesh.vertices[rim[n].index()],
                                                  static_cast<double>(ring) / kRings, depth_mm)));
    for (std::size_t n = 0; n < sides; ++n) {
      const std::size_t next = (n + 1) % sides;
      add(inner[n], outer[n], outer[next]);
      add(inner[n], outer[next], inner[next]);
    }
    outer = std::move(inner);
  }
  const VertexId middle = add_vertex(mesh, bowl_point(shape, center, center, 0.0, depth_mm));
  for (std::size_t n = 0; n < sides; ++n) add(middle, outer[n], outer[(n + 1) % sides]);
}

}  // namespace

void draw_tumor(const PhantomSettings& settings, Random& random, Phantom& phantom) {
  const TumorStar star = draw_tumor_star(settings.tumor_diameter_mm, settings.tumor_irregularity, random);
  const double y = (settings.tumor_position - 0.5) * phantom.shape.length_mm;
  const Vec3 center = on_back(phantom.shape, midline_x_mm(phantom.shape, y), y);
  std::vector<VertexId> rim;
  for (int n = 0; n < settings.tumor_points; ++n) {
    const double angle = 2.0 * units::kPi * n / settings.tumor_points;
    const double r = star.radius_at_mm(angle);
    const Vec3 p = on_back(phantom.shape, center.x() + r * std::cos(angle), center.y() + r * std::sin(angle));
    phantom.tumor_edge.points.push_back(p);
    rim.push_back(add_vertex(phantom.tumor, p));
  }
  phantom.tumor_edge.is_closed = true;
  add_cap(phantom.tumor, phantom.shape, center, rim, 0.0, true);
  add_cap(phantom.tumor, phantom.shape, center, rim, settings.tumor_depth_mm, false);
  phantom.tumor_center_mm = center;
  const std::optional<TissueSpan> span = span_at(phantom.shape, center.x(), center.y());
  phantom.tissue_below_tumor_mm = span->high_mm - span->low_mm;
}

}  // namespace incise
