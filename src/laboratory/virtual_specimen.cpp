#include "laboratory/virtual_specimen.hpp"

#include <incise/bench_studies/planned_bench_cut.hpp>
#include <incise/core/defaults.hpp>
#include <incise/core/error.hpp>
#include <incise/core/units.hpp>
#include <incise/laboratory/bench_files.hpp>
#include <incise/virtual_bench/course.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise::laboratory {
namespace {

constexpr const char* kCutTruth = "The truth about a virtual cut, for tests. No part of it may reach a planner.";

double mean_abs(const std::vector<double>& errors) {
  double mean = 0.0;
  for (const double e : errors) mean += std::abs(e) / static_cast<double>(errors.size());
  return mean;
}

class FirstSpecimen : public VirtualSpecimen {
 public:
  FirstSpecimen(const Specimen& specimen, Workers& workers, Monitor& monitor)
      : body_(make_body(specimen, {}, workers, monitor)) {}

  bool is_held(Monitor& monitor) const override { return is_stretched(body_, monitor); }
  nlohmann::ordered_json file() const override { return incise::specimen_json(body_.specimen); }
  Readings readings(bool has_elasticity, Monitor& monitor) const override {
    return take_readings(body_, has_elasticity, monitor);
  }
  nlohmann::ordered_json prescription() const override { return nullptr; }
  void write_truth(const std::filesystem::path& folder) const override { incise::write_truth(folder, body_); }
  std::vector<TipPose> course(const std::vector<TipPose>& asked) const override {
    return tip_course(asked, body_.specimen, T_robot_specimen(placement_of(body_.specimen)).inverse());
  }
  std::optional<std::string> misfit(const std::vector<TipPose>& course) const override {
    return find_misfit(body_, course);
  }
  std::optional<PhotographedCut> cut(const std::vector<TipPose>& course, double power_w,
                                     const PhotographSettings& settings, Workers& workers,
                                     Monitor& monitor) const override {
    const BenchCut made = cut_specimen(body_, course, power_w, workers, monitor);
    if (made.outcome == Outcome::NotConverged) return std::nullopt;
    return PhotographedCut{photograph(body_, made, settings), truth_of(body_, made)};
  }

 private:
  BenchBody body_;
};

class SecondSpecimen : public VirtualSpecimen {
 public:
  SecondSpecimen(const second_bench::Specimen& specimen, Monitor& monitor)
      : body_(second_bench::make_body(specimen, {}, monitor)) {}

  bool is_held(Monitor& monitor) const override {
    if (body_.outcome == Outcome::Success) return true;
    monitor.message(Severity::Warning, fmt::format("the specimen could not be stretched: {}, residual {:.2g}",
                                                   to_string(body_.outcome), body_.residual));
    return false;
  }
  nlohmann::ordered_json file() const override { return incise::specimen_json(body_.specimen); }
  Readings readings(bool has_elasticity, Monitor& monitor) const override {
    if (has_elasticity)
      throw CaseError("command line", "--elasticity", "a specimen of the second laboratory", "one of the first",
                      "It has no elastography.");
    return take_readings(body_, monitor);
  }
  nlohmann::ordered_json prescription() const override {
    const second_bench::Specimen& specimen = body_.specimen;
    const double start = units::rad_from_deg(specimen.start_deg);
    return {{"lateral_margin_mm", specimen.margin_mm},
            {"depth_mm", specimen.depth_mm},
            {"speed_mm_s", specimen.speed_mm_s},
            {"power_w", prescribed_power_w(specimen)},
            {"start_direction", {std::sin(start), -std::cos(start), 0.0}}};
  }
  void write_truth(const std::filesystem::path& folder) const override { incise::write_truth(folder, body_); }
  std::vector<TipPose> course(const std::vector<TipPose>& asked) const override {
    return tip_course(asked, body_.specimen, T_robot_specimen(placement_of(body_.specimen)).inverse());
  }
  std::optional<std::string> misfit(const std::vector<TipPose>& course) const override {
    const SeenTissue seen = seen_from_above(*body_.state);
    return find_misfit({.vertices = seen.vertices, .triangles = seen.triangles}, seen.tumor_edge, -Vec3::UnitZ(),
                       course);
  }
  std::optional<PhotographedCut> cut(const std::vector<TipPose>& course, double power_w,
                                     const PhotographSettings& settings, Workers&, Monitor& monitor) const override {
    const second_bench::Cut made = cut_specimen(body_, course, power_w, monitor);
    if (made.outcome == Outcome::NotConverged) return std::nullopt;
    nlohmann::ordered_json truth;
    truth["note"] = kCutTruth;
    const double target_mm = body_.specimen.margin_mm - kElectrodeRadiusMm;
    const auto errors = true_errors_mm(made, target_mm);
    truth["outcome"] = to_string(errors ? Outcome::Success : Outcome::OpenLoop);
    truth["target_mm"] = target_mm;
    if (errors) {
      truth["mean_abs_error_mm"] = mean_abs(*errors);
      truth["signed_errors_mm"] = *errors;
    }
    truth["mean_needle_force_mn"] = made.mean_force_mn;
    truth["most_needle_force_mn"] = made.max_force_mn;
    truth["voxels_parted_by_heat"] = made.parted_by_heat;
    truth["voxels_parted_by_force"] = made.parted_by_force;
    truth["steps"] = made.steps;
    truth["iterations"] = made.iterations;
    truth["residual"] = made.residual;
    return PhotographedCut{photograph(body_, made, settings), truth};
  }

 private:
  second_bench::Body body_;
};

}  // namespace

/// A specimen that cannot be held and stretched is a result, not an error: nothing is read or cut.
bool is_stretched(const BenchBody& body, Monitor& monitor) {
  if (body.inverted_tets > 0)
    monitor.message(Severity::Detail,
                    fmt::format("{} tets of the stretched specimen are turned inside out", body.inverted_tets));
  if (body.outcome != Outcome::NotConverged) return true;
  monitor.message(Severity::Warning, fmt::format("the specimen could not be stretched: {}, residual {:.2g}",
                                                 to_string(body.outcome), body.equilibrium_residual));
  return false;
}

nlohmann::ordered_json truth_of(const BenchBody& body, const BenchCut& cut) {
  nlohmann::ordered_json json;
  json["note"] = kCutTruth;
  json["outcome"] = to_string(cut.outcome);
  json["target_mm"] = kInnerEdgeTargetMm;
  if (cut.inner_edge) {
    const std::vector<double> errors = true_errors_mm(body, cut, kInnerEdgeTargetMm);
    json["mean_abs_error_mm"] = mean_abs(errors);
    json["signed_errors_mm"] = errors;
  }
  json["bulge_mm"] = cut.bulge_mm;
  json["thermal_width_mm"] = cut.thermal_width_mm;
  json["mean_drag_force_mn"] = cut.mean_force_mn;
  json["removed_tets"] = cut.removed_tets;
  return json;
}

std::unique_ptr<const VirtualSpecimen> specimen_of(const std::filesystem::path& file,
                                                   const steps::StepContext& context) {
  if (bench_of(file) == 2) return std::make_unique<SecondSpecimen>(read_second_specimen(file), context.monitor);
  return std::make_unique<FirstSpecimen>(read_specimen(file), context.workers, context.monitor);
}

std::unique_ptr<const VirtualSpecimen> specimen_of(const MakeSpecimenRequest& request,
                                                   const steps::StepContext& context) {
  const auto refuse = [](const char* option, const char* found, const char* expected) {
    throw CaseError("command line", option, found, expected);
  };
  if (!request.specimen.empty()) {
    if (request.bench && *request.bench != bench_of(request.specimen))
      refuse("--bench", "a specimen file of the other laboratory", "no --bench: the file's schema determines it");
    if (request.factors || request.series)
      refuse(request.factors ? "--factors" : "--series", "a specimen file", "a specimen drawn from the seed");
    return specimen_of(request.specimen, context);
  }
  if (request.bench.value_or(1) == 1) {
    if (request.factors || request.series)
      refuse(request.factors ? "--factors" : "--series", "the first laboratory", "--bench 2");
    return std::make_unique<FirstSpecimen>(draw_specimen(context.run.seed), context.workers, context.monitor);
  }
  const std::uint64_t seed = context.run.seed;
  return std::make_unique<SecondSpecimen>(
      second_bench::draw_specimen(seed, request.series.value_or(seed),
                                  request.factors.value_or(second_bench::all_factors())),
      context.monitor);
}

}  // namespace incise::laboratory
