#include <incise/evaluation/error_profile.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/expected_errors.hpp>

namespace incise {
namespace {

ProfileSettings sectors_of(const Case& settings) {
  return {.approach = settings.plan.approach, .start_direction = settings.plan.start_direction};
}

/// Returns the simulated errors, by sector, of the line by which the path is corrected; nullopt if it does not go round
/// the tumour's middle.
std::optional<std::vector<double>> simulated_sectors(const Case& settings, const SimulatedCut& cut,
                                                     const Contour& tumor_edge) {
  Monitor silent;  // the correction itself reports which line it uses
  const std::optional<PathErrors> errors = path_errors(settings, cut, tumor_edge, silent);
  if (!errors) return std::nullopt;
  return sector_means(errors->places, errors->signed_error_mm, tumor_edge, sectors_of(settings));
}

}  // namespace

std::vector<double> ExpectedErrors::at(const Case& settings, const Points& places, const Contour& edge) const {
  std::vector<double> sum(places.size(), 0.0);
  for (const std::vector<double>* part : {&listed_mm, &simulated_mm}) {
    if (part->empty()) continue;
    const std::vector<double> values = values_at(*part, places, edge, sectors_of(settings));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
  }
  return sum;
}

ExpectedErrors expected_errors(const Case& settings, const SimulatedCut& first, const Contour& tumor_edge) {
  const CompensationChoice& choice = settings.compensation;
  if (settings.plan.kind != PlanKind::Ring || choice.method == CompensationMethod::Paper) return {};
  const bool is_profile = choice.method == CompensationMethod::Profile;
  const double share = is_profile ? 0.0 : choice.simulated_share;
  const double bias_mm = is_profile ? 0.0 : choice.bias_mm;
  ExpectedErrors expected;
  expected.tumor_edge = tumor_edge;
  expected.listed_mm = is_profile ? choice.photographed_mm : choice.residual_mm;
  if (expected.listed_mm.empty() && bias_mm != 0.0) expected.listed_mm = {0.0};
  for (double& error : expected.listed_mm) error += bias_mm;
  if (share == 1.0) return expected;
  Case observed = settings;
  if (is_profile) observed.compensation.observable = ContourKind::InnerEdge;  // what a photograph shows
  std::optional<std::vector<double>> simulated = simulated_sectors(observed, first, tumor_edge);
  if (!simulated) return {.is_measured = false};
  for (double& error : *simulated) error = (share - 1.0) * (error + bias_mm);
  expected.simulated_mm = std::move(*simulated);
  return expected;
}

}  // namespace incise
