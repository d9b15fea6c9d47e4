#include <incise/core/error.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

namespace incise {

std::vector<double> true_errors_mm(const BenchBody& body, const BenchCut& cut, double target_mm, std::size_t points) {
  INCISE_REQUIRE(cut.inner_edge.has_value(), "expected a cut with a closed inner edge");
  const ViewFrame view = view_along(body.approach);
  const auto flat = [&view](Contour contour) {
    for (Vec3& p : contour.points) {
      p = view.to_view(p);
      p.z() = 0.0;
    }
    return contour;
  };
  const Contour tumor = flat(cut.tumor_edge);
  std::vector<double> errors;
  for (const Vec3& p : resample(flat(*cut.inner_edge), points).points) {
    const double distance = nearest_on(tumor, p).distance_mm;
    errors.push_back((contains_in_view(tumor, p, -Vec3::UnitZ()) ? -distance : distance) - target_mm);
  }
  return errors;
}

}  // namespace incise
