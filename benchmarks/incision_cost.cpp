// What a whole incision costs: a virtual tongue from CT to stretched tissue, then the same ring cut with several
// settings.
//   incise_incision_cost [--tets N[,N...]] [--threads N] [--one-thread-too] [--runs N] [--advance MM] [--tolerance T]
//   [--rule tets|lattice|paper] [--tight] [--csv FILE] [--figure FILE]
// Prints, beside each time, how far the contour lies from that of a tightly converged run (--tight: residual 1e-4).
// Several sizes, in ascending order, are drawn against each other with --figure.
#include "cost_table.hpp"
#include "process_cost.hpp"
#include "support/phantom_inputs.hpp"

#include <incise/core/isa.hpp>
#include <incise/cutting/incision.hpp>
#include <incise/evaluation/contour_errors.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/report/line_plot.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

namespace incise::bench {
namespace {

struct Options {
  std::vector<int> tets{100000};  // ascending: a process remembers the most memory that it ever held
  int threads = 2;
  bool also_one_thread = false;  ///< the same runs on one thread after them
  int runs = 1;
  double advance_mm = 0.26;
  double tolerance = 0.0;  // 0: the default
  CutRule rule = CutRule::Tets;
  bool is_tight = false;
  std::string csv;
  std::string figure;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view name = argv[i];
    if (name == "--tight") {
      options.is_tight = true;
      continue;
    }
    if (name == "--one-thread-too") {
      options.also_one_thread = true;
      continue;
    }
    INCISE_REQUIRE(i + 1 < argc, fmt::format("expected a value after {}", name));
    const char* value = argv[++i];
    if (name == "--tets") {
      options.tets.clear();
      for (const double count : numbers_in(name, value)) {
        INCISE_REQUIRE(count == std::floor(count) && (options.tets.empty() || count > options.tets.back()),
                       fmt::format("expected --tets whole and ascending, found {}", value));
        options.tets.push_back(static_cast<int>(count));
      }
    } else if (name == "--threads") {
      options.threads = std::atoi(value);
    } else if (name == "--runs") {
      options.runs = std::atoi(value);
    } else if (name == "--advance") {
      options.advance_mm = std::atof(value);
    } else if (name == "--tolerance") {
      options.tolerance = std::atof(value);
    } else if (name == "--rule") {
      const std::optional<CutRule> rule = value_of<CutRule>(value);
      INCISE_REQUIRE(rule.has_value(),
                     fmt::format("expected --rule {}, found {}", choices(names_of(CutRule{})), value));
      options.rule = *rule;
    } else if (name == "--csv") {
      options.csv = value;
    } else if (name == "--figure") {
      options.figure = value;
    } else {
      throw InvalidArgument(
          fmt::format("expected --tets, --threads, --one-thread-too, --runs, --advance, --tolerance, --rule, --tight, "
                      "--csv or --figure, found {}",
                      name));
    }
  }
  return options;
}

/// Mean distance of a contour's points from another contour, mm.
double mean_distance(const Contour& from, const Contour& to) {
  double sum = 0.0;
  for (const Vec3& p : from.points) sum += nearest_on(to, p).distance_mm;
  return sum / static_cast<double>(from.points.size());
}

struct Run {
  IncisionResult result;
  double wall_s = 0.0;
  double processor_s = 0.0;
};

Run cut(const Study& study, const IncisionSettings& settings, int threads) {
  Workers workers(threads);
  Monitor silent;
  Run run;
  const double processor = processor_seconds();
  const double wall = wall_seconds();
  run.result = simulate_incision(*study.model, study.stretched->state, *study.plan, settings, workers, silent);
  run.wall_s = wall_seconds() - wall;
  run.processor_s = processor_seconds() - processor;
  return run;
}

/// What the runs at one size came to.
struct Size {
  double tets = 0.0;
  double median_wall_s = 0.0;
  double iterations_per_step = 0.0;
  double bytes_per_tet = 0.0;  ///< the whole process at most
};

/// Cuts a tongue of about `tets` tets; appends its rows to `table`.
Size run_size(const Options& options, const Phantom& phantom, int tets, std::string& table) {
  Monitor silent;
  Workers workers(options.threads);
  Case settings;
  settings.is_virtual = true;
  settings.meshing.tets = tets;
  testing::PhantomInputs inputs(phantom);
  Cache cache;
  const Study study = run_study(settings, inputs, cache, {.until = Stage::Plan}, workers, silent);
  Size size;
  size.tets = static_cast<double>(study.model->mesh.tets.size());
  fmt::print("{} tets, {} vertices; mesh and stretch ready, {:.0f} MB held at most so far; instruction set {}; path {:.1f} mm\n",
             study.model->mesh.tets.size(), study.model->mesh.vertices.size(), 1e-6 * peak_bytes(), to_string(active_isa()),
             length_mm(entry_contour(*study.plan)));

  IncisionSettings incision{.cut = settings.cut, .tool = settings.tool, .approach = settings.plan.approach};
  incision.cut.advance_per_step_mm = options.advance_mm;
  incision.cut.rule = options.rule;
  if (options.tolerance > 0.0) incision.cut.residual_tolerance = options.tolerance;

  std::optional<Contour> reference;
  if (options.is_tight) {
    IncisionSettings tight = incision;
    tight.cut.residual_tolerance = 1e-4;
    Run run = cut(study, tight, options.threads);
    reference = run.result.centerline;
    fmt::print("tight run: residual 1e-4, {:.1f} s, {}\n", run.wall_s, to_string(run.result.outcome));
  }
  fmt::print("{:>7} {:>6} {:>9} {:>8} {:>9} {:>9} {:>7} {:>8} {:>9} {:>8} {:>10} {:>6}\n", "threads", "steps", "its/step", "wall s",
             "CPU s", "ms/step", "removed", "signed", "to tight", "MB", "outcome", "load");
  std::vector<double> walls, processors, walls_alone;
  const int all_runs = options.also_one_thread ? 2 * options.runs : options.runs;
  for (int i = 0; i < all_runs; ++i) {
    const bool is_alone = i >= options.runs;
    const int threads = is_alone ? 1 : options.threads;
    const Run run = cut(study, incision, threads);
    const IncisionResult& r = run.result;
    (is_alone ? walls_alone : walls).push_back(run.wall_s);
    if (!is_alone) processors.push_back(run.processor_s);
    double signed_mm = std::nan("");
    double to_tight = std::nan("");
    if (r.centerline) {
      signed_mm = 0.0;
      for (const double error : contour_errors(*r.centerline, study.plan->tumor_edge, settings.plan.lateral_margin_mm,
                                               settings.plan.approach)
                                    .signed_error_mm)
        signed_mm += error;
      signed_mm /= static_cast<double>(r.centerline->points.size());
      if (reference) to_tight = mean_distance(*r.centerline, *reference);
    }
    const double steps = static_cast<double>(r.steps.size());
    size.iterations_per_step = static_cast<double>(r.solver_iterations) / steps;
    size.bytes_per_tet = peak_bytes() / size.tets;
    fmt::print("{:>7} {:>6} {:>9.1f} {:>8.2f} {:>9.2f} {:>9.2f} {:>7} {:>8.3f} {:>9.4f} {:>8.0f} {:>10} {:>6.2f}\n", threads,
               r.steps.size(), size.iterations_per_step, run.wall_s, run.processor_s, 1000.0 * run.wall_s / steps, r.record.removals.size(),
               signed_mm, to_tight, 1e-6 * peak_bytes(), to_string(r.outcome), load_average());
    std::fflush(stdout);
    table += fmt::format("{},{},{},{},{},{},{},{:.3f},{:.3f},{},{:.4f},{:.4f},{:.0f},{},{:.2f},{},{},{}\n",
                         study.model->mesh.tets.size(), study.model->mesh.vertices.size(), threads,
                         incision.cut.advance_per_step_mm, incision.cut.residual_tolerance, r.steps.size(),
                         r.solver_iterations, run.wall_s, run.processor_s, r.record.removals.size(), signed_mm,
                         to_tight, size.bytes_per_tet, to_string(r.outcome), load_average(), to_string(active_isa()),
                         source_commit(), to_string(options.rule));
  }
  size.median_wall_s = median(walls);
  fmt::print("median of {} runs on {} threads: {:.2f} s wall, {:.2f} s processor\n", options.runs, options.threads,
             size.median_wall_s, median(processors));
  if (!walls_alone.empty()) {
    fmt::print("median of {} runs on one thread: {:.2f} s wall, {:.2f} times that on {}\n", options.runs,
               median(walls_alone), median(walls_alone) / size.median_wall_s, options.threads);
  }
  return size;
}

/// Relative to the first size, so that four quantities share one picture.
LinePlot plot_of(const std::vector<Size>& sizes) {
  LinePlot plot{"One simulated incision of 95 mm against the size of its mesh", "tetrahedra", "relative to the smallest mesh", true, true, {}};
  const auto add = [&](const std::string& name, auto value) {
    LineSeries series{name, {}, {}, true};
    for (const Size& size : sizes) {
      series.add(size.tets, value(size) / value(sizes.front()));
    }
    plot.series.push_back(std::move(series));
  };
  add("wall time", [](const Size& s) { return s.median_wall_s; });
  add("iterations a step", [](const Size& s) { return s.iterations_per_step; });
  add("bytes a tet", [](const Size& s) { return s.bytes_per_tet; });
  return plot;
}

int run(const Options& options) {
  INCISE_REQUIRE(options.runs > 0 && options.threads > 0, "expected at least one run and one thread");
  Monitor silent;
  const Phantom phantom = make_phantom(PhantomSettings{}, silent);
  std::string table = origin_line();
  table +=
      "tets,vertices,threads,advance_mm,residual_tolerance,steps,iterations,wall_s,processor_s,removed,signed_error_mm,"
      "to_tight_mm,bytes_per_tet,outcome,load,isa,commit,rule\n";
  std::vector<Size> sizes;
  for (const int tets : options.tets) sizes.push_back(run_size(options, phantom, tets, table));
  write_text(options.csv, table);
  if (!options.figure.empty()) write_text(options.figure, line_plot_svg(plot_of(sizes)));
  return 0;
}

}  // namespace
}  // namespace incise::bench

int main(int argc, char** argv) {
  return incise::bench::reporting_errors("incise_incision_cost", [&] { return incise::bench::run(incise::bench::parse(argc, argv)); });
}
