#include "described_options.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/steps/comparison_tables.hpp>
#include <incise/steps/cut_steps.hpp>

#include <fmt/format.h>

#include <set>

namespace incise::cli {
namespace {

/// Refuses a file that is given twice: it would count as two specimens.
void require_different(const steps::CompareRequest& arguments) {
  std::set<std::filesystem::path> seen;
  for (const auto* side : {&arguments.before, &arguments.after}) {
    for (const auto& path : *side) {
      if (!seen.insert(std::filesystem::weakly_canonical(path)).second) {
        throw CaseError("command line", side == &arguments.before ? "--before" : "--after", path.string() + " twice",
                        "each evaluation once");
      }
    }
  }
}

/// Prints the two means and the tests for a person, one per line.
void print_tests(const steps::CutComparison& found) {
  const auto mean = [&](const SampleMoments PooledTests::*side) {
    return found.points ? fmt::format("{:.3f} mm", ((*found.points).*side).mean) : std::string("-");
  };
  fmt::print("mean {} error by point: before {}, after {}\n\n", to_string(found.measure), mean(&PooledTests::before),
             mean(&PooledTests::after));
  const TextTable tests = steps::test_table(found);
  constexpr const char* kLine = "{:<36} {:>8} {:>9} {:>8} {:>14} {:>24}  {}\n";
  const auto print = [&](const std::vector<std::string>& r) {
    fmt::print(kLine, r[0], r[1], r[2], r[3], r[4], r[5], r[6]);
  };
  print(tests.header);
  for (const auto& row : tests.rows) print(row);
  for (const steps::LeftOut& one : found.left_out) fmt::print("left out, no incision was found: {}\n", one.name);
  if (found.specimens && found.specimens->fewest)
    fmt::print("\nspecimens in each group (or pairs) that would show this effect: {}\n", *found.specimens->fewest);
  fmt::print("all numbers: --json, or compare.json in the folder that -o names\n");
}

int run_compare(steps::CompareRequest request, const CommonOptions& options) {
  request.output = options.output;
  request.settings.bootstrap.seed = options.seed;
  require_valid(validate(request.settings));
  if (request.settings.is_paired && request.before.size() != request.after.size()) {
    throw CaseError("command line", "--paired",
                    fmt::format("{} before and {} after", request.before.size(), request.after.size()),
                    "as many before as after, in the same order");
  }
  require_different(request);
  std::vector<std::filesystem::path> inputs = request.before;
  inputs.insert(inputs.end(), request.after.begin(), request.after.end());
  refuse_input_as_output("-o", options.output, inputs);
  steps::CutComparison found;
  return run_step(
      options,
      [&](const auto& context) {
        steps::CompareResult done = steps::compare_cuts(request, context);
        found = std::move(done.found);
        return std::move(done.step);
      },
      [&](const nlohmann::ordered_json&) { print_tests(found); });
}

}  // namespace

void add_compare(Application& application) {
  auto [verb, a] = application.add_verb<steps::CompareRequest>(
      "compare", "", "incise compare --before s1.json s2.json --after s3.json s4.json -o comparison", run_compare);
  describe_output(*verb, kNothingByDefault);
  verb->add_option("--before", a.before,
                   "Files of `incise evaluate -o` for the cuts before the change, one for each specimen")
      ->required();
  verb->add_option("--after", a.after,
                   "Files of `incise evaluate -o` for the cuts after the change, one for each specimen")
      ->required();
  verb->add_flag("--paired", a.settings.is_paired,
                 "The n-th file before and the n-th file after are of the same specimen");
  add_options_of(*verb, a.settings, "measure", "alpha", "power", "replicates");
}

}  // namespace incise::cli
