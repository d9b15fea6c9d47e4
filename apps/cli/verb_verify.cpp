#include "option_checks.hpp"
#include "options.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/nearest_name.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/report/line_plot.hpp>
#include <incise/verification/verification.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace incise::cli {
namespace {

struct VerifyArguments {
  VerificationSettings settings;
  std::filesystem::path figures;
};

void require_a_check(const std::string& only) {
  const std::vector<std::string> names = physics_check_names();
  if (std::any_of(names.begin(), names.end(), [&](const std::string& name) { return name.starts_with(only); })) return;
  throw CaseError("command line", "--only", fmt::format("'{}'", only),
                  fmt::format("the start of one of {}", fmt::join(names, ", ")), did_you_mean(only, names));
}

void print_table(const std::vector<VerificationCheck>& checks) {
  fmt::print("{:<34} {:>12} {:>12} {:>10}  {:<14} {:<7} {:>6}\n", "check", "expected", "found", "tolerance", "unit",
             "passed", "s");
  for (const VerificationCheck& check : checks) {
    const std::string expected =
        (check.criterion == Criterion::AtLeast ? ">= " : "") + fmt::format("{:.6g}", check.expected);
    fmt::print("{:<34} {:>12} {:>12.6g} {:>10.2g}  {:<14} {:<7} {:>6.2f}\n", check.name, expected, check.found,
               check.tolerance, check.unit, check.passed ? "yes" : "NO", check.wall_s);
    if (!check.what.empty()) fmt::print("    {}\n", check.what);
    if (!check.source.empty()) fmt::print("    source: {}\n", check.source);
    if (!check.note.empty()) fmt::print("    {}\n", check.note);
  }
}

int run_verify(const VerifyArguments& arguments, const CommonOptions& options) {
  require_a_check(arguments.settings.only);
  if (!options.output.empty()) require_writable(options.output);
  if (!arguments.figures.empty()) make_folder(arguments.figures);
  Console console(options.level());
  Workers workers(options.context().threads);
  const std::vector<VerificationCheck> checks = run_checks(arguments.settings, workers, console);
  if (!arguments.figures.empty()) {
    for (const VerificationCheck& check : checks) {
      if (!check.plot.series.empty())
        write_atomically(arguments.figures / (check.name + ".svg"), line_plot_svg(check.plot));
    }
  }
  const auto passed = std::ranges::count(checks, true, &VerificationCheck::passed);
  const bool is_passed = static_cast<std::size_t>(passed) == checks.size();
  double wall_s = 0.0;
  for (const VerificationCheck& check : checks) wall_s += check.wall_s;
  nlohmann::ordered_json result{{"passed", is_passed}, {"wall_s", wall_s}};
  result["checks"] = to_json(checks);
  if (!options.output.empty()) write_json(options.output, result);
  if (options.json) {
    print_result(options, result);
  } else {
    print_table(checks);
    fmt::print("\n{} of {} checks passed in {:.0f} s\n", passed, checks.size(), wall_s);
  }
  return is_passed ? kDone : kNotAcceptable;
}

}  // namespace

void add_verify(Application& application) {
  auto [verb, a] = application.add_verb<VerifyArguments>(
      "verify", "", "incise verify --only cantilever --figures figures", run_verify);
  describe_output(*verb, kNothingByDefault);
  verb->add_option("--only", a.settings.only, "Run only the checks whose name starts with this");
  verb->add_option("--figures", a.figures, "Folder for one SVG plot per check");
  verb->add_option("--tolerance-scale", a.settings.tolerance_scale,
                   "Multiplies every tolerance; 0 shows the true residuals")
      ->check(zero_or_more("--tolerance-scale"));
}

}  // namespace incise::cli
