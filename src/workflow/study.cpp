#include <incise/core/error.hpp>
#include <incise/core/memory.hpp>
#include <incise/core/problem_text.hpp>
#include <incise/cutting/tool_program.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/procedure/incision_memory.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/cut_doubts.hpp>
#include <incise/workflow/cut_verdict.hpp>
#include <incise/workflow/study.hpp>

#include <fmt/format.h>

#include <chrono>
#include <map>

namespace incise {

namespace {

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

/// One study on its way through the stages.
class Runner {
 public:
  Runner(const Case& settings, Store& store, Workers& workers, Monitor& monitor)
      : settings_(settings), store_(store), workers_(workers), monitor_(monitor) {}

  Study run(Stage until) {
    using Step = bool (Runner::*)();
    static constexpr std::array<Step, 7> kSteps{&Runner::segment,  &Runner::mesh,       &Runner::stretch_tissue, &Runner::plan,
                                                &Runner::simulate, &Runner::compensate, &Runner::verify};
    until_ = until;
    read_inputs();
    for (std::size_t i = 0; i <= static_cast<std::size_t>(until); ++i) {
      throw_if_cancelled(monitor_, "the study");
      if (!(this->*kSteps[i])()) break;
    }
    const bool was_correction_asked = until_ >= Stage::Verify && settings_.plan.kind == PlanKind::Ring;
    save_verdicts(was_correction_asked && !study_.is_accepted);
    study_.verdict = verdict_of_run(settings_, study_.about_inputs, verifying_cut(study_), was_correction_asked, study_.is_accepted);
    return std::move(study_);
  }

 private:
  /// What is quickly read is read first: a damaged contour shows before anything long has run.
  void read_inputs() {
    tumor_edge_ = store_.read_tumor_edge();
    tumor_surface_ = store_.read_tumor_surface();
    line_ = store_.read_line();
    given_path_ = store_.read_given_path();
    const bool is_ring = settings_.plan.kind == PlanKind::Ring;
    if (given_path_ && given_path_->is_closed != is_ring) {
      throw CaseError("case", "path", given_path_->is_closed ? "a closed path" : "an open path",
                      is_ring ? "a closed path for plan.kind: ring" : "an open path for plan.kind: line");
    }
    if (!tumor_edge_ || !tumor_surface_) return;
    require_tumor_size(*tumor_surface_);
    const Verdict fit = verdict_of_contour(*tumor_edge_, *tumor_surface_, settings_.plan.approach);
    report("the tumour", fit);
    study_.about_inputs.add(fit);
  }

  /// A surface in metres would lie somewhere within the edge and never come near the kerf.
  static void require_tumor_size(const TriMesh& surface) {
    const auto problem = size_problem(Contour{surface.vertices, true}, "a tumour", kLargestTumorMm);
    if (problem) throw CaseError("case", "tumor.surface", problem->found, problem->expected, "Lengths are mm");
  }

  /// Takes a product from the store, or makes and saves it; notes which, and how long it took.
  template <class Load, class Make, class Save>
  auto load_or_make(Stage stage, Load load, Make make, Save save) {
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&start] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    auto product = load();
    if (product) {
      study_.stages.push_back({stage, StageState::Reused, elapsed()});
      return std::move(*product);
    }
    auto made = make();
    const double wall_s = elapsed();
    save(made, wall_s);
    study_.stages.push_back({stage, StageState::Computed, wall_s});
    monitor_.message(Severity::Notice, fmt::format("{}: done in {:.1f} s", to_string(stage), wall_s));
    return made;
  }

  bool segment() {
    given_mesh_ = store_.read_specimen_mesh(monitor_);
    if (given_mesh_) {
      study_.stages.push_back({Stage::Segment, StageState::Skipped, 0.0});
      return true;
    }
    study_.segmentation = load_or_make(
        Stage::Segment, [&] { return store_.load_segmentation(); },
        [&] { return incise::segment(store_.read_ct(monitor_), settings_.segmentation, monitor_); },
        [&](const Segmentation& s, double wall_s) { store_.save_segmentation(s, wall_s); });
    report("the scan", study_.segmentation->verdict);
    study_.about_inputs.add(study_.segmentation->verdict);
    return true;
  }

  bool mesh() {
    TetMesh mesh;
    if (given_mesh_) {
      mesh = std::move(*given_mesh_);
      study_.stages.push_back({Stage::Mesh, StageState::Skipped, 0.0});
    } else {
      const auto make = [&]() -> TetMesh {
        MeshProduct product = make_mesh();
        store_.save_mesh(product, product.meshing.wall_s);
        return std::move(product.meshing.mesh);
      };
      mesh = load_or_make(Stage::Mesh, [&] { return store_.load_mesh(); }, make, [](const TetMesh&, double) {});
    }
    require_memory(mesh);
    study_.model = std::make_shared<TissueModel>(tissue_of(settings_, std::move(mesh)));
    if (until_ >= Stage::Simulate) require_no_locking(*study_.model);
    return true;
  }

  /// States what the rest will take, and refuses it where there is not so much.
  void require_memory(const TetMesh& mesh) {
    const std::uint64_t needed =
        expected_memory_bytes(mesh.vertices.size(), mesh.tets.size(), settings_.material.volume, settings_.frames);
    const std::optional<std::uint64_t> held = held_memory_bytes();
    monitor_.message(Severity::Notice,
                     fmt::format("tissue: {} tets, {} vertices; to stretch and cut it takes about {:.0f} MB{}", mesh.tets.size(), mesh.vertices.size(),
                                 megabytes(needed), held ? fmt::format(" beside the {:.0f} MB that the program holds now", megabytes(*held)) : ""));
    const std::optional<std::uint64_t> available = available_memory_bytes();
    if (!available || needed <= *available) return;
    throw DataError("this machine", "memory", fmt::format("{:.0f} MB that can be taken", megabytes(*available)),
                    fmt::format("about {:.0f} MB for {} tets", megabytes(needed), mesh.tets.size()),
                    "A coarser mesh needs less: meshing.fine_mm, meshing.coarse_mm, meshing.tets");
  }

  /// The mesher tells what it cannot do with the lengths or the count as a broken precondition; here they came from the case.
  MeshProduct make_mesh() {
    try {
      return mesh_around_planned_cut(settings_, study_.segmentation->occupancy, store_, workers_, monitor_);
    } catch (const InvalidArgument& error) {
      throw CaseError("case", "meshing", without_function_name(error), "edge lengths and a count that the tissue can be meshed with");
    }
  }

  bool stretch_tissue() {
    const TissueModel& model = *study_.model;
    study_.stretched = load_or_make(
        Stage::Stretch, [&] { return store_.load_stretched(model); },
        [&] {
          StaticResult made = stretch(model, workers_, monitor_);
          if (made.outcome == Outcome::Cancelled) throw Cancelled("the stretch was interrupted and will start over");
          return made;
        },
        [&](const StaticResult& result, double wall_s) { store_.save_stretched(model, result, wall_s); });
    study_.outcome = study_.stretched->outcome;
    if (study_.outcome != Outcome::Success) monitor_.message(Severity::Warning, explain_stretch(*study_.stretched));
    return study_.outcome == Outcome::Success;
  }

  bool plan() {
    study_.plan = load_or_make(
        Stage::Plan, [&] { return store_.load_plan(); },
        [&] {
          return plan_on(settings_, *study_.model, study_.stretched->state.positions, tumor_edge_, line_);
        },
        [&](const ToolPath& path, double wall_s) { store_.save_plan(path, wall_s); });
    return true;
  }

  /// The tool runs on beyond the start of a ring, but not round it again.
  void require_overlap_on(const ToolPath& path) const {
    const double round_mm = tip_way_mm(path);
    if (!path.is_closed || settings_.cut.overlap_mm < round_mm) return;
    throw CaseError("case", "cut.overlap_mm", fmt::format("{} mm", settings_.cut.overlap_mm),
                    fmt::format("less than the {:.1f} mm of the tip's way round the ring", round_mm));
  }

  /// Whoever takes a path from its file finds there what its cut is worth.
  void save_verdicts(bool is_correction_rejected) {
    const auto of = [&](const std::optional<SimulatedCut>& cut, const char* rejection) -> std::optional<Verdict> {
      if (!cut) return std::nullopt;
      Verdict verdict = study_.about_inputs;
      verdict.add(cut->verdict);
      if (is_correction_rejected) verdict.add("not_corrected", {}, rejection);
      return verdict;
    };
    store_.save_verdicts(given_path_ ? std::nullopt : of(study_.as_planned, kUncorrectedPath),
                         of(study_.corrected, "this is a correction that was not accepted"));
  }

  SimulatedCut cut(Stage stage, CutRole role, const ToolPath& path) {
    require_overlap_on(path);
    return load_or_make(
        stage, [&] { return store_.load_cut(role); }, [&] { return simulated(to_string(stage), role, path); },
        [&](const SimulatedCut& made, double wall_s) {
          store_.save_cut(role, *study_.model, *study_.stretched, made, wall_s);
        });
  }

  /// Simulates a cut from where an interrupted one left it, or from the beginning. @param name  of what is under way, for messages.
  SimulatedCut simulated(std::string_view name, CutRole role, const ToolPath& path) {
    std::optional<IncisionProgress> from = store_.load_progress(role, *study_.model, monitor_);
    if (from) monitor_.message(Severity::Notice, fmt::format("{}: goes on after step {}", name, from->state.step));
    const auto keep = [&](const IncisionProgress& progress, bool is_interrupted) {
      try {
        store_.keep_progress(role, progress, is_interrupted);
      } catch (const DataError& error) {
        if (is_interrupted) throw;  // nothing of the cut would be left
        monitor_.message(Severity::Warning, fmt::format("{}. The cut goes on without a checkpoint", error.what()));
      }
    };
    SimulatedCut made = cut_and_judge(settings_, *study_.model, study_.stretched->state, path, *study_.plan, workers_, monitor_,
                                      placed_tumor(), std::move(from), keep);
    if (made.outcome == Outcome::Cancelled) {
      throw Cancelled(fmt::format("the cut was interrupted after step {}", made.incision.final_state.step));
    }
    made.verdict.add(verdict_before_cut(settings_, *study_.model, study_.stretched->state.positions, path));
    return made;
  }

  /// The tumour's surface in the stretched tissue; without triangles: not known.
  TriMesh placed_tumor() const {
    if (!tumor_surface_) return {};
    return tumor_in_stretched(settings_, *study_.model, study_.stretched->state.positions, *tumor_surface_, tumor_edge_);
  }

  /// A given path goes no deeper than the tool is long.
  void require_reached() const {
    const std::optional<double> length = length_mm(settings_.tool);
    for (std::size_t i = 0; length && i < given_path_->waypoints.size(); ++i) {
      const double depth = given_path_->waypoints[i].depth_mm;
      if (depth > *length) {
        throw CaseError("path", "depth_mm", fmt::format("{} mm at waypoint {}", depth, i),
                        fmt::format("at most the tool's length of {} mm", *length));
      }
    }
  }

  bool simulate() {
    if (given_path_) {
      require_reached();
      check_path(*given_path_, SurfaceQuery(skin_of(study_.model->mesh, study_.stretched->state.positions)), settings_.plan.approach);
    }
    study_.followed = given_path_ ? *given_path_ : *study_.plan;
    study_.as_planned = cut(Stage::Simulate, CutRole::AsPlanned, *study_.followed);
    report("the cut as planned", study_.as_planned->verdict);
    study_.outcome = study_.as_planned->outcome;
    return true;
  }

  bool compensate() {
    const bool is_paper = settings_.compensation.method == CompensationMethod::Paper;
    const bool is_ring = settings_.plan.kind == PlanKind::Ring;
    if (!is_ring || (is_paper && !study_.as_planned->incision.centerline)) return skip_correction("it needs a ring whose mid-line could be measured");
    study_.correction = load_or_make(
        Stage::Compensate, [&] { return store_.load_correction(); },
        [&] {
          const SurfaceQuery surface(skin_of(study_.model->mesh, study_.stretched->state.positions));
          return is_paper ? correct_as_paper(settings_, *study_.followed, *study_.as_planned, study_.plan->tumor_edge, surface)
                          : correct_pass_by_pass(surface);
        },
        [&](const Correction& correction, double wall_s) { store_.save_correction(correction, wall_s); });
    const auto& iteration = study_.correction->iteration;
    if (iteration && iteration->outcome == CompensationOutcome::NoMeasure) {
      monitor_.message(Severity::Warning, "no correction: the first cut left nothing to measure");
      return false;
    }
    return true;
  }

  void report(std::string_view what, const Verdict& verdict) {
    for (const VerdictReason& reason : verdict.reasons()) {
      monitor_.message(Severity::Warning, fmt::format("{}: {}: {}: {}", what, to_string(reason.severity), reason.id, reason.message));
    }
  }

  bool skip_correction(const char* reason) {
    study_.stages.push_back({Stage::Compensate, StageState::Skipped, 0.0});
    monitor_.message(Severity::Warning, fmt::format("no correction: {}", reason));
    return false;
  }

  Correction correct_pass_by_pass(const SurfaceQuery& surface) {
    const std::optional<double> floor = mesh_floor_mm(settings_, *study_.model, study_.stretched->state, *study_.plan, workers_, monitor_);
    if (!floor) monitor_.message(Severity::Warning, "compensate: the mesh is too coarse for a floor: a cut into tissue that cannot move leaves nothing to measure");
    if (floor) monitor_.message(Severity::Notice, fmt::format("compensate: floor of the mesh {:.3f} mm", *floor));
    const auto cut_of_pass = [&](int pass, const ToolPath& path) {
      SimulatedCut made = pass == 0 ? *study_.as_planned : pass_cut(pass, path);
      cut_of_pass_[pass] = made;
      return made;
    };
    return correct_converging(settings_, *study_.followed, study_.plan->tumor_edge, surface, floor, cut_of_pass, monitor_);
  }

  SimulatedCut pass_cut(int pass, const ToolPath& path) {
    require_overlap_on(path);
    const CutRole role = role_of_pass(pass);
    if (std::optional<SimulatedCut> kept = store_.load_cut(role)) return std::move(*kept);
    const auto start = std::chrono::steady_clock::now();
    SimulatedCut made = simulated(fmt::format("pass {}", pass), role, path);
    store_.save_cut(role, *study_.model, *study_.stretched, made, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return made;
  }

  /// The cut that the correction ended with was made on the way: it is not made again.
  bool verify() {
    const Correction& correction = *study_.correction;
    if (correction.iteration) {
      const int best = static_cast<int>(correction.iteration->best);
      store_.adopt_cut(role_of_pass(best));
      if (const auto made = cut_of_pass_.find(best); made != cut_of_pass_.end()) study_.corrected = std::move(made->second);
      cut_of_pass_.clear();
    }
    if (study_.corrected) {
      study_.stages.push_back({Stage::Verify, StageState::Computed, 0.0});
    } else {
      study_.corrected = cut(Stage::Verify, CutRole::Corrected, correction.moves.path);
    }
    report("the corrected cut", study_.corrected->verdict);
    study_.outcome = study_.corrected->outcome;
    study_.is_accepted = is_accepted(settings_, correction, *study_.as_planned, *study_.corrected);
    return true;
  }

  const Case& settings_;
  Store& store_;
  Workers& workers_;
  Monitor& monitor_;
  Stage until_ = Stage::Verify;
  std::optional<TetMesh> given_mesh_;
  std::optional<Contour> tumor_edge_;
  std::optional<TriMesh> tumor_surface_;
  std::optional<Contour> line_;
  std::optional<ToolPath> given_path_;
  std::map<int, SimulatedCut> cut_of_pass_;  ///< of this run's correction
  Study study_;
};

}  // namespace

const SimulatedCut* verifying_cut(const Study& study) {
  if (study.is_accepted && study.corrected) return &*study.corrected;
  return study.as_planned ? &*study.as_planned : nullptr;
}

Study run_study(const Case& settings, Store& store, Stage until, Workers& workers, Monitor& monitor) {
  return Runner(settings, store, workers, monitor).run(until);
}

}  // namespace incise
