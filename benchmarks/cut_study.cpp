// What the simulated cut depends on. Cuts run side by side, one thread each; errors of the mid-line against the lateral
// margin stand beside the cost.
//
//   incise_cut_study step|mesh|law|table [--threads N] [--csv FILE] [--figure FILE]
//
// step:  the simulation step: 0.13, 0.26, 0.52 mm.
// mesh:  edge lengths 1.0, 0.8, 0.6, 0.5 mm: with drag, without, and in tissue that cannot move.
// law:   the cut by points (docs/decisions/0010-cutting-law.md): [--moduli 6,12,70] kPa, [--edges 1.0,0.8,0.6] mm, of
//        each size [--meshes 2], whose edges differ by half a percent, of specimens [--seeds 1], in steps of
//        [--steps 0.26] mm.
// table: the paper's Table I: 25 pairs of speed and dullness; [--rule tets|lattice|paper] [--count keep|reset]
//        [--specimens 2].

#include "cost_table.hpp"
#include "support/phantom_inputs.hpp"

#include <incise/core/error.hpp>
#include <incise/cutting/incision.hpp>
#include <incise/report/line_plot.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

namespace incise::bench {
namespace {

struct Options {
  std::string study;
  int threads = 2;
  CutRule rule = CutRule::Tets;  // of the table
  ContactCount count = ContactCount::Keep;  // of the table by the paper's rule
  std::uint64_t specimens = 2;   // of the table
  std::vector<double> moduli_kpa{6.0, 12.0, 70.0}, edges_mm{1.0, 0.8, 0.6}, seeds{1.0}, steps_mm{0.26};  // of the law
  int meshes = 2;
  std::string csv;
  std::string figure;
};

Options parse(int argc, char** argv) {
  Options options;
  INCISE_REQUIRE(argc > 1, "expected step, mesh, law or table");
  options.study = argv[1];
  INCISE_REQUIRE(options.study == "step" || options.study == "mesh" || options.study == "law" ||
                     options.study == "table",
                 fmt::format("expected step, mesh, law or table, found {}", options.study));
  bool is_counted = false;  // --count was given
  for (int i = 2; i < argc; i += 2) {
    const std::string_view name = argv[i];
    INCISE_REQUIRE(i + 1 < argc, fmt::format("expected a value after {}", name));
    const char* value = argv[i + 1];
    if (name == "--rule") {
      INCISE_REQUIRE(options.study == "table", "expected --rule with table alone: law has its own");
      const std::optional<CutRule> rule = value_of<CutRule>(value);
      INCISE_REQUIRE(rule.has_value(),
                     fmt::format("expected --rule {}, found {}", choices(names_of(CutRule{})), value));
      options.rule = *rule;
    } else if (name == "--count") {
      const std::optional<ContactCount> count = value_of<ContactCount>(value);
      INCISE_REQUIRE(count.has_value(),
                     fmt::format("expected --count {}, found {}", choices(names_of(ContactCount{})), value));
      options.count = *count;
      is_counted = true;
    } else if (name == "--specimens") {
      const int specimens = std::atoi(value);
      INCISE_REQUIRE(specimens > 0, fmt::format("expected --specimens 1 or more, found {}", value));
      options.specimens = static_cast<std::uint64_t>(specimens);
    } else if (options.study == "law" && name == "--moduli") {
      options.moduli_kpa = numbers_in(name, value);
    } else if (options.study == "law" && name == "--edges") {
      options.edges_mm = numbers_in(name, value);
    } else if (options.study == "law" && name == "--seeds") {
      options.seeds = numbers_in(name, value);
      for (const double seed : options.seeds)
        INCISE_REQUIRE(seed == std::floor(seed), fmt::format("expected whole --seeds, found {}", value));
    } else if (options.study == "law" && name == "--steps") {
      options.steps_mm = numbers_in(name, value);
    } else if (options.study == "law" && name == "--meshes") {
      options.meshes = std::atoi(value);
      INCISE_REQUIRE(options.meshes > 0, fmt::format("expected --meshes 1 or more, found {}", value));
    } else if (name == "--threads") {
      options.threads = std::atoi(value);
    } else if (name == "--csv") {
      options.csv = value;
    } else if (name == "--figure") {
      options.figure = value;
    } else {
      throw InvalidArgument(fmt::format(
          "expected --threads, --csv, --figure, with table --rule, --count, --specimens, with law --moduli, "
          "--edges, --meshes, --seeds, --steps; found {}",
          name));
    }
  }
  INCISE_REQUIRE(!is_counted || options.rule == CutRule::Paper, "expected --count with --rule paper alone");
  return options;
}

/// A stretched specimen with the planned path.
struct Body {
  std::string name;
  std::optional<double> edge_mm;  // absent: that of a number of tets
  Case settings;
  Study study;
};

Body make_body(const Phantom& phantom, std::string name, const MeshingChoice& meshing, Workers& workers,
               const Material& material = {}) {
  Body body{std::move(name), meshing.fine_mm, {}, {}};
  body.settings.is_virtual = true;
  body.settings.meshing = meshing;
  body.settings.material = material;
  body.settings.frames = 0;
  testing::PhantomInputs inputs(phantom);
  Cache cache;
  Monitor silent;
  body.study = run_study(body.settings, inputs, cache, {.until = Stage::Plan}, workers, silent);
  fmt::print(stderr, "{}: {} tets\n", body.name, body.study.model->mesh.tets.size());
  return body;
}

enum class Tissue { Held, WithoutDrag, Frozen };
constexpr std::string_view name_of(Tissue tissue) {
  return tissue == Tissue::Held ? "drag" : tissue == Tissue::WithoutDrag ? "no drag" : "frozen";
}

struct Job {
  const Body* body;
  Tissue tissue = Tissue::Held;
  CutSettings cut;
};

/// The stretched body as one that nothing can move.
TissueModel frozen(const TissueModel& model, const TissueState& stretched) {
  TetMesh mesh = model.mesh;
  mesh.vertices = stretched.positions;
  mesh.point_data.clear();
  mesh.cell_data.clear();
  return make_tissue_model(std::move(mesh), Material{}, {FixedConstraint{SphereRegion{Vec3::Zero(), 1e4}}}, Vec3::Zero());
}

SimulatedCut carry_out(const Job& job) {
  Workers alone(1);
  Monitor silent;
  Case settings = job.body->settings;
  settings.cut = job.cut;
  if (job.tissue != Tissue::Held) settings.cut.bond_stiffness_kpa_mm2 = settings.cut.hold_per_mm2 = 0.0;
  const Study& study = job.body->study;
  if (job.tissue != Tissue::Frozen) {
    return cut_and_judge(settings, *study.model, study.stretched->state, *study.plan, *study.plan, alone, silent);
  }
  const TissueModel model = frozen(*study.model, study.stretched->state);
  return cut_and_judge(settings, model, rest_state(model), *study.plan, *study.plan, alone, silent);
}

constexpr std::string_view kHeader =
    "specimen,edge_mm,tets,tissue,speed_mm_s,dullness,advance_mm,outcome,closed_loop,"
    "signed_mean_mm,signed_sd_mm,signed_min_mm,signed_max_mm,abs_mean_mm,paper_abs_mean_mm,inner_signed_mean_mm,"
    "kerf_width_mm,removed_tets,copied_tets,steps,iterations,wall_s\n";

/// One line of the table; what an open ring does not have stays empty.
std::string row_of(const Job& job, const SimulatedCut& done) {
  const IncisionResult& cut = done.incision;
  const auto number = [](const std::optional<double>& value) { return value ? fmt::format("{:.3f}", *value) : std::string(); };
  const auto part = [&](const std::optional<Summary>& summary, double Summary::*value) {
    return summary ? fmt::format("{:.3f}", *summary.*value) : std::string();
  };
  const Evaluation& e = done.centerline;
  return fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3f},{},{},{},{},{:.1f}\n", job.body->name,
      job.body->edge_mm ? fmt::format("{:.4g}", *job.body->edge_mm) : "", done.tets, name_of(job.tissue),
      job.cut.speed_mm_s, job.cut.dullness, fmt::format("{:.4g}", job.cut.advance_mm()), to_string(done.outcome),
      cut.is_closed_loop.value_or(false) ? "yes" : "no", part(e.signed_error_mm, &Summary::mean),
      part(e.signed_error_mm, &Summary::sd), part(e.signed_error_mm, &Summary::min),
      part(e.signed_error_mm, &Summary::max), part(e.abs_error_mm, &Summary::mean), number(e.paper_abs_error_mm),
      part(done.inner_edge.signed_error_mm, &Summary::mean), cut.kerf_width_mm, cut.record.removals.size(),
      cut.final_state.splits.copies.size(), cut.steps.size(), cut.solver_iterations, cut.wall_s);
}

/// What is kept of a cut.
struct Done {
  std::string row;
  std::optional<Summary> error_mm;  ///< absent: the ring is open
};

std::vector<Done> carry_out(const std::vector<Job>& jobs, Workers& workers) {
  std::vector<Done> done(jobs.size());
  std::mutex printing;
  fmt::print("{}", kHeader);
  workers.for_each(jobs.size(), 1, [&](std::size_t i) {
    const SimulatedCut cut = carry_out(jobs[i]);
    done[i] = {row_of(jobs[i], cut), cut.centerline.signed_error_mm};
    const std::lock_guard lock(printing);
    fmt::print("{}", done[i].row);
    std::fflush(stdout);
  });
  return done;
}

struct Result {
  std::vector<Done> done;
  LinePlot plot;
};

void add_point(LinePlot& plot, const std::string& name, double x, const Done& done) {
  if (!done.error_mm) return;
  auto series = std::find_if(plot.series.begin(), plot.series.end(), [&name](const LineSeries& s) { return s.name == name; });
  if (series == plot.series.end()) series = plot.series.insert(plot.series.end(), LineSeries{name, {}, {}, false});
  series->x.push_back(x);
  series->y.push_back(done.error_mm->mean);
}

Result study_steps(Workers& workers) {
  Monitor silent;
  const Phantom phantom = make_phantom(PhantomSettings{}, silent);
  const Body body = make_body(phantom, "seed 1", MeshingChoice{}, workers);
  std::vector<Job> jobs;
  for (const double advance : {0.13, 0.26, 0.52}) {
    jobs.push_back({&body, Tissue::Held, {}});
    jobs.back().cut.advance_per_step_mm = advance;
  }
  Result result{carry_out(jobs, workers), {"Simulated: error of the mid-line against the step", "needle advance a step, mm",
                                           "mean signed error, mm", true, false, {}}};
  for (std::size_t i = 0; i < jobs.size(); ++i) add_point(result.plot, "13 mm/s x 9", jobs[i].cut.advance_per_step_mm, result.done[i]);
  return result;
}

Result study_meshes(Workers& workers) {
  Monitor silent;
  const Phantom phantom = make_phantom(PhantomSettings{}, silent);
  std::vector<Body> bodies;
  for (const double edge : {1.0, 0.8, 0.6, 0.5}) {
    MeshingChoice meshing{.fine_mm = edge};
    bodies.push_back(make_body(phantom, "seed 1", meshing, workers));
  }
  std::vector<Job> jobs;
  for (const Body& body : bodies) {
    for (const double dullness : {7.0, 9.0}) {
      jobs.push_back({&body, Tissue::Held, {}});
      jobs.back().cut.dullness = dullness;
    }
    // Tissue that is not held passes the needle too fast for 13 mm/s x 9 to cut it.
    for (const Tissue tissue : {Tissue::WithoutDrag, Tissue::Frozen}) {
      jobs.push_back({&body, tissue, {}});
      jobs.back().cut.dullness = 5.0;
    }
  }
  Result result{carry_out(jobs, workers), {"Simulated: error of the mid-line against the mesh (mm/s x dullness)", "edge length in the band, mm",
                                           "mean signed error, mm", true, false, {}}};
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    add_point(result.plot, fmt::format("{}, 13 x {}", name_of(jobs[i].tissue), jobs[i].cut.dullness),
              jobs[i].body->edge_mm.value(), result.done[i]);
  }
  return result;
}

/// Whether a cut by points depends on its mesh.
Result study_law(Workers& workers, const Options& options) {
  Monitor silent;
  std::vector<Body> bodies;
  for (const double seed : options.seeds) {
    PhantomSettings specimen{.seed = static_cast<std::uint64_t>(seed)};
    const Phantom phantom = make_phantom(specimen, silent);
    for (const double modulus_kpa : options.moduli_kpa) {
      for (const double edge : options.edges_mm) {
        for (int mesh = 0; mesh < options.meshes; ++mesh) {
          MeshingChoice meshing{.fine_mm = edge * (1.0 + 0.005 * mesh)};
          const Material material{.youngs_modulus_kpa = modulus_kpa, .poissons_ratio = 0.45};
          bodies.push_back(make_body(phantom, fmt::format("seed {} of {} kPa", specimen.seed, modulus_kpa), meshing,
                                     workers, material));
        }
      }
    }
  }
  std::vector<Job> jobs;
  for (const Body& body : bodies) {
    for (const double step_mm : options.steps_mm) {
      jobs.push_back({&body, Tissue::Held, {}});
      jobs.back().cut.rule = CutRule::Lattice;
      jobs.back().cut.dullness = 5.4;
      jobs.back().cut.advance_per_step_mm = step_mm;
    }
  }
  Result result{carry_out(jobs, workers), {"Simulated: error of the mid-line against the mesh, cut by points", "edge length in the band, mm",
                                           "mean signed error, mm", true, false, {}}};
  for (std::size_t i = 0; i < jobs.size(); ++i)
    add_point(result.plot, fmt::format("{}, {} mm a step", jobs[i].body->name, jobs[i].cut.advance_per_step_mm),
              jobs[i].body->edge_mm.value(), result.done[i]);
  return result;
}

/// The 25 pairs of the paper's Table I.
Result study_table(Workers& workers, const Options& options) {
  static constexpr std::array<double, 5> kValues{1.0, 5.0, 9.0, 13.0, 17.0};
  Monitor silent;
  std::vector<Body> bodies;
  for (std::uint64_t seed = 1; seed <= options.specimens; ++seed) {
    PhantomSettings specimen{.seed = seed};
    MeshingChoice meshing{.tets = 40000};
    bodies.push_back(make_body(make_phantom(specimen, silent), fmt::format("seed {}", seed), meshing, workers));
  }
  std::vector<Job> jobs;
  for (const Body& body : bodies) {
    for (const double speed : kValues) {
      for (const double dullness : kValues) {
        jobs.push_back({&body, Tissue::Held, {}});
        jobs.back().cut.speed_mm_s = speed;
        jobs.back().cut.dullness = dullness;
        jobs.back().cut.rule = options.rule;
        jobs.back().cut.contact_count = options.count;
      }
    }
  }
  Result result{carry_out(jobs, workers), {"Simulated: error of the mid-line against speed x dullness; open rings are left out",
                                           "speed x dullness x 0.02 s, mm", "mean signed error, mm", false, false, {}}};
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const CutSettings& cut = jobs[i].cut;
    add_point(result.plot, jobs[i].body->name, cut.speed_mm_s * cut.dwell_s(), result.done[i]);
  }
  return result;
}

int run(const Options& options) {
  Workers workers(options.threads);
  const Result result = options.study == "step"   ? study_steps(workers)
                        : options.study == "mesh" ? study_meshes(workers)
                        : options.study == "law"  ? study_law(workers, options)
                                                  : study_table(workers, options);
  std::string table = origin_line("simulations of virtual specimens");
  table += kHeader;
  for (const Done& done : result.done) table += done.row;
  write_text(options.csv, table);
  if (!options.figure.empty()) write_text(options.figure, line_plot_svg(result.plot));
  return 0;
}

}  // namespace
}  // namespace incise::bench

int main(int argc, char** argv) {
  return incise::bench::reporting_errors("incise_cut_study",
                                         [&] { return incise::bench::run(incise::bench::parse(argc, argv)); });
}
