#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/line_plot.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/names.hpp>
#include <incise/core/workers.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// The condition under which a check passes.
enum class Criterion {
  Within,   ///< |found - expected| <= tolerance
  AtLeast,  ///< found >= expected - tolerance
};
inline constexpr std::array<std::string_view, 2> kCriterionNames{"within", "at_least"};
[[nodiscard]] constexpr Names names_of(Criterion) {
  return kCriterionNames;
}

/// One question with a known answer, put to the solver on this machine.
struct VerificationCheck {
  std::string name;    ///< lower_case, stable
  std::string what;    ///< the question, in one sentence; `name` if the solver gave up
  std::string source;  ///< where the expected value comes from
  std::string unit;    ///< of expected, found and tolerance; "-": a ratio
  double expected = 0.0;
  double found = 0.0;  ///< NaN if the solver gave up (`note` says why) or values did not converge
  double tolerance = 0.0;
  Criterion criterion = Criterion::Within;
  bool passed = false;
  double wall_s = 0.0;
  std::string note;  ///< further values, or why the solver gave up; may be empty
  LinePlot plot;     ///< lines: known values; marks: values found; all are finite
};

inline void describe(Visitor& v, VerificationCheck& c) {
  v("name", c.name, "Name of the check; lower case, stable.");
  v("passed", c.passed, "Whether the criterion is met.");
  v("expected", c.expected, "Known value.");
  std::optional<double> found = if_finite(c.found);
  v("found", found, "Value that the solver found; absent if the solver gave up or values did not converge.");
  if (v.sets()) c.found = found.value_or(std::numeric_limits<double>::quiet_NaN());
  v("tolerance", c.tolerance, "Tolerance of the criterion.");
  v("criterion", c.criterion, "Condition under which the check passes.");
  v("unit", c.unit, "Unit of expected, found and tolerance.");
  v("what", c.what, "What the check compares, in one sentence.");
  v("source", c.source, "Source of the expected value.");
  v("note", c.note, "Further values, or why the check failed.");
  v({"wall_s", "Duration of the check.", "s"}, c.wall_s);
}

struct VerificationSettings {
  std::string only;              ///< runs the checks whose name starts with this; empty: all
  double tolerance_scale = 1.0;  ///< >= 0, multiplies every tolerance; 0 shows the true residuals
};

/// Returns the names of all checks, in the order in which they run.
[[nodiscard]] std::vector<std::string> physics_check_names();

/// Runs the checks that settings.only selects, one after the other, each on all workers. Reads no files: every body is
/// made here. If the solver gives up, the check fails, without an exception. Reports progress as stage "verifying", and
/// a Notice with the name as each check starts.
/// @throws InvalidArgument if no name matches or the scale is negative or not finite; Cancelled on request.
/// @note About a minute on two cores. docs/verification.md explains each check.
[[nodiscard]] std::vector<VerificationCheck> run_checks(const VerificationSettings& settings, Workers& workers,
                                                        Monitor& monitor);

/// Returns whether `found` satisfies the check's criterion; false if `found` or `expected` is not finite.
[[nodiscard]] bool is_met(const VerificationCheck& check);

}  // namespace incise
