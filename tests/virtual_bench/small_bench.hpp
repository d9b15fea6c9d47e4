#pragma once

#include <incise/core/workers.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

#include <cmath>
#include <vector>

namespace incise::test {

/// Far coarser than the bench: for what does not hang on the mesh.
inline const BenchResolution kCoarse{.fine_mm = 2.0, .coarse_mm = 8.0, .way_mm = 1.0};

/// The middle of every spread.
inline Specimen middle_specimen() {
  Specimen specimen;
  specimen.seed = 3;
  return specimen;
}

inline BenchBody coarse_body(const Specimen& specimen) {
  Workers workers(1);
  Monitor monitor;
  return make_body(specimen, kCoarse, workers, monitor);
}

/// The body of the middle of every spread: made once.
inline const BenchBody& middle_body() {
  static const BenchBody made = coarse_body(middle_specimen());
  return made;
}

/// Once round the stretched tumour, 5 mm outside its edge and 5 mm deep, with 8 mm of overlap.
inline std::vector<TipPose> ring_course(const BenchBody& body, double speed_mm_s) {
  const Contour edge = resample(tumor_edge_at(body, body.stretched.positions), 96);
  const Vec3 middle = curve_centroid(edge);
  const SurfaceQuery skin(skin_at(body, body.stretched.positions));
  std::vector<TipPose> course;
  double way = 0.0;
  for (std::size_t n = 0; n <= edge.points.size() + 8; ++n) {
    const Vec3& p = edge.points[n % edge.points.size()];
    const Vec2 out = (p - middle).head<2>();
    const Vec2 at = middle.head<2>() + out * (1.0 + 5.0 / out.norm());
    const auto entry = skin.seen_at(Vec3(at.x(), at.y(), p.z()), body.approach);
    const Vec3 tip = entry->position_mm - 5.0 * Vec3::UnitZ();
    if (course.empty()) {
      course.push_back({0.0, tip + 6.0 * Vec3::UnitZ(), -Vec3::UnitZ(), false});
      way = 6.0;
    } else {
      way += (tip - course.back().tip_mm).norm();
    }
    course.push_back({way / speed_mm_s, tip, -Vec3::UnitZ(), true});
  }
  return course;
}

inline BenchCut coarse_cut(const BenchBody& body, double power_w, double speed_mm_s = 7.0) {
  Workers workers(1);
  Monitor monitor;
  return cut_specimen(body, ring_course(body, speed_mm_s), power_w, workers, monitor);
}

}  // namespace incise::test
