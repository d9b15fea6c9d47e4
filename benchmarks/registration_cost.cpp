// Registration: time and memory of the drift beside a plain dense implementation, and how often random similarities are
// found.
//   incise_registration_cost [cost|random|all] [--trials N] [--threads N] [--runs N] [--dense-20k] [--unoriented]
//   [--csv FILE] [--first-trial K]
// INCISE_DATA_DIR adds the tongue surfaces of the shared data to the random trials.
#include "cost_table.hpp"
#include "dense_drift.hpp"
#include "process_cost.hpp"
#include "registration_scene.hpp"

#include <incise/core/isa.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/registration/register_clouds.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string_view>

namespace incise::bench {
namespace {

struct Options {
  std::string what = "all";
  int trials = 100;
  int first_trial = 0;
  int threads = 2;
  int runs = 5;
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

/// Two samples of one surface, the target noisy and moved, and what the drift made of them.
struct CostCase {
  PointCloud source;
  PointCloud target;
  CoherentPointDrift drift;
};

/// Tells the time of the drift on `count` points each, all of them from one start.
bool measure_cost(const Options& options, CostCase& drawn_case, std::size_t count, double bar_s, std::string& table) {
  Workers workers(options.threads);
  const VisibleSurface top = visible_surface(synthetic_tongue(3), {.spacing_mm = 0.25}, workers);
  Random random(1);
  auto& [source, target, drift] = drawn_case;
  source = drawn(top.cloud, count, random);
  target = drawn(top.cloud, count, random);
  add_noise(target, 0.2, random);
  const Similarity truth{1.04, rotation_of({0.3, -0.2, 0.4}), {12.0, -30.0, 7.0}};
  target.points = moved(truth, target.points);
  Monitor silent;
  const double before = peak_bytes();
  std::vector<double> walls, processors;
  for (int run = -1; run < options.runs; ++run) {  // the first one warms up
    const double wall = wall_seconds(), processor = processor_seconds();
    drift = rigid_drift(source.points, target.points, {}, {}, workers, silent);
    if (run < 0) continue;
    walls.push_back(wall_seconds() - wall);
    processors.push_back(processor_seconds() - processor);
  }
  const auto [fastest, slowest] = std::minmax_element(walls.begin(), walls.end());
  const double megabytes = peak_bytes() / 1048576.0;
  const bool is_good = drift.outcome == DriftOutcome::Converged && median(walls) <= bar_s && megabytes <= kMegabytes;
  tell(fmt::format("{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.1f},{:.1f},{},{:.4f},{:.4f},{:.5f},{}\n", count,
                   options.threads, options.runs, median(walls), *fastest, *slowest, median(processors), load_average(),
                   megabytes, (peak_bytes() - before) / 1048576.0, drift.iterations, drift.sigma_mm,
                   rms_difference_mm(drift.T_target_source, truth, source.points), drift.T_target_source.scale,
                   is_good ? "yes" : "NO"),
       table);
  return is_good;
}

/// Tells how far the drift's answer is from that of the same method with nothing left out and followed to its end: from
/// the published start, and from the drift's answer, which has to lead to the same place.
bool compare_with_dense(const Options& options, const CostCase& drawn_case, std::string& table) {
  constexpr double kStillMm = 1e-6;  // from the fixed point
  constexpr double kSameMm = 1e-4;
  Workers workers(options.threads);
  const auto& [source, target, drift] = drawn_case;
  const double wall = wall_seconds();
  const auto dense_from = [&, &source = source, &target = target](const CoherentPointDrift* start) {
    return dense_drift(source.points, target.points, DriftSettings{}.outlier_weight, kStillMm, workers, start);
  };
  const DenseDrift dense = dense_from(nullptr);
  const DenseDrift other = dense_from(&drift);
  const double apart = rms_difference_mm(drift.T_target_source, dense.transform, source.points);
  const double turned = angle_between_deg(drift.T_target_source.rotation, dense.transform.rotation);
  const double ends_apart = rms_difference_mm(other.transform, dense.transform, source.points);
  const bool is_good = dense.has_converged && other.has_converged && ends_apart < kSameMm && apart < kLikeDenseMm &&
                       turned < kLikeDenseDeg;
  tell(fmt::format("{},{:.5f},{:.5f},{:.2f},{},{},{:.5f},{:.1e},{:.5f},{:.1e},{}\n", source.points.size(), apart,
                   turned, wall_seconds() - wall, dense.steps, other.steps, dense.rate, dense.left_mm, dense.sigma,
                   ends_apart, is_good ? "yes" : "NO"),
       table);
  return is_good;
}

bool try_cost(const Options& options, std::string& table) {
  tell(
      "points,threads,runs,wall_s,wall_least_s,wall_most_s,processor_s,load,peak_mb,grown_mb,iterations,sigma_mm,from_"
      "truth_mm,scale,passed\n",
      table);
  CostCase small, large;
  bool is_good = measure_cost(options, small, 5000, kSeconds5k, table);
  is_good = measure_cost(options, large, 20000, kSeconds20k, table) && is_good;
  // After all times, which are what most runs are for: it takes minutes.
  tell(
      "points,from_dense_mm,from_dense_deg,dense_s,dense_steps,dense_steps_from_ours,dense_rate,dense_left_mm,"
      "dense_sigma_mm,dense_ends_apart_mm,passed\n",
      table);
  is_good = compare_with_dense(options, small, table) && is_good;
  if (options.dense_20k) return compare_with_dense(options, large, table) && is_good;
  tell("# 20000 points beside the dense reference: not run, 16 times as long; --dense-20k runs it\n", table);
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
  tell(
      "trial,surface,hit,outcome,error_mm,error_deg,scale,true_scale,rmse_mm,score,rival_score,mirror_score,sharpness,"
      "weakest_sd_mm,processor_s\n",
      table);
  int hits = 0;
  int flagged_hits = 0;
  int silent_misses = 0;
  const double start = wall_seconds();
  const double start_cpu = processor_seconds();
  for (int k = options.first_trial; k < options.first_trial + options.trials; ++k) {
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
        fmt::format("{},{},{},{},{:.4f},{:.4f},{:.5f},{:.5f},{:.3f},{:.3f},{:.3f},{:.3f},{:.5f},{:.3f},{:.2f}\n", k,
                    name, is_hit ? "hit" : "MISS", to_string(found.outcome), error, turned, found.T_target_source.scale,
                    trial.truth.scale, found.rmse_mm, found.score, found.rival_score, found.mirror_score,
                    found.certificate.sharpness[0], found.certificate.weakest_sd_mm, processor_seconds() - cpu);
    tell(line, table);
  }
  const int misses = options.trials - hits;
  tell(fmt::format("# {} of {} within {} mm and {} degrees; misses flagged: {} of {}; hits flagged without need: {}; "
                   "{:.0f} s wall, {:.0f} s processor\n",
                   hits, options.trials, kHitMm, kHitDeg, misses - silent_misses, misses, flagged_hits,
                   wall_seconds() - start, processor_seconds() - start_cpu),
       table);
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
    } else if (word == "--first-trial" && i + 1 < argc) {
      options.first_trial = std::max(0, std::atoi(argv[++i]));
    } else if (word == "--threads" && i + 1 < argc) {
      options.threads = std::atoi(argv[++i]);
    } else if (word == "--runs" && i + 1 < argc) {
      options.runs = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--csv" && i + 1 < argc) {
      options.csv = argv[++i];
    } else if (word == "--dense-20k") {
      options.dense_20k = true;
    } else if (word == "--unoriented") {
      options.has_normals = false;
    } else {
      throw std::runtime_error(
          fmt::format("expected cost, random, all, --trials N, --first-trial K, --threads N, --runs N, --dense-20k, "
                      "--unoriented or "
                      "--csv FILE, found {}",
                      word));
    }
  }
  return options;
}

int run(int argc, char** argv) {
  const Options options = options_of(argc, argv);
  std::string table;
  tell(origin_line(std::string(to_string(active_isa()))), table);
  bool is_good = true;
  if (options.what != "random") is_good = try_cost(options, table);
  if (options.what != "cost") is_good = try_random(options, table) && is_good;
  write_text(options.csv, table);
  return is_good ? 0 : 4;
}

}  // namespace
}  // namespace incise::bench

int main(int argc, char** argv) {
  return incise::bench::reporting_errors("incise_registration_cost", [&] { return incise::bench::run(argc, argv); });
}
