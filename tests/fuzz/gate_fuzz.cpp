// Tries to get a robot program past the verdict: whole runs of broken cases, and perturbed variants of their cuts, each held against an
// oracle of its own (the distance between kerf and tumour, triangle by triangle). And the other way round: sound cases have to be ok.
#include "cutting/kerf.hpp"

#include <incise/core/error.hpp>
#include <incise/core/random.hpp>
#include <incise/core/units.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/imaging/phantom.hpp>
#include <incise/workflow/cut_verdict.hpp>
#include <incise/workflow/study.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <limits>
#include <map>
#include <string_view>

namespace incise::testing {
namespace {

struct Options {
  std::uint64_t seed = 1;
  int runs = 3;        // of broken cases
  int variants = 60;   // of their cuts, and of the sound ones'
  int sound = 2;       // runs of sound cases
  int tets = 8000;     // of the broken runs
  int sound_tets = 40000;
  int threads = 2;
};

Options parse(int argc, char** argv) {
  Options options;
  const std::map<std::string_view, int*> numbers{
      {"--runs", &options.runs}, {"--variants", &options.variants},     {"--sound", &options.sound},
      {"--tets", &options.tets}, {"--sound-tets", &options.sound_tets}, {"--threads", &options.threads}};
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    INCISE_REQUIRE(i + 1 < argc, fmt::format("expected a number after {}", name));
    const std::string_view text = argv[i + 1];
    long value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    const auto found = numbers.find(name);
    INCISE_REQUIRE(
        problem == std::errc() && end == text.data() + text.size() && value >= 0 &&
            (name == "--seed" || found != numbers.end()),
        fmt::format(
            "{} {}: expected --seed, --runs, --variants, --sound, --tets, --sound-tets or --threads and a whole number",
            name, text));
    if (name == "--seed") {
      options.seed = static_cast<std::uint64_t>(value);
    } else {
      *found->second = static_cast<int>(value);
    }
  }
  return options;
}

/// A virtual specimen with inputs that may be broken.
class SpecimenInputs : public Inputs {
 public:
  explicit SpecimenInputs(const Phantom& phantom) : ct(phantom.ct), edge(phantom.tumor_edge), surface(phantom.tumor) {}
  CtVolume read_ct(Monitor&) override { return ct; }
  std::optional<Contour> read_tumor_edge() override { return edge; }
  std::optional<TriMesh> read_tumor_surface() override { return surface; }

  CtVolume ct;
  Contour edge;
  TriMesh surface;
};

// --- The oracle: plain distances, triangle by triangle, that share nothing with SurfaceQuery.

/// Squared distance of a point from a triangle: the least over its inside, its sides and its corners.
double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area > 0.0) {
    const Vec3 foot = p - normal.dot(p - a) / area * normal;
    const auto is_left = [&](const Vec3& from, const Vec3& to) { return (to - from).cross(foot - from).dot(normal) >= 0.0; };
    if (is_left(a, b) && is_left(b, c) && is_left(c, a)) return (p - foot).squaredNorm();
  }
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const Vec3 along = to - from;
    const double length = along.squaredNorm();
    const double share = length > 0.0 ? std::clamp((p - from).dot(along) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - from - share * along).squaredNorm());
  }
  return least;
}

double least_squared(const Points& points, const TriMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points) {
    for (const Triangle& t : mesh.triangles) {
      const Vec3& a = mesh.vertices[t[0].index()];
      if ((p - a).squaredNorm() > 400.0 && least < 100.0) continue;  // triangles are far shorter than 10 mm
      least = std::min(least, squared_distance(p, a, mesh.vertices[t[1].index()], mesh.vertices[t[2].index()]));
    }
  }
  return least;
}

/// Whether a closed surface goes round a point once: its solid angle, after Van Oosterom and Strackee (1983).
bool is_inside(const Vec3& p, const TriMesh& mesh) {
  double angle = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0].index()] - p, b = mesh.vertices[t[1].index()] - p, c = mesh.vertices[t[2].index()] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2.0 * units::kPi;
}

/// Least distance between kerf and tumour, mm; 0 where the one reaches into the other.
double oracle_mm(const TriMesh& kerf, const TriMesh& tumor) {
  for (const Vec3& p : kerf.vertices) {
    if (is_inside(p, tumor)) return 0.0;
  }
  return std::sqrt(std::min(least_squared(kerf.vertices, tumor), least_squared(tumor.vertices, kerf)));
}

// --- What is counted.

struct Tally {
  int runs = 0, variants = 0, sound = 0, sound_ok = 0, refused = 0, cautions = 0, ok = 0, near = 0, failures = 0;
  void note(VerdictStatus status) { ++(status == VerdictStatus::Ok ? ok : status == VerdictStatus::Caution ? cautions : refused); }
};

void fail(Tally& tally, const std::string& where, const std::string& what) {
  ++tally.failures;
  fmt::print("FAILED {}: {}\n", where, what);
}

constexpr double kOracleMm = 0.02;  // corners against faces both ways miss what two edges do to each other: less than this on these meshes

/// The one law: nothing nearer to the tumour than the close margin without a refusal, and no refusal for it without reason.
void hold_to_oracle(const std::string& where, const Verdict& verdict, double nearest_mm, double close_mm, Tally& tally) {
  tally.note(verdict.status());
  if (nearest_mm <= close_mm - kOracleMm) {
    ++tally.near;
    if (verdict.status() != VerdictStatus::Refused) fail(tally, where, fmt::format("kerf {:.3f} mm from the tumour, and the verdict is {}", nearest_mm, to_string(verdict.status())));
  }
  if (nearest_mm > close_mm + kOracleMm && verdict.has("tumor_distance")) fail(tally, where, fmt::format("refused by tumor_distance at {:.3f} mm", nearest_mm));
}

Vec3 random_direction(Random& random, bool is_flat) {
  const double angle = random.uniform(0.0, 2.0 * units::kPi);
  const double height = is_flat ? 0.0 : random.uniform(-1.0, 1.0);
  const double across = std::sqrt(1.0 - height * height);
  return {across * std::cos(angle), across * std::sin(angle), height};
}

void move(Points& points, const Vec3& by) {
  for (Vec3& p : points) p += by;
}

/// A case to run: that of `incise phantom`, then broken in one way.
struct BrokenCase {
  Case settings;
  std::string how = "nothing";
};

Case sound_case(int tets) {
  Case settings;
  settings.is_virtual = true;
  settings.meshing.tets = tets;
  settings.tumor_configuration = TumorConfiguration::Stretched;
  settings.frames = 0;
  settings.T_robot_sim = Mat4::Identity();
  return settings;
}

BrokenCase broken_case(int tets, SpecimenInputs& inputs, Random& random) {
  BrokenCase broken{sound_case(tets)};
  Case& c = broken.settings;
  switch (random.below(9)) {
    case 0: {
      const double by = random.uniform(0.5, 20.0);
      move(inputs.edge.points, by * random_direction(random, true));
      broken.how = fmt::format("contour shifted by {:.1f} mm", by);
      break;
    }
    case 1:
      for (Vec3& p : inputs.edge.points) p = Vec3(-p.x(), -p.y(), p.z());
      broken.how = "contour in RAS";
      break;
    case 2:
      for (Vec3& p : inputs.surface.vertices) p *= 1e-3;
      broken.how = "surface in metres";
      break;
    case 3: {
      const double by = random.uniform(0.5, 12.0);
      move(inputs.surface.vertices, by * random_direction(random, true));
      broken.how = fmt::format("surface shifted by {:.1f} mm", by);
      break;
    }
    case 4:
      c.plan.lateral_margin_mm = random.uniform(2.8, 5.0);
      broken.how = fmt::format("margin of {:.1f} mm", c.plan.lateral_margin_mm);
      break;
    case 5:
      c.plan.depth_mm = random.uniform(1.0, 9.0);
      broken.how = fmt::format("depth of {:.1f} mm", c.plan.depth_mm);
      break;
    case 6:
      c.cut.dullness = random.uniform(1.0, 30.0);
      c.cut.speed_mm_s = random.uniform(1.0, 17.0);
      broken.how = fmt::format("dullness {:.1f} at {:.1f} mm/s", c.cut.dullness, c.cut.speed_mm_s);
      break;
    case 7:
      c.material.youngs_modulus_kpa = std::exp(random.uniform(std::log(4.0), std::log(120.0)));
      broken.how = fmt::format("tissue of {:.1f} kPa", c.material.youngs_modulus_kpa);
      break;
    default:
      c.compensation.method = CompensationMethod::Paper;
      c.cut.overlap_mm = random.uniform(0.0, 8.0);
      broken.how = fmt::format("the paper's pass, overlap {:.1f} mm", c.cut.overlap_mm);
  }
  return broken;
}

Phantom specimen(std::uint64_t seed) {
  PhantomSettings settings{.seed = seed};
  Monitor silent;
  return make_phantom(settings, silent);
}

/// What a finished run leaves for its variants.
struct Finished {
  Case settings;
  Study study;
  TriMesh tumor;        // as the run had it, in the stretched tissue
  Contour edge;         // as drawn
  TriMesh drawn;        // the surface as drawn
};

/// @returns nothing where the case was refused before anything was cut, which is a way to be safe.
std::optional<Finished> run_case(const Case& settings, SpecimenInputs& inputs, Workers& workers) {
  Monitor silent;
  Cache cache;
  try {
    Finished done{settings, run_study(settings, inputs, cache, {}, workers, silent), {}, inputs.edge, inputs.surface};
    if (!verifying_cut(done.study)) return std::nullopt;
    done.tumor = tumor_in_stretched(settings, *done.study.model, done.study.stretched->state.positions, inputs.surface,
                                    inputs.edge);
    return done;
  } catch (const CaseError&) {
    return std::nullopt;
  } catch (const DataError&) {
    return std::nullopt;
  }
}

/// The cut of a run, moved, with another tumour, another depth or an opened layer: judged anew and held against the oracle.
void try_variants(const std::string& where, const Finished& done, int count, Random& random, Tally& tally) {
  const SimulatedCut& cut = *verifying_cut(done.study);
  for (int k = 0; k < count; ++k) {
    Case settings = done.settings;
    SimulatedCut variant = cut;
    TriMesh tumor = done.tumor, drawn = done.drawn;
    Contour edge = done.edge;
    std::string how;
    const std::uint64_t kind = random.below(6);
    if (kind == 0) {  // the path went round a contour that was shifted, and its cut with it
      const Vec3 by = random.uniform(0.0, 12.0) * random_direction(random, true);
      move(edge.points, by);
      move(variant.incision.kerf.body.surface.vertices, by);
      how = fmt::format("contour and cut moved by {:.2f} mm", by.norm());
    } else if (kind == 1) {
      const Vec3 by = random.uniform(0.0, 8.0) * random_direction(random, false);
      move(tumor.vertices, by);
      move(drawn.vertices, by);
      how = fmt::format("tumour moved by {:.2f} mm", by.norm());
    } else if (kind == 2) {
      const double factor = random.uniform(0.5, 1.8);
      Vec3 middle = Vec3::Zero();
      for (const Vec3& p : tumor.vertices) middle += p / static_cast<double>(tumor.vertices.size());
      for (TriMesh* mesh : {&tumor, &drawn}) {
        Vec3 own = Vec3::Zero();
        for (const Vec3& p : mesh->vertices) own += p / static_cast<double>(mesh->vertices.size());
        for (Vec3& p : mesh->vertices) p = own + factor * (p - own);
      }
      how = fmt::format("tumour {:.2f} times as large", factor);
    } else if (kind == 3) {
      settings.plan.depth_mm = random.uniform(2.0, 9.0);
      how = fmt::format("planned {:.1f} mm deep", settings.plan.depth_mm);
    } else if (kind == 4) {  // a dent in the depth
      std::vector<double>& depth = variant.incision.kerf.depth.profile.depth_mm;
      const double share = random.uniform(0.2, 1.0);
      const std::size_t at = random.below(depth.size());
      for (std::size_t i = 0; i < depth.size() / 10 + 1; ++i) depth[(at + i) % depth.size()] *= share;
      how = fmt::format("a dent to {:.2f} of the depth", share);
    } else {
      KerfLayer& layer = variant.incision.kerf.layers[random.below(variant.incision.kerf.layers.size())];
      layer.is_closed = false;
      how = fmt::format("layer {} mm opened", layer.depth_mm);
    }
    IncisionSettings incision = incision_settings(settings, *done.study.plan);
    incision.tumor_surface = tumor;
    variant.incision.kerf.deep_margin = deep_margin(variant.incision.kerf.body, variant.incision.kerf.depth, incision);
    variant.verdict = verdict_of_cut(settings, variant);
    Verdict inputs = verdict_of_contour(edge, drawn, settings.plan.approach);
    const Verdict verdict = verdict_of_run(settings, inputs, &variant, {});
    const std::string place = fmt::format("{}, variant {} ({})", where, k, how);
    hold_to_oracle(place, verdict, oracle_mm(variant.incision.kerf.body.surface, tumor), settings.close_margin_mm, tally);
    // Depth and closure have oracles of a line each.
    const std::vector<double>& depth = variant.incision.kerf.depth.profile.depth_mm;
    const double least = *std::min_element(depth.begin(), depth.end());
    if (least < 0.9 * settings.plan.depth_mm - 1e-9 && !verdict.has("depth")) fail(tally, place, fmt::format("{:.2f} mm deep and no word of it", least));
    for (const KerfLayer& layer : variant.incision.kerf.layers) {
      if (layer.is_within_plan && !layer.is_closed.value_or(false) && !verdict.has("open_layer")) fail(tally, place, "an open layer and no word of it");
    }
    ++tally.variants;
  }
}

void try_broken_run(std::uint64_t seed, const Options& options, int variants, Workers& workers, Tally& tally) {
  Random random(seed);
  const Phantom phantom = specimen(1 + random.below(1000000));
  SpecimenInputs inputs(phantom);
  const BrokenCase broken = broken_case(options.tets, inputs, random);
  const std::string where = fmt::format("run of seed {} ({})", seed, broken.how);
  ++tally.runs;
  const std::optional<Finished> done = run_case(broken.settings, inputs, workers);
  if (!done) {
    ++tally.refused;
    return;
  }
  const SimulatedCut& cut = *verifying_cut(done->study);
  const Verdict& verdict = done->study.verdict;
  const TriMesh& kerf = cut.incision.kerf.body.surface;
  if (kerf.triangles.empty()) {
    if (verdict.status() != VerdictStatus::Refused) fail(tally, where, "nothing was cut, and it is not refused");
    return;
  }
  // As its own simulation has it, and as it is: the true tumour, where it truly lies.
  hold_to_oracle(where, verdict, oracle_mm(kerf, done->tumor), broken.settings.close_margin_mm, tally);
  const TriMesh truth = tumor_in_stretched(broken.settings, *done->study.model, done->study.stretched->state.positions, phantom.tumor, phantom.tumor_edge);
  const double true_mm = oracle_mm(kerf, truth);
  if (true_mm <= broken.settings.close_margin_mm - kOracleMm && verdict.status() == VerdictStatus::Ok)
    fail(tally, where, fmt::format("{:.3f} mm from the true tumour, and the verdict is ok", true_mm));
  if (!open_layers_mm(cut.incision).empty() && verdict.status() != VerdictStatus::Refused) fail(tally, where, "an open layer, and it is not refused");
  try_variants(where, *done, variants, random, tally);
}

/// A case as the generator makes it, in which nothing is broken: it has to be ok.
void try_sound_run(std::uint64_t seed, const Options& options, int variants, Workers& workers, Tally& tally) {
  Random random(seed + 7777777);
  const std::uint64_t phantom_seed = 1 + random.below(1000000);
  const Phantom phantom = specimen(phantom_seed);
  SpecimenInputs inputs(phantom);
  const std::optional<Finished> done = run_case(sound_case(options.sound_tets), inputs, workers);
  const std::string where = fmt::format("sound run of seed {} (incise phantom --seed {})", seed, phantom_seed);
  ++tally.sound;
  if (!done) return fail(tally, where, "a sound case was refused before it was cut");
  const Verdict& verdict = done->study.verdict;
  if (verdict.status() == VerdictStatus::Ok) {
    ++tally.sound_ok;
  } else {
    for (const VerdictReason& reason : verdict.reasons())
      fmt::print("{} is {}: {}: {}\n", where, to_string(verdict.status()), reason.id, reason.message);
    std::fflush(stdout);
  }
  const SimulatedCut& cut = *verifying_cut(done->study);
  hold_to_oracle(where, verdict, oracle_mm(cut.incision.kerf.body.surface, done->tumor), done->settings.close_margin_mm,
                 tally);
  try_variants(where, *done, variants, random, tally);
}

}  // namespace
}  // namespace incise::testing

int main(int argc, char** argv) {
  using namespace incise::testing;
  try {
    const Options options = parse(argc, argv);
    incise::Workers workers(options.threads);
    Tally tally;
    const int all_runs = options.runs + options.sound;
    for (int i = 0; i < options.runs; ++i) {
      try_broken_run(options.seed + static_cast<std::uint64_t>(i), options, options.variants / std::max(1, all_runs), workers, tally);
      if (i % 10 == 9) fmt::print("{} broken runs, {} variants, {} failures\n", i + 1, tally.variants, tally.failures), std::fflush(stdout);
    }
    for (int i = 0; i < options.sound; ++i) {
      try_sound_run(options.seed + static_cast<std::uint64_t>(i), options, options.variants / std::max(1, all_runs),
                    workers, tally);
      if (i % 10 == 9) fmt::print("{} sound runs, {} of {} sound cases ok\n", i + 1, tally.sound_ok, tally.sound), std::fflush(stdout);
    }
    fmt::print("{} broken runs, {} variants: {} ok, {} cautions, {} refused; {} nearer to the tumour than the close margin, each refused unless named above\n",
               tally.runs, tally.variants, tally.ok, tally.cautions, tally.refused, tally.near);
    fmt::print("{} of {} sound cases ok\n", tally.sound_ok, tally.sound);
    const bool is_too_strict = tally.sound > 0 && tally.sound_ok < 0.98 * tally.sound;
    if (is_too_strict) fmt::print("FAILED: fewer than 98 % of the sound cases are ok\n");
    return tally.failures > 0 || is_too_strict ? 1 : 0;
  } catch (const std::exception& error) {
    fmt::print("FAILED: {}\n", error.what());
    return 1;
  }
}
