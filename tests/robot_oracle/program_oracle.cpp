// Random programs through the checks of collision and through an independent search; see README.md.
#include "arm_oracle.hpp"
#include "random_programs.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace incise::testing {
namespace {

constexpr double kNearContactMm = 0.5;  // the checks allow for what moves between two samples, the oracle does not
constexpr double kSameDistanceMm = 0.1;

struct Options {
  std::uint64_t seed = 1;
  std::size_t count = 200;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    INCISE_REQUIRE(i + 1 < argc, fmt::format("expected a number after {}", name));
    const std::string_view text = argv[i + 1];
    std::uint64_t value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    INCISE_REQUIRE(problem == std::errc() && end == text.data() + text.size(),
                   fmt::format("{}: found {}, expected a whole number", name, text));
    INCISE_REQUIRE(name == "--seed" || name == "--count", fmt::format("expected --seed or --count, found {}", name));
    (name == "--seed" ? options.seed : options.count) = value;
  }
  return options;
}

/// Where the limits are contact itself.
CheckSettings contact_settings() {
  CheckSettings settings;
  settings.must_be_ring = false;
  settings.arm_clearance_mm = settings.surface_clearance_mm = 0.0;
  settings.shaft_clearance_mm = settings.needle_clearance_mm = 0.0;
  return settings;
}

struct Tally {
  std::size_t colliding = 0, clear = 0, disagreements = 0, near_contact = 0, overestimates = 0;
  double widest_mm = 0.0;  ///< of a disagreement, from contact
};

/// @returns whether the oracle finds a collision
bool compare(std::size_t number, const RandomProgram& drawn, Tally& tally) {
  const CheckSettings settings = contact_settings();
  const ProgramChecks checks = check_program(drawn.program, drawn.path, settings, {.surface = &drawn.surface});
  const auto answers = ask_oracle(drawn.program, drawn.surface, settings);
  bool is_colliding = false;
  for (const ProgramCheck& check : checks.checks) {
    const auto at = answers.find(check.name);
    if (at == answers.end()) continue;
    const OracleAnswer& oracle = at->second;
    is_colliding = is_colliding || oracle.is_in_contact;
    if (check.passed == oracle.is_in_contact) {
      tally.widest_mm = std::max(tally.widest_mm, std::abs(check.value));
      const bool is_near = std::abs(check.value) <= kNearContactMm;
      (is_near ? tally.near_contact : tally.disagreements) += 1;
      if (!is_near)
        fmt::print("FAILED program {}: {} {:.3f} mm, the oracle finds {}: {}\n", number, check.name, check.value,
                   oracle.is_in_contact ? "contact" : "none", check.text);
    }
    if (!oracle.is_in_contact && check.value > oracle.least_mm + kSameDistanceMm) {
      ++tally.overestimates;
      fmt::print("FAILED program {}: {} {:.3f} mm, the oracle finds a place at {:.3f} mm: {}\n", number, check.name,
                 check.value, oracle.least_mm, check.text);
    }
  }
  return is_colliding;
}

int run(const Options& options) {
  constexpr double kLeastShare = 0.3;
  Random random(options.seed);
  Tally tally;
  for (std::size_t i = 0; i < options.count;) {
    const auto drawn = random_program(random);
    if (!drawn) continue;
    (compare(i, *drawn, tally) ? tally.colliding : tally.clear) += 1;
    ++i;
  }
  const double count = static_cast<double>(options.count);
  fmt::print("{} programs: {} colliding ({:.1f} %), {} clear ({:.1f} %)\n", options.count, tally.colliding,
             100.0 * static_cast<double>(tally.colliding) / count, tally.clear,
             100.0 * static_cast<double>(tally.clear) / count);
  fmt::print("{} disagreements beyond {} mm of contact, {} within it (widest {:.3f} mm); {} distances too large\n",
             tally.disagreements, kNearContactMm, tally.near_contact, tally.widest_mm, tally.overestimates);
  const bool is_mixed = static_cast<double>(std::min(tally.colliding, tally.clear)) >= kLeastShare * count;
  if (!is_mixed) fmt::print("FAILED: less than {:.0f} % of the programs collide, or are clear\n", 100.0 * kLeastShare);
  return tally.disagreements == 0 && tally.overestimates == 0 && is_mixed ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace incise::testing

int main(int argc, char** argv) {
  try {
    return incise::testing::run(incise::testing::parse(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return EXIT_FAILURE;
  }
}
