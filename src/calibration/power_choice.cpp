#include <incise/calibration/power_choice.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

namespace incise {
namespace {

using CutsOfOnePower = std::vector<const PowerCut*>;

void require_measure(const PowerCut& cut, const std::optional<double>& value, const char* name) {
  INCISE_REQUIRE(
      !value || (std::isfinite(*value) && *value >= 0.0),
      fmt::format("{} at {} W: expected {} of at least 0, found {}", cut.specimen, cut.power_w, name, *value));
  INCISE_REQUIRE(value || cut.outcome != Outcome::Success,
                 fmt::format("{} at {} W: expected {} of a closed ring, found none", cut.specimen, cut.power_w, name));
}

void require_usable(const PowerCut& cut, double speed_mm_s) {
  INCISE_REQUIRE(std::isfinite(cut.power_w) && cut.power_w > 0.0,
                 fmt::format("{}: expected a power above 0 W, found {}", cut.specimen, cut.power_w));
  INCISE_REQUIRE(cut.speed_mm_s == speed_mm_s && std::isfinite(speed_mm_s) && speed_mm_s > 0.0,
                 fmt::format("{} at {} W: expected one speed above 0 mm/s in all cuts, found {} and {}", cut.specimen,
                             cut.power_w, speed_mm_s, cut.speed_mm_s));
  require_measure(cut, cut.bulge_mm, "a bulge");
  require_measure(cut, cut.thermal_width_mm, "a thermal width");
}

std::set<std::string> specimens_of(const CutsOfOnePower& cuts) {
  std::set<std::string> names;
  for (const PowerCut* cut : cuts) names.insert(cut->specimen);
  return names;
}

/// The cuts by power, ascending.
std::map<double, CutsOfOnePower> by_power(std::span<const PowerCut> cuts) {
  std::map<double, CutsOfOnePower> powers;
  for (const PowerCut& cut : cuts) {
    require_usable(cut, cuts.front().speed_mm_s);
    powers[cut.power_w].push_back(&cut);
  }
  const std::set<std::string> specimens = specimens_of(powers.begin()->second);
  for (const auto& [power_w, of_power] : powers) {
    INCISE_REQUIRE(
        of_power.size() == specimens.size() && specimens_of(of_power) == specimens,
        fmt::format("{} W: expected the same specimens as at {} W, each once", power_w, powers.begin()->first));
  }
  return powers;
}

/// Returns the cut with the greatest value; cuts without it do not count. Null: no cut has it.
const PowerCut* find_greatest(const CutsOfOnePower& cuts, std::optional<double> PowerCut::*value) {
  const PowerCut* greatest = nullptr;
  for (const PowerCut* cut : cuts) {
    if (cut->*value && (greatest == nullptr || *(cut->*value) > *(greatest->*value))) greatest = cut;
  }
  return greatest;
}

std::string reason_against(const PowerCut& cut) {
  if (!cut.problem.empty()) return fmt::format("{}: {}", cut.specimen, cut.problem);
  if (cut.outcome == Outcome::OpenLoop) return fmt::format("{}: the ring stays open", cut.specimen);
  return fmt::format("{}: the cut {}", cut.specimen, in_words(cut.outcome));
}

PowerVerdict judge(double power_w, const CutsOfOnePower& cuts, const PowerLimits& limits) {
  PowerVerdict verdict;
  verdict.power_w = power_w;
  for (const PowerCut* cut : cuts) {
    if (cut->outcome != Outcome::Success) verdict.reasons.push_back(reason_against(*cut));
  }
  if (const PowerCut* most = find_greatest(cuts, &PowerCut::bulge_mm)) {
    verdict.greatest_bulge_mm = most->bulge_mm;
    if (*most->bulge_mm > limits.bulge_limit_mm) {
      verdict.reasons.push_back(fmt::format("{}: skin bulges by {:.2f} mm, more than {} mm", most->specimen,
                                            *most->bulge_mm, limits.bulge_limit_mm));
    }
  }
  if (const PowerCut* most = find_greatest(cuts, &PowerCut::thermal_width_mm)) {
    verdict.greatest_thermal_width_mm = most->thermal_width_mm;
    if (*most->thermal_width_mm > limits.damage_limit_mm) {
      verdict.reasons.push_back(fmt::format("{}: heat reaches {:.2f} mm beside the tool, more than {} mm",
                                            most->specimen, *most->thermal_width_mm, limits.damage_limit_mm));
    }
  }
  return verdict;
}

}  // namespace

PowerChoice choose_power(std::span<const PowerCut> cuts, const PowerLimits& limits) {
  INCISE_REQUIRE(!cuts.empty(), "expected at least one cut, found none");
  require_none(problems_of(limits));
  PowerChoice choice;
  for (const auto& [power_w, of_power] : by_power(cuts)) {
    choice.powers.push_back(judge(power_w, of_power, limits));
    if (!choice.chosen_w && choice.powers.back().reasons.empty()) choice.chosen_w = power_w;
  }
  return choice;
}

}  // namespace incise
