#include <incise/bench_kit/pictures.hpp>
#include <incise/core/error.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

namespace incise {

std::vector<double> true_errors_mm(const BenchBody& body, const BenchCut& cut, double target_mm, std::size_t points) {
  INCISE_REQUIRE(cut.inner_edge.has_value(), "expected a cut with a closed inner edge");
  const ViewFrame view = view_along(body.approach);
  return errors_seen_mm(resample(flat_in_view(*cut.inner_edge, view), points).points,
                        flat_in_view(cut.tumor_edge, view), target_mm);
}

}  // namespace incise
