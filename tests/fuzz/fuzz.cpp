// Removes tets at random and drives the tool along random paths; see README.md.
#include "fuzz/fuzz_bodies.hpp"
#include "fuzz/fuzz_paths.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/cutting/cut_invariants.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <map>
#include <string_view>

namespace incise::testing {
namespace {

struct Options {
  std::uint64_t seed = 1;
  std::size_t removals = 100000;  // over all bodies
  int paths = 200;
  int threads = 0;  // all
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    INCISE_REQUIRE(i + 1 < argc, fmt::format("expected a number after {}", name));
    const std::string_view text = argv[i + 1];
    long value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    INCISE_REQUIRE(problem == std::errc() && end == text.data() + text.size() && value >= 0,
                   fmt::format("{}: found {}, expected a whole number, 0 or more", name, text));
    if (name == "--seed") {
      options.seed = static_cast<std::uint64_t>(value);
    } else if (name == "--removals") {
      options.removals = static_cast<std::size_t>(value);
    } else if (name == "--paths") {
      options.paths = static_cast<int>(value);
    } else if (name == "--threads") {
      options.threads = static_cast<int>(value);
    } else {
      throw InvalidArgument(fmt::format("expected --seed, --removals, --paths or --threads, found {}", name));
    }
  }
  return options;
}

/// Says what does not hold. @returns how much.
std::size_t report_violations(const std::string& where, const TissueModel& model, const CutState& state) {
  const std::vector<std::string> violations = cut_invariants(model, state);
  for (const std::string& violation : violations) fmt::print("FAILED {}: {}\n", where, violation);
  return violations.size();
}

struct Tally {
  std::size_t removed = 0;
  std::size_t failures = 0;
};

/// Takes `count` tets away in batches of 1 to 60, some of them neighbours; when a body is used up, a fresh one follows.
Tally remove_at_random(const FuzzBody& body, std::size_t count, Random& random) {
  Workers alone(1);
  CutSettings settings;
  const ToolPose far{bounding_box(body.model.mesh.vertices).max() + Vec3::Constant(500.0)};
  Tally tally;
  while (tally.removed < count && tally.failures == 0) {
    CutState state = begin_cut(body.model, rest_state(body.model), far);
    CutWorkspace workspace(body.model, state.tissue.positions);
    const std::size_t tets = body.model.mesh.tets.size();
    while (state.record.removals.size() < tets && tally.removed + state.record.removals.size() < count &&
           tally.failures == 0) {
      std::vector<TetId> batch;
      const std::size_t first = random.below(tets);
      const bool is_run = random.below(2) == 0;
      for (std::size_t i = random.below(60) + 1; i > 0; --i)
        batch.emplace_back(is_run ? (first + i) % tets : random.below(tets));
      remove_tets(body.model, state, workspace, batch);
      const CutStepReport report = advance(body.model, settings, Needle{}, state, workspace, far, 0.02, alone);
      if (!report.is_finite) {
        fmt::print("FAILED {}: step {} is not finite\n", body.name, state.step);
        ++tally.failures;
      }
      tally.failures += report_violations(fmt::format("{}, step {}", body.name, state.step), body.model, state);
    }
    tally.removed += state.record.removals.size();
  }
  return tally;
}

struct Ending {
  std::string name;
  std::size_t failures = 0;
};

/// One random cut, checked after every step, then once more as a whole.
Ending cut_at_random(const TissueModel& model, std::uint64_t seed) {
  const FuzzCut cut = random_cut(seed);
  const std::string name = fmt::format("path {} ({})", seed, cut.kind);
  Workers alone(1);
  Monitor silent;
  const ToolProgram program(cut.path, cut.settings.cut, cut.settings.tool);
  CutState state = begin_cut(model, rest_state(model), program.pose_at(0.0));
  CutWorkspace workspace(model, state.tissue.positions);
  std::size_t failures = 0;
  while (state.time_s < program.duration_s() - 1e-9 && failures == 0) {
    const double step_s = std::min(cut.settings.cut.step_s(), program.duration_s() - state.time_s);
    const CutStepReport report = advance(model, cut.settings.cut, cut.settings.tool, state, workspace,
                                         program.pose_at(state.time_s + step_s), step_s, alone);
    failures += report_violations(fmt::format("{}, step {}", name, state.step), model, state);
    if (report.is_finite) continue;
    fmt::print("FAILED {}: step {} is not finite\n", name, state.step);
    ++failures;
  }
  const IncisionResult result = simulate_incision(model, rest_state(model), cut.path, cut.settings, alone, silent);
  failures += report_violations(name + ", at the end", model, result.final_state);
  return {fmt::format("{}: {}", cut.kind, to_string(result.outcome)), failures};
}

/// Bodies side by side. @returns how much did not hold.
std::size_t remove_from_all(const Options& options, Workers& workers) {
  const char* data = std::getenv("INCISE_DATA_DIR");
  const std::vector<FuzzBody> bodies = fuzz_bodies(data == nullptr ? "" : data);
  std::vector<Tally> tallies(bodies.size());
  workers.for_each(bodies.size(), 1, [&](std::size_t b) {
    Random random(options.seed + b);
    tallies[b] = remove_at_random(bodies[b], (options.removals + bodies.size() - 1) / bodies.size(), random);
    fmt::print("{}: {} tets, {} removals, {} failures\n", bodies[b].name, bodies[b].model.mesh.tets.size(),
               tallies[b].removed, tallies[b].failures);
  });
  std::size_t failures = 0;
  for (const Tally& tally : tallies) failures += tally.failures;
  return failures;
}

/// Paths side by side. @returns how much did not hold.
std::size_t cut_all(const Options& options, Workers& workers) {
  const TissueModel block = fuzz_block();
  std::vector<Ending> endings(static_cast<std::size_t>(options.paths));
  std::atomic<std::size_t> done = 0;
  workers.for_each(endings.size(), 1, [&](std::size_t i) {
    endings[i] = cut_at_random(block, options.seed + i);
    if (++done % 10 == 0) fmt::print(stderr, "{} of {} paths\n", done.load(), options.paths);
  });
  std::map<std::string, int> counts;
  std::size_t failures = 0;
  for (const Ending& ending : endings) {
    ++counts[ending.name];
    failures += ending.failures;
  }
  for (const auto& [ending, count] : counts) fmt::print("{} {}\n", count, ending);
  return failures;
}

int run(const Options& options) {
  Workers workers(options.threads);
  std::size_t failures = options.removals > 0 ? remove_from_all(options, workers) : 0;
  failures += options.paths > 0 ? cut_all(options, workers) : 0;
  fmt::print("{} failures\n", failures);
  return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace incise::testing

int main(int argc, char** argv) {
  try {
    return incise::testing::run(incise::testing::parse(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "incise_fuzz: {}\n", error.what());
    return 1;
  }
}
