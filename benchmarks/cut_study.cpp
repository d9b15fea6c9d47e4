// What the simulated cut depends on. Cuts run side by side, one thread each; errors of the mid-line against the lateral
// margin stand beside the cost.
//
//   incise_cut_study step|mesh|law|table [--threads N] [--csv FILE] [--figure FILE]
//
// step:  the simulation step: 0.13, 0.26, 0.52 mm.
// mesh:  edge lengths 1.0, 0.8, 0.6, 0.5 mm: with drag, without, and in tissue that cannot move.
// law:   the cut by points (docs/decisions/0010-cutting-law.md): [--moduli 6,12,70] kPa, [--edges 1.0,0.8,0.6] mm, of
//        each size [--meshes 2], whose edges differ by half a percent, of specimens [--seeds 1], in steps of
//        [--steps 0.26] mm; [--radius 1.6] mm, [--hold 16] 1/mm² and [--dose-length 3] mm of the tool; in tissue of
//        [--poisson 0.45] and [--volume per_tet|averaged], or [--tissue frozen], which cannot move; along a path of
//        [--waypoints 48]. With [--case FILE], the specimen of that case, made from its CT, alone or with --seeds:
//        its region, threshold, constraints, stretch, tumour's edge and plan count, the rest is as above.
// table: the paper's Table I: 25 pairs of speed and dullness; [--rule tets|lattice|paper] [--count keep|reset]
//        [--specimens 2].

#include "cost_table.hpp"
#include "support/phantom_inputs.hpp"

#include <incise/core/error.hpp>
#include <incise/cutting/incision.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/report/line_plot.hpp>
#include <incise/storage/case_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
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
  std::vector<double> moduli_kpa{6.0, 12.0, 70.0}, edges_mm{1.0, 0.8, 0.6}, seeds, steps_mm{0.26};  // of the law
  int meshes = 2;
  CutSettings tool;                         // radius, hold and dose length of the law
  Material tissue{.poissons_ratio = 0.45};  // of the law
  bool is_frozen = false;                   // the tissue of the law
  std::optional<int> waypoints;             // of the law
  std::string case_file;                    // whose specimen is cut by the law; empty: virtual specimens
  std::string csv;
  std::string figure;
};

/// One number, 0 or more.
double number_in(std::string_view option, const char* text) {
  char* end = nullptr;
  const double number = std::strtod(text, &end);
  INCISE_REQUIRE(end != text && *end == '\0' && number >= 0.0 && std::isfinite(number),
                 fmt::format("expected {} with a number, 0 or more, found {}", option, text));
  return number;
}

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
    } else if (options.study == "law" && name == "--radius") {
      options.tool.kernel_radius_mm = number_in(name, value);
    } else if (options.study == "law" && name == "--hold") {
      options.tool.hold_per_mm2 = number_in(name, value);
    } else if (options.study == "law" && name == "--dose-length") {
      options.tool.dose_length_mm = number_in(name, value);
    } else if (options.study == "law" && name == "--poisson") {
      options.tissue.poissons_ratio = number_in(name, value);
    } else if (options.study == "law" && name == "--volume") {
      const std::optional<VolumeTreatment> volume = value_of<VolumeTreatment>(value);
      INCISE_REQUIRE(volume.has_value(),
                     fmt::format("expected --volume {}, found {}", choices(names_of(VolumeTreatment{})), value));
      options.tissue.volume = *volume;
    } else if (options.study == "law" && name == "--tissue") {
      options.is_frozen = std::string_view(value) == "frozen";
      INCISE_REQUIRE(options.is_frozen || std::string_view(value) == "drag",
                     fmt::format("expected --tissue drag or frozen, found {}", value));
    } else if (options.study == "law" && name == "--waypoints") {
      const double waypoints = number_in(name, value);
      INCISE_REQUIRE(waypoints == std::floor(waypoints) && waypoints <= 2000.0,
                     fmt::format("expected --waypoints 8 to 2000, found {}", value));
      options.waypoints = static_cast<int>(waypoints);
    } else if (options.study == "law" && name == "--case") {
      options.case_file = value;
    } else if (name == "--threads") {
      options.threads = std::atoi(value);
    } else if (name == "--csv") {
      options.csv = value;
    } else if (name == "--figure") {
      options.figure = value;
    } else {
      throw InvalidArgument(fmt::format(
          "expected --threads, --csv, --figure, with table --rule, --count, --specimens, with law --moduli, "
          "--edges, --meshes, --seeds, --steps, --radius, --hold, --dose-length, --poisson, --volume, --tissue, "
          "--waypoints, --case; found {}",
          name));
    }
  }
  if (options.seeds.empty() && options.case_file.empty()) options.seeds = {1.0};
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

Body make_body(Inputs& inputs, std::string name, Case settings, Cache& cache, Workers& workers) {
  settings.frames = 0;
  Body body{std::move(name), settings.meshing.fine_mm, std::move(settings), {}};
  Monitor silent;
  body.study = run_study(body.settings, inputs, cache, {.until = Stage::Plan}, workers, silent);
  fmt::print(
      stderr, "{}: {} tets{}\n", body.name, body.study.model->mesh.tets.size(),
      body.study.plan ? "" : fmt::format(": left out, its stretch: {}", to_string(body.study.stretched->outcome)));
  return body;
}

Body make_body(const Phantom& phantom, std::string name, const MeshingChoice& meshing, Workers& workers) {
  Case settings;
  settings.is_virtual = true;
  settings.meshing = meshing;
  testing::PhantomInputs inputs(phantom);
  Cache cache;
  Body body = make_body(inputs, std::move(name), std::move(settings), cache, workers);
  INCISE_REQUIRE(body.study.plan.has_value(), "expected a specimen that can be stretched");
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
  series->add(x, done.error_mm->mean);
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

/// A specimen of the law, made from a CT: several workers may ask for CT and edge at a time.
class ScannedSpecimen final : public Inputs {
 public:
  ScannedSpecimen(std::string name, Case settings, CtVolume ct, Contour edge)
      : name_(std::move(name)), settings_(std::move(settings)), ct_(std::move(ct)), edge_(std::move(edge)) {}
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Case& settings() const { return settings_; }
  CtVolume read_ct(Monitor&) override { return ct_; }
  std::optional<Contour> read_tumor_edge() override { return edge_; }

 private:
  std::string name_;
  Case settings_;
  CtVolume ct_;
  Contour edge_;
};

/// @throws InvalidArgument for a case that is more than a CT and a ring about a tumour's edge.
ScannedSpecimen specimen_of_case(const std::string& name) {
  const CaseFile file = read_case(name);
  const CaseInputs& inputs = file.inputs;
  const bool is_scan = !inputs.ct_volume.empty() && !inputs.tumor_contour.empty() && inputs.ct_labels.empty() &&
                       inputs.specimen_mesh.empty() && inputs.elasticity_map.empty() && inputs.tool_path.empty() &&
                       file.settings.plan.kind == PlanKind::Ring && !file.settings.variation.tumor_modulus_kpa;
  INCISE_REQUIRE(is_scan,
                 fmt::format("expected the case of a CT and a ring about a tumour's edge, without labels, mesh, "
                             "elasticity map, path or tumour's modulus, in {}",
                             name));
  Monitor silent;
  return {file.folder.lexically_normal().filename().string(), file.settings,
          read_ct(inputs.ct_volume, file.ct_reading, silent).volume, read_contour(inputs.tumor_contour, true)};
}

std::vector<ScannedSpecimen> specimens_of(const Options& options) {
  std::vector<ScannedSpecimen> specimens;
  if (!options.case_file.empty()) specimens.push_back(specimen_of_case(options.case_file));
  for (const double seed : options.seeds) {
    Monitor silent;
    Phantom phantom = make_phantom({.seed = static_cast<std::uint64_t>(seed)}, silent);
    Case settings;
    settings.is_virtual = true;
    specimens.emplace_back(fmt::format("seed {}", seed), settings, std::move(phantom.ct),
                           std::move(phantom.tumor_edge));
  }
  return specimens;
}

/// Whether a cut by points depends on its mesh. Meshes are cut side by side; moduli and steps of each follow one after
/// the other and share what does not depend on them.
Result study_law(Workers& workers, const Options& options) {
  std::vector<ScannedSpecimen> specimens = specimens_of(options);
  const std::size_t edges = options.edges_mm.size(), meshes = static_cast<std::size_t>(options.meshes);
  const std::size_t cuts = options.moduli_kpa.size() * options.steps_mm.size();  // of a mesh
  std::vector<Done> done(specimens.size() * edges * meshes * cuts);
  std::vector<std::string> names(done.size());
  std::vector<double> edge_of(done.size());
  std::mutex printing;
  fmt::print("{}", kHeader);
  workers.for_each(done.size() / cuts, 1, [&](std::size_t item) {
    ScannedSpecimen& specimen = specimens[item / (edges * meshes)];
    const double edge = options.edges_mm[item / meshes % edges];
    Cache cache;
    Workers alone(1);
    for (std::size_t cut = 0; cut < cuts; ++cut) {
      const double modulus_kpa = options.moduli_kpa[cut / options.steps_mm.size()];
      Case settings = specimen.settings();
      settings.meshing = {.fine_mm = edge * (1.0 + 0.005 * static_cast<double>(item % meshes))};
      settings.material = options.tissue;
      settings.plan.waypoints = options.waypoints.value_or(settings.plan.waypoints);
      settings.material.youngs_modulus_kpa = modulus_kpa;
      const Body body =
          make_body(specimen, fmt::format("{} of {} kPa", specimen.name(), modulus_kpa), settings, cache, alone);
      if (!body.study.plan) continue;
      Job job{&body, options.is_frozen ? Tissue::Frozen : Tissue::Held, options.tool};
      job.cut.rule = CutRule::Lattice;
      job.cut.dullness = 5.4;
      job.cut.advance_per_step_mm = options.steps_mm[cut % options.steps_mm.size()];
      const SimulatedCut simulated = carry_out(job);
      const std::size_t i = item * cuts + cut;
      done[i] = {row_of(job, simulated), simulated.centerline.signed_error_mm};
      names[i] = specimen.name();  // one series of marks for all moduli
      if (options.steps_mm.size() > 1) names[i] += fmt::format(", {} mm a step", job.cut.advance_per_step_mm);
      edge_of[i] = *body.edge_mm;
      const std::lock_guard lock(printing);
      fmt::print("{}", done[i].row);
      std::fflush(stdout);
    }
  });
  Result result{std::move(done),
                {"Simulated: error of the mid-line against the mesh, cut by points",
                 "edge length in the band, mm",
                 "mean signed error, mm",
                 true,
                 false,
                 {}}};
  for (std::size_t i = 0; i < result.done.size(); ++i) add_point(result.plot, names[i], edge_of[i], result.done[i]);
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

/// What was cut, and by what, for the CSV file.
std::string note_of(const Options& options) {
  if (options.study != "law") return "simulations of virtual specimens";
  const CutSettings& tool = options.tool;
  std::string note =
      fmt::format("simulations of {}; R {} mm, dose length {} mm, hold {} /mm2; Poisson's ratio {}, volume {}",
                  options.case_file.empty() ? "virtual specimens"
                  : options.seeds.empty()   ? "the specimen of " + options.case_file
                                            : "virtual specimens and that of " + options.case_file,
                  tool.kernel_radius_mm, tool.dose_length_mm, tool.hold_per_mm2, options.tissue.poissons_ratio,
                  to_string(options.tissue.volume));
  if (options.waypoints) note += fmt::format("; {} waypoints", *options.waypoints);
  return note;
}

int run(const Options& options) {
  Workers workers(options.threads);
  const Result result = options.study == "step"   ? study_steps(workers)
                        : options.study == "mesh" ? study_meshes(workers)
                        : options.study == "law"  ? study_law(workers, options)
                                                  : study_table(workers, options);
  std::string table = origin_line(note_of(options));
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
