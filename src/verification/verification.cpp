#include "verification/check.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace incise {
namespace {

VerificationCheck run_one(const CheckEntry& entry, double tolerance_scale, const CheckContext& context) {
  const auto began = std::chrono::steady_clock::now();
  VerificationCheck check;
  try {
    check = entry.run(context);
  } catch (const NotSolved& error) {
    check = described(entry.name, "", "-", 0.0, 0.0);
    check.found = std::numeric_limits<double>::quiet_NaN();
    check.note = error.what();
  }
  check.name = entry.name;
  check.tolerance *= tolerance_scale;
  check.passed = is_met(check);
  check.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return check;
}

}  // namespace

bool is_met(const VerificationCheck& check) {
  if (!std::isfinite(check.found) || !std::isfinite(check.expected)) return false;
  if (check.criterion == Criterion::AtLeast) return check.found >= check.expected - check.tolerance;
  return std::abs(check.found - check.expected) <= check.tolerance;
}

std::vector<std::string> physics_check_names() {
  std::vector<std::string> names;
  for (const CheckEntry& entry : check_table()) names.push_back(entry.name);
  return names;
}

std::vector<VerificationCheck> run_checks(const VerificationSettings& settings, Workers& workers, Monitor& monitor) {
  INCISE_REQUIRE(std::isfinite(settings.tolerance_scale) && settings.tolerance_scale >= 0.0,
                 fmt::format("expected a tolerance scale of at least 0, found {}", settings.tolerance_scale));
  std::vector<const CheckEntry*> chosen;
  for (const CheckEntry& entry : check_table()) {
    if (entry.name.starts_with(settings.only)) chosen.push_back(&entry);
  }
  INCISE_REQUIRE(!chosen.empty(),
                 fmt::format("expected the name of a check or the start of one, found '{}'", settings.only));
  StopOnly inner(monitor);  // hides the progress of solvers inside a check
  const CheckContext context{workers, inner};
  std::vector<VerificationCheck> checks;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    throw_if_cancelled(monitor, "verifying");
    monitor.progress("verifying", static_cast<double>(i) / static_cast<double>(chosen.size()));
    monitor.message(Severity::Notice, fmt::format("check {} of {}: {}", i + 1, chosen.size(), chosen[i]->name));
    checks.push_back(run_one(*chosen[i], settings.tolerance_scale, context));
  }
  monitor.progress("verifying", 1.0);
  return checks;
}

}  // namespace incise
