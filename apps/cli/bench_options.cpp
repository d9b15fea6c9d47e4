#include "bench_options.hpp"

#include <incise/core/error.hpp>
#include <incise/robot/checks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace incise::cli {
namespace {

std::vector<std::string> factor_names() {
  std::vector<std::string> names(second_bench::kFactorNames.begin(), second_bench::kFactorNames.end());
  names.emplace_back("none");
  return names;
}

}  // namespace

void add_factors(CLI::App& verb, const std::string& meaning, const std::function<void(second_bench::Factors)>& take) {
  verb.add_option_function<std::vector<std::string>>(
          "--factors",
          [take](const std::vector<std::string>& given) {
            if (given.size() > 1 && std::find(given.begin(), given.end(), "none") != given.end())
              throw CaseError("command line", "--factors", "none and other names", "none alone, or names of factors");
            second_bench::Factors factors;
            for (const std::string& name : given)
              if (name != "none") factors.insert(*value_of<second_bench::Factor>(name));
            take(std::move(factors));
          },
          meaning)
      ->delimiter(',')
      ->check(CLI::IsMember(factor_names()));
}

void add_overrides(CLI::App& verb, std::vector<std::string>& overrides) {
  std::vector<std::string> checks;
  std::ranges::copy_if(check_names(), std::back_inserter(checks), can_be_overridden);
  verb.add_option("--override", overrides,
                  "Cut even if this check of the program fails, as with `incise export`: the tissue is virtual. Repeat "
                  "for each check")
      ->expected(1)
      ->take_all()
      ->check(CLI::IsMember(checks));
}

nlohmann::ordered_json run_in_folder(
    const CommonOptions& options, const char* example,
    const std::function<nlohmann::ordered_json(const std::filesystem::path&, const RunContext&, Workers&, Console&)>&
        work) {
  const std::filesystem::path root = options.required_output(example);
  try {
    Console console(options.level());
    Workers workers(options.threads);
    return work(root, options.context(), workers, console);
  } catch (const Cancelled& error) {
    throw StagesKept(error.what(), fmt::format("finished results are kept in {}", root.string()));
  }
}

}  // namespace incise::cli
