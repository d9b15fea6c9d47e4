#include "comparison_output.hpp"
#include "comparison_tables.hpp"
#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/storage/evaluation_file.hpp>

#include <fmt/format.h>

#include <set>

namespace incise::cli {
namespace {

struct CompareArguments {
  std::vector<std::filesystem::path> before;
  std::vector<std::filesystem::path> after;
  std::string measure = "absolute";
  ComparisonSettings settings;
};

std::vector<EvaluationFile> read_all(const std::vector<std::filesystem::path>& paths) {
  std::vector<EvaluationFile> files;
  for (const auto& path : paths) files.push_back(read_evaluation_file(path));
  return files;
}

/// Like is compared with like: the same line of the cut, against the same target, with the same zones.
void require_alike(const CompareArguments& arguments, const ComparedFiles& files) {
  const EvaluationFile& first = files.before.front();
  const auto check = [&](const std::filesystem::path& path, const EvaluationFile& file) {
    const auto refuse = [&](const char* key, const std::string& found, const std::string& expected) {
      throw DataError(path, key, found, fmt::format("{} as in {}", expected, arguments.before.front().string()),
                      "Only like is compared with like");
    };
    if (file.contour != first.contour)
      refuse("contour", std::string(to_string(file.contour)), std::string(to_string(first.contour)));
    if (file.target_mm != first.target_mm) {
      refuse("target_mm", fmt::format("{}", file.target_mm), fmt::format("{}", first.target_mm));
    }
  };
  for (std::size_t i = 0; i < arguments.before.size(); ++i) check(arguments.before[i], files.before[i]);
  for (std::size_t i = 0; i < arguments.after.size(); ++i) check(arguments.after[i], files.after[i]);
}

/// A file that stands for two specimens would make two of one.
void require_different(const CompareArguments& arguments) {
  std::set<std::filesystem::path> seen;
  for (const auto* side : {&arguments.before, &arguments.after}) {
    for (const auto& path : *side) {
      if (!seen.insert(std::filesystem::weakly_canonical(path)).second) {
        throw CaseError("command line", side == &arguments.before ? "--before" : "--after", path.string() + " again",
                        "every evaluation once");
      }
    }
  }
}

/// For a person: the two means and the tests, one a line.
void print_tests(const nlohmann::ordered_json& json) {
  const auto mean = [&](const char* key) {
    return json[key].is_number() ? fmt::format("{:.3f} mm", json[key].get<double>()) : std::string("-");
  };
  fmt::print("mean {} error by point: before {}, after {}\n\n", json["measure"].get<std::string>(),
             mean("mean_before_mm"), mean("mean_after_mm"));
  const TextTable tests = test_table(json);
  constexpr const char* kLine = "{:<36} {:>8} {:>9} {:>8} {:>14} {:>24}  {}\n";
  const auto print = [&](const std::vector<std::string>& r) {
    fmt::print(kLine, r[0], r[1], r[2], r[3], r[4], r[5], r[6]);
  };
  print(tests.header);
  for (const auto& row : tests.rows) print(row);
  for (const auto& left_out : json["left_out"]) {
    fmt::print("left out, no incision was found: {}\n", left_out["name"].get<std::string>());
  }
  if (const auto& specimens = json["specimens"]; specimens.is_object() && specimens["fewest_specimens"].is_number()) {
    fmt::print("\nspecimens in each group (or pairs) that would show this effect: {}\n",
               specimens["fewest_specimens"].get<long>());
  }
  fmt::print("every figure: --json, or compare.json in the folder that -o names\n");
}

int run(const CompareArguments& given, const CommonOptions& options) {
  CompareArguments arguments = given;
  arguments.settings.measure = value_named<ErrorMeasure>(arguments.measure);
  arguments.settings.bootstrap.seed = options.seed;
  require_valid(validate(arguments.settings));
  if (arguments.settings.is_paired && arguments.before.size() != arguments.after.size()) {
    throw CaseError("command line", "--paired",
                    fmt::format("{} before and {} after", arguments.before.size(), arguments.after.size()),
                    "as many before as after, in the same order");
  }
  require_different(arguments);
  std::vector<std::filesystem::path> inputs = arguments.before;
  inputs.insert(inputs.end(), arguments.after.begin(), arguments.after.end());
  refuse_input_as_output("-o", options.output, inputs);
  ComparedFiles files{read_all(arguments.before), read_all(arguments.after)};
  require_alike(arguments, files);
  ComparisonOutput output = compared(std::move(files), arguments.settings);
  if (!options.output.empty()) write_comparison(options.output, output, inputs, options.context(), options.wall_s());
  options.json ? print_result(options, output.json) : print_tests(output.json);
  // Where a whole side holds no incision nothing was compared.
  return output.json["points"].is_null() ? kNotAcceptable : kDone;
}

}  // namespace

void add_compare(Application& application) {
  auto [verb, a] = application.add_verb<CompareArguments>(
      "compare", "", "incise compare --before s1.json s2.json --after s3.json s4.json -o comparison", run);
  verb->add_option("--before", a.before, "Files of `incise evaluate -o`, one for each specimen")->required();
  verb->add_option("--after", a.after, "The same, after the change")->required();
  verb->add_option("--measure", a.measure, "Which error")->check(name_of_any<ErrorMeasure>());
  verb->add_flag("--paired", a.settings.is_paired,
                 "The n-th file before and the n-th file after are the same specimen");
  verb->add_option("--alpha", a.settings.alpha, "Level of the tests; intervals are at 1 - alpha");
  verb->add_option("--power", a.settings.power, "Chance to see the effect that is wanted of the next experiment");
  verb->add_option("--replicates", a.settings.bootstrap.replicates, "Of the block bootstrap")
      ->check(CLI::Range(99, 1000000));
}

}  // namespace incise::cli
