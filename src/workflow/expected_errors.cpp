#include <incise/evaluation/error_profile.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/expected_errors.hpp>

#include <algorithm>

namespace incise {
namespace {

/// Simulated errors by sector of the line that the path is corrected by; nothing where it does not go round the tumour.
std::optional<std::vector<double>> simulated_sectors(const Case& settings, const SimulatedCut& cut,
                                                     const Contour& tumor_edge, std::size_t sectors) {
  Monitor silent;  // whoever corrects by this line says which it is
  const std::optional<PathErrors> errors = path_errors(settings, cut, tumor_edge, silent);
  if (!errors) return std::nullopt;
  return sector_means(errors->places, errors->signed_error_mm, tumor_edge,
                      {.approach = settings.plan.approach,
                       .start_direction = settings.plan.start_direction,
                       .sectors = static_cast<int>(sectors)});
}

}  // namespace

ExpectedErrors expected_errors(const Case& settings, const SimulatedCut& first, const Contour& tumor_edge) {
  const CompensationChoice& choice = settings.compensation;
  if (settings.plan.kind != PlanKind::Ring || choice.method == CompensationMethod::Paper) return {};
  const bool is_profile = choice.method == CompensationMethod::Profile;
  const std::vector<double>& listed = is_profile ? choice.photographed_mm : choice.residual_mm;
  const double share = is_profile ? 0.0 : choice.simulated_share;
  const double bias_mm = is_profile ? 0.0 : choice.bias_mm;
  if (listed.empty() && share == 1.0 && bias_mm == 0.0) return {};
  const std::size_t sectors = listed.size() > 1 ? listed.size() : static_cast<std::size_t>(ProfileSettings{}.sectors);
  ExpectedErrors expected{std::vector<double>(sectors, bias_mm), tumor_edge};
  for (std::size_t k = 0; k < sectors && !listed.empty(); ++k) expected.beyond_mm[k] += listed[k % listed.size()];
  if (share == 1.0) return expected;
  const std::optional<std::vector<double>> simulated = simulated_sectors(settings, first, tumor_edge, sectors);
  if (!simulated) return {};
  for (std::size_t k = 0; k < sectors; ++k) expected.beyond_mm[k] += (share - 1.0) * ((*simulated)[k] + bias_mm);
  return expected;
}

}  // namespace incise
