#include <incise/bench_kit/pictures.hpp>

#include <cmath>

namespace incise {

Vec3 weights_seen_at(std::span<const Vec3> in_view, const Triangle& t, const Vec2& p) {
  const Vec2 a = in_view[t[0].index()].head<2>();
  const Vec2 b = in_view[t[1].index()].head<2>() - a;
  const Vec2 c = in_view[t[2].index()].head<2>() - a;
  const double area = b.x() * c.y() - b.y() * c.x();
  if (std::abs(area) < 1e-12) return {1.0, 0.0, 0.0};
  const Vec2 d = p - a;
  const double v = (d.x() * c.y() - d.y() * c.x()) / area;
  const double w = (b.x() * d.y() - b.y() * d.x()) / area;
  return {1.0 - v - w, v, w};
}

std::vector<double> errors_seen_mm(const Points& places, const Contour& tumor_edge, double target_mm) {
  const auto flat = [](Vec3 p) {
    p.z() = 0.0;
    return p;
  };
  Contour edge = tumor_edge;
  for (Vec3& p : edge.points) p = flat(p);
  std::vector<double> errors;
  for (const Vec3& p : places) {
    const double distance = nearest_on(edge, flat(p)).distance_mm;
    errors.push_back((contains_in_view(edge, flat(p), -Vec3::UnitZ()) ? -distance : distance) - target_mm);
  }
  return errors;
}

}  // namespace incise
