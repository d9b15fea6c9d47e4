// Registration: time and memory of the drift beside a plain dense implementation, and how often random similarities are
// found.
//   incise_registration_cost [cost|random|all] [--trials N] [--threads N] [--dense-20k] [--unoriented] [--csv FILE]
// INCISE_DATA_DIR adds the tongue surfaces of the shared data to the random trials.
#include "dense_drift.hpp"
#include "process_cost.hpp"
#include "registration_scene.hpp"

#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/registration/register_clouds.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace incise::bench {
namespace {

struct Options {
  std::string what = "all";
  int trials = 100;
  int threads = 2;
  bool dense_20k = false;
  bool has_normals = true;
  std::string csv;
};

// The bars.
constexpr double kSeconds20k = 2.0;
constexpr double kSeconds5k = 0.3;
constexpr double kMegabytes = 500.0;
constexpr double kLikeDenseMm = 0.05;
constexpr double kLikeDenseDeg = 0.05;
constexpr double kHitMm = 0.5;
constexpr double kHitDeg = 0.5;
constexpr double kHitShare = 0.95;

bool measure_cost(const Options& options, std::size_t count, double bar_s, bool with_dense, std::string& table) {
  Workers workers(options.threads);
  const VisibleSurface top = visible_surface(synthetic_tongue(3), {.spacing_mm = 0.25}, workers);
  Random random(1);
  const PointCloud source = drawn(top.cloud, count, random);
  PointCloud target = drawn(top.cloud, count, random);
  add_noise(target, 0.2, random);
  const Similarity truth{1.04, rotation_of({0.3, -0.2, 0.4}), {12.0, -30.0, 7.0}};
  target.points = moved(truth, target.points);
  Monitor silent;
  double best_wall = 1e9;
  double best_cpu = 1e9;
  Drift drift;
  const double before = peak_bytes();
  for (int run = 0; run < 5; ++run) {
    const double wall = wall_seconds();
    const double cpu = processor_seconds();
    drift = rigid_drift(source.points, target.points, {}, {}, workers, silent);
    best_wall = std::min(best_wall, wall_seconds() - wall);
    best_cpu = std::min(best_cpu, processor_seconds() - cpu);
  }
  const double megabytes = peak_bytes() / 1048576.0;
  std::string dense_text = "-,-,-,-";
  bool is_good = drift.outcome == DriftOutcome::Converged && best_wall <= bar_s && megabytes <= kMegabytes;
  if (with_dense) {
    const double wall = wall_seconds();
    const DenseDrift dense = dense_drift(source.points, target.points, {}, DriftSettings{}.outlier_weight, 2e-4, 1000);
    const double apart = rms_difference_mm(drift.T_target_source, dense.transform, source.points);
    const double turned = angle_between_deg(drift.T_target_source.rotation, dense.transform.rotation);
    dense_text = fmt::format("{:.5f},{:.5f},{:.2f},{}", apart, turned, wall_seconds() - wall, dense.iterations);
    is_good = is_good && apart < kLikeDenseMm && turned < kLikeDenseDeg;
  }
  table += fmt::format("{},{},{:.3f},{:.3f},{:.1f},{:.1f},{},{:.4f},{:.4f},{:.5f},{},{}\n", count, options.threads,
                       best_wall, best_cpu, megabytes, (peak_bytes() - before) / 1048576.0, drift.iterations,
                       drift.sigma_mm, rms_difference_mm(drift.T_target_source, truth, source.points),
                       drift.T_target_source.scale, dense_text, is_good ? "yes" : "NO");
  return is_good;
}

/// Upper sides of tongues: three synthetic ones, and four of the shared data where they are.
std::vector<std::pair<std::string, PointCloud>> tops(Workers& workers) {
  std::vector<std::pair<std::string, TriMesh>> tongues;
  for (const std::uint64_t seed : {1, 2, 3})
    tongues.emplace_back(fmt::format("synthetic {}", seed), synthetic_tongue(seed));
  if (const char* data = std::getenv("INCISE_DATA_DIR")) {
    const std::filesystem::path meshes = std::filesystem::path(data) / "meshes";
    const auto add = [&](const char* name, TriMesh mesh, const Similarity& t) {
      mesh.vertices = moved(t, mesh.vertices);
      tongues.emplace_back(name, std::move(mesh));
    };
    add("artisynth FEM", boundary_surface(read_tet_mesh(meshes / "artisynth_tongue" / "tongue.1.node")),
        {1000.0, rotation_of(Vec3(-0.5 * units::kPi, 0.0, 0.0))});
    add("artisynth voxel", read_surface(meshes / "artisynth_tongue" / "tongueIan.obj"), {});
    add("artisynth bad in", read_surface(meshes / "artisynth_tongue" / "badintongue.obj"), {1000.0});
    add("lrquad", read_surface(meshes / "lrquad_tongue" / "tongue_tuned_v3.obj"), {0.5});
  }
  std::vector<std::pair<std::string, PointCloud>> result;
  for (const auto& [name, mesh] : tongues)
    result.emplace_back(name, visible_surface(mesh, {.spacing_mm = 0.4}, workers).cloud);
  return result;
}

struct Trial {
  PointCloud source;
  PointCloud target;
  Similarity truth;
  Points cut_region;  ///< source frame: within 15 mm of the overlap's middle
};

/// Both clouds show 71 % of the surface, from opposite sides, so that 60 % of each has a counterpart. A fifth of the
/// target's points lie anywhere in its box.
Trial make_trial(const PointCloud& top, bool has_normals, Random& random, Workers& workers) {
  constexpr std::size_t kPoints = 4000;
  constexpr double kShown = 1.0 / 1.4;
  const double angle = random.uniform(0.0, 2.0 * units::kPi);
  const Vec3 along(std::cos(angle), std::sin(angle), 0.0);
  std::vector<double> places;
  for (const Vec3& p : top.points) places.push_back(along.dot(p));
  std::vector<double> sorted = places;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&sorted](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  std::vector<std::size_t> of_source;
  std::vector<std::size_t> of_target;
  Vec3 middle = Vec3::Zero();
  double both = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] <= at(kShown)) of_source.push_back(i);
    if (places[i] >= at(1.0 - kShown)) of_target.push_back(i);
    if (places[i] > at(kShown) || places[i] < at(1.0 - kShown)) continue;
    middle += top.points[i];
    both += 1.0;
  }
  middle /= both;
  Trial trial;
  for (const Vec3& p : top.points) {
    if ((p - middle).head<2>().norm() < 15.0) trial.cut_region.push_back(p);
  }
  trial.source = drawn(subset(top, of_source), kPoints, random);
  trial.target = drawn(subset(top, of_target), kPoints, random);
  add_noise(trial.target, 0.2, random);
  const Box3 box = bounding_box(trial.target.points);
  for (std::size_t i = 0; i < kPoints / 4; ++i) {
    const Vec3 share(random.uniform(), random.uniform(), random.uniform());
    trial.target.points.push_back(box.min() + box.sizes().cwiseProduct(share));
  }
  const auto shift = [&random] { return random.uniform(-200.0, 200.0); };
  trial.truth = {random.uniform(0.9, 1.1), random_rotation(random), Vec3(shift(), shift(), shift())};
  trial.target.points = moved(trial.truth, trial.target.points);
  trial.target.normals.clear();
  if (has_normals) {
    trial.target = with_normals(std::move(trial.target), trial.truth.rotation * -Vec3::UnitZ(), 16, workers);
  } else {
    trial.source.normals.clear();
  }
  return trial;
}

bool try_random(const Options& options, std::string& table) {
  Workers workers(options.threads);
  const auto surfaces = tops(workers);
  Monitor silent;
  int hits = 0;
  int flagged_hits = 0;
  int silent_misses = 0;
  const double start = wall_seconds();
  const double start_cpu = processor_seconds();
  for (int k = 0; k < options.trials; ++k) {
    const auto& [name, top] = surfaces[static_cast<std::size_t>(k) % surfaces.size()];
    Random random(1000 + static_cast<std::uint64_t>(k));
    const Trial trial = make_trial(top, options.has_normals, random, workers);
    const double cpu = processor_seconds();
    const Registration found = register_clouds(trial.source, trial.target, {}, workers, silent);
    const double error = rms_difference_mm(found.T_target_source, trial.truth, trial.cut_region);
    const double turned = angle_between_deg(found.T_target_source.rotation, trial.truth.rotation);
    const bool is_hit = error < kHitMm && turned < kHitDeg;
    const bool is_flagged = found.outcome != RegistrationOutcome::Converged;
    hits += is_hit ? 1 : 0;
    flagged_hits += is_hit && is_flagged ? 1 : 0;
    silent_misses += !is_hit && !is_flagged ? 1 : 0;
    const std::string line =
        fmt::format("{},{},{},{},{:.4f},{:.4f},{:.5f},{:.5f},{:.3f},{:.3f},{:.3f},{:.5f},{:.3f},{:.2f}\n", k, name,
                    is_hit ? "hit" : "MISS", to_string(found.outcome), error, turned, found.T_target_source.scale,
                    trial.truth.scale, found.rmse_mm, found.score, found.rival_score, found.certificate.sharpness[0],
                    found.certificate.weakest_sd_mm, processor_seconds() - cpu);
    table += line;
    fmt::print("{}", line);
    std::fflush(stdout);
  }
  const int misses = options.trials - hits;
  fmt::print(
      "{} of {} within {} mm and {} degrees; misses flagged: {} of {}; hits flagged without need: {}; {:.0f} s wall, "
      "{:.0f} s processor\n",
      hits, options.trials, kHitMm, kHitDeg, misses - silent_misses, misses, flagged_hits, wall_seconds() - start,
      processor_seconds() - start_cpu);
  return hits >= kHitShare * options.trials && silent_misses == 0;
}

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "cost" || word == "random" || word == "all") {
      options.what = word;
    } else if (word == "--trials" && i + 1 < argc) {
      options.trials = std::atoi(argv[++i]);
    } else if (word == "--threads" && i + 1 < argc) {
      options.threads = std::atoi(argv[++i]);
    } else if (word == "--csv" && i + 1 < argc) {
      options.csv = argv[++i];
    } else if (word == "--dense-20k") {
      options.dense_20k = true;
    } else if (word == "--unoriented") {
      options.has_normals = false;
    } else {
      throw std::runtime_error(fmt::format(
          "expected cost, random, all, --trials N, --threads N, --dense-20k, --unoriented or --csv FILE, found {}",
          word));
    }
  }
  return options;
}

int run(int argc, char** argv) {
  const Options options = options_of(argc, argv);
  const std::string head = fmt::format("# {}; g++ {}, {}; {} {}; {}\n", machine_description(), __VERSION__, BUILD_FLAGS,
                                       version(), source_commit(), to_string(active_isa()));
  std::string table = head;
  bool is_good = true;
  if (options.what != "random") {
    table +=
        "points,threads,wall_s,processor_s,peak_mb,grown_mb,iterations,sigma_mm,from_truth_mm,scale,from_dense_mm,from_"
        "dense_deg,dense_s,"
        "dense_iterations,passed\n";
    is_good = measure_cost(options, 5000, kSeconds5k, true, table) && is_good;
    is_good = measure_cost(options, 20000, kSeconds20k, options.dense_20k, table) && is_good;
    fmt::print("{}", table);
  }
  if (options.what != "cost") {
    table +=
        "trial,surface,hit,outcome,error_mm,error_deg,scale,true_scale,rmse_mm,score,rival_score,sharpness,weakest_sd_"
        "mm,processor_s\n";
    is_good = try_random(options, table) && is_good;
  }
  if (!options.csv.empty()) {
    std::ofstream file(options.csv);
    file << table;
    if (!file.flush()) throw std::runtime_error("cannot write " + options.csv);
  }
  return is_good ? 0 : 4;
}

}  // namespace
}  // namespace incise::bench

int main(int argc, char** argv) {
  try {
    return incise::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "incise_registration_cost: {}\n", error.what());
    return 2;
  }
}
