#include <incise/bench_kit/pictures.hpp>
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
  return errors_seen_mm(resample(flat(*cut.inner_edge), points).points, flat(cut.tumor_edge), target_mm);
}

}  // namespace incise
