#include "study_run.hpp"

#include <incise/steps/case_steps.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <numeric>

namespace incise::cli {
namespace {

struct ForecastOptions {
  std::filesystem::path case_path, calibration;
};

double mean_of(const nlohmann::ordered_json& list) {
  const auto values = list.get<std::vector<double>>();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void print_forecast(const nlohmann::ordered_json& result) {
  if (!result.contains("with_simulation")) {
    fmt::print("not stretched: {}\n", result.at("outcome").get<std::string>());
    return;
  }
  fmt::print("specimen: {}, calibration: {}\n", result.at("specimen_is").get<std::string>(),
             result.at("calibration_is").get<std::string>());
  fmt::print("from {} of {} photographs, signed error along the planned path (positive: farther out)\n",
             result.at("photographs").get<std::size_t>(), result.at("calibrated").get<std::size_t>());
  const auto& alone = result.at("without_simulation");
  const auto& joined = result.at("with_simulation");
  fmt::print("{:<36} mean {:+.2f} mm, sd {:.2f} mm\n", "without simulation", mean_of(alone.at("residual_mm")),
             alone.at("level_sd_mm").get<double>());
  fmt::print("{:<36} mean {:+.2f} mm plus {:.2f} times the simulated error, sd {:.2f} mm\n", "with simulation",
             mean_of(joined.at("residual_mm")), joined.at("simulated_share").get<double>(),
             joined.at("level_sd_mm").get<double>());
  const auto& eye = joined.at("hand_eye");
  for (int axis = 0; axis < 2; ++axis)
    fmt::print("{:<36} {:+.2f} mm (95 %: {:+.2f} to {:+.2f})\n",
               fmt::format("hand-eye offset, {}", axis == 0 ? "x" : "y"), eye.at("offset_mm")[axis].get<double>(),
               eye.at("low_mm")[axis].get<double>(), eye.at("high_mm")[axis].get<double>());
  const auto unlike = joined.at("unlike").get<std::vector<std::string>>();
  if (!unlike.empty()) fmt::print("outside most photographed rings in: {}\n", fmt::join(unlike, ", "));
  fmt::print("lists for the case's compensation: {}/forecast.json\n", result.at("folder").get<std::string>());
}

int forecast_case(const ForecastOptions& chosen, const CommonOptions& options) {
  return run_step(
      options,
      [&](const auto& context) {
        return steps::forecast_case(case_request({chosen.case_path}, Stage::Plan, options), chosen.calibration,
                                    context);
      },
      print_forecast);
}

}  // namespace

void add_forecast(Application& application) {
  auto [verb, a] = application.add_verb<ForecastOptions>(
      "forecast",
      "Forecast the error of this ring from photographs of earlier cuts: the expected error by direction, with and "
      "without the simulation, its uncertainty, and in which respects the ring lies outside those photographed",
      "incise forecast specimen --calibration calibration/calibration.json -o out", forecast_case);
  add_case(*verb, a.case_path)
      ->description(
          "Case file, or a folder with case.yaml; its Young's modulus must be the one derived from the measured pull");
  verb->add_option("--calibration", a.calibration, "calibration.json of `incise calibrate --method fit`")->required();
}

}  // namespace incise::cli
