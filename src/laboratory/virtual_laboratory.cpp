#include "laboratory/virtual_laboratory.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/laboratory/bench_files.hpp>
#include <incise/laboratory/bench_steps.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace incise::laboratory {

std::vector<std::string> names_of_factors(const second_bench::Factors& factors) {
  std::vector<std::string> names;
  for (const second_bench::Factor factor : factors) names.emplace_back(to_string(factor));
  return names;
}

StepAnswer VirtualLaboratory::take_readings(const std::filesystem::path& folder) {
  std::vector<std::string> arguments{"bench", "make"};
  std::vector<std::filesystem::path> inputs;
  MakeSpecimenRequest request{.output = folder, .truth = hidden_.truth};
  make_folder(hidden_.truth.parent_path());
  const bool is_first = hidden_.bench == 1;
  if (!hidden_.given.empty()) {
    nlohmann::ordered_json specimen;
    if (is_first) {
      specimen = {{"schema", "incise.specimen/1"}, {"seed", hidden_.seed}};
    } else {
      specimen = incise::specimen_json(second_bench::draw_specimen(hidden_.seed, hidden_.series, hidden_.factors));
    }
    for (const auto& [key, value] : hidden_.given) specimen[key] = value;
    request.specimen = hidden_.truth.string() + ".json";
    write_json(request.specimen, specimen);
    arguments.push_back(request.specimen.string());
    inputs.push_back(request.specimen);
  } else if (!is_first) {
    request.bench = hidden_.bench;
    request.series = hidden_.series;
    arguments.insert(arguments.end(),
                     {"--bench", std::to_string(hidden_.bench), "--series", std::to_string(hidden_.series)});
    if (hidden_.factors != second_bench::all_factors()) {
      request.factors = hidden_.factors;
      const std::vector<std::string> names = names_of_factors(hidden_.factors);
      arguments.insert(arguments.end(),
                       {"--factors", names.empty() ? "none" : fmt::format("{}", fmt::join(names, ","))});
    }
  }
  arguments.insert(arguments.end(),
                   {"--seed", std::to_string(hidden_.seed), "-o", folder.string(), "--truth", hidden_.truth.string()});
  const std::uint64_t seed = hidden_.seed;
  return steps_.run({"bench_make", arguments, inputs, {folder, hidden_.truth}, [=](const steps::StepContext& context) {
                       steps::StepContext of_seed = context;
                       of_seed.run.seed = seed;
                       return make_specimen(request, of_seed);
                     }});
}

StepAnswer VirtualLaboratory::cut(const std::filesystem::path& program, double power_w,
                                  const std::filesystem::path& folder, const std::string& tag) {
  const CutSpecimenRequest request{.specimen = specimen(),
                                   .program = program,
                                   .power_w = power_w,
                                   .output = folder,
                                   .truth = hidden_.truth.string() + "_" + tag};
  return steps_.run({tag + "_bench_cut",
                     {"bench", "cut", request.specimen.string(), program.string(), "--power-w",
                      fmt::format("{}", power_w), "-o", folder.string(), "--truth", request.truth.string()},
                     {request.specimen, program},
                     {folder / "photo.png", request.truth / "cut_truth.json"},
                     [=](const steps::StepContext& context) { return cut_specimen_by(request, context); }});
}

StepAnswer VirtualLaboratory::known_physics() {
  const KnownPhysicsRequest request{.specimen = specimen(), .output = hidden_.truth.string() + "_floor.json"};
  return steps_.run({"known_physics",
                     {"bench", "floor", request.specimen.string(), "-o", request.output.string()},
                     {request.specimen},
                     {request.output},
                     [=](const steps::StepContext& context) { return cut_by_known_physics(request, context); }});
}

}  // namespace incise::laboratory
