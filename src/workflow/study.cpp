#include <incise/core/error.hpp>
#include <incise/core/memory.hpp>
#include <incise/core/units.hpp>
#include <incise/cutting/cut_invariants.hpp>
#include <incise/cutting/incision_memory.hpp>
#include <incise/cutting/tool_program.hpp>
#include <incise/geometry/contour_checks.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/cut_doubts.hpp>
#include <incise/workflow/cut_verdict.hpp>
#include <incise/workflow/expected_errors.hpp>
#include <incise/workflow/study.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <set>

namespace incise {

namespace {

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

/// Cache entry of a stage.
template <class T>
struct Timed {
  T value;
  double wall_s = 0.0;
};
template <class T>
void describe(Visitor& v, Timed<T>& t) {
  v("value", t.value, "The result that was computed.");
  v("wall_s", t.wall_s, "Time that the computation took.");
}

// An undamaged entry may still come from someone else: nothing in it may point outside the mesh.

/// Lengths of a state's lists of vertices and tets: those of the split mesh for a cut by points.
struct Counts {
  std::size_t vertices, tets;
};
Counts counts_of(const TissueModel& model, const MeshSplits& splits = {}) {
  return {model.mesh.vertices.size() + splits.vertices.size(), model.mesh.tets.size() + splits.copies.size()};
}

bool fits(const TissueModel& model, const Counts& counts, const TissueState& state) {
  const std::size_t strains = is_viscous(model.material) ? counts.tets : 0;
  return state.positions.size() == counts.vertices && state.rotations.size() == counts.tets &&
         state.is_live.size() == counts.tets && (state.fill.empty() || state.fill.size() == counts.tets) &&
         state.memory.strains.size() == strains &&
         state.memory.branches.size() == strains * viscous_terms(model.material).value_or(0) &&
         std::ranges::all_of(state.positions, [](const Vec3& p) { return p.allFinite(); });
}
bool fits(const TissueModel& model, const TissueState& state) {
  return fits(model, counts_of(model), state);
}

template <class Item>
bool are_of(const Counts& counts, const std::vector<Item>& items) {
  return std::ranges::all_of(
      items, [&counts](const Item& item) { return item.tet.is_valid() && item.tet.index() < counts.tets; });
}

/// Whether all corners of tets or triangles are vertices.
template <class Cell>
bool are_of(const Points& vertices, const std::vector<Cell>& cells) {
  return std::ranges::all_of(cells, [&vertices](const Cell& cell) {
    return std::ranges::all_of(cell, [&vertices](VertexId v) { return v.is_valid() && v.index() < vertices.size(); });
  });
}

bool fits(const TissueModel& model, const CutState& state) {
  const Counts counts = counts_of(model, state.splits);
  return fits(model, counts, state.tissue) && state.dose.size() == counts.tets &&
         state.tear_dose.size() == counts.tets && are_of(counts, state.bonds) &&
         are_of(counts, state.record.removals) && find_problem(model, state).empty();
}

bool fits(const Counts& counts, const std::vector<CutFrame>& frames) {
  return std::ranges::all_of(frames,
                             [&counts](const CutFrame& frame) { return frame.positions.size() == counts.vertices; });
}

/// Frames of an unfinished cut have the vertices that existed when they were recorded.
bool fits(const TissueModel& model, const IncisionProgress& progress) {
  const Counts least = counts_of(model), most = counts_of(model, progress.state.splits);
  return fits(model, progress.state) && std::ranges::all_of(progress.frames, [&](const CutFrame& frame) {
           const std::size_t vertices = frame.positions.size();
           return vertices >= least.vertices && vertices <= most.vertices;
         });
}

bool fits(const TissueModel& model, const IncisionResult& result) {
  const TriMesh& body = result.kerf.body.surface;
  const DepthReached& depth = result.kerf.depth;
  const std::size_t places = depth.profile.course.points.size();
  const Counts counts = counts_of(model, result.final_state.splits);
  return fits(model, result.final_state) && result.steps.size() >= static_cast<std::size_t>(result.final_state.step) &&
         fits(counts, result.frames) && are_of(counts, result.record.removals) &&
         are_of(body.vertices, body.triangles) && depth.profile.arclength_mm.size() == places &&
         depth.profile.depth_mm.size() == places && depth.planned_at_mm.size() == places;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The cache slot of a checkpoint of an unfinished cut.
std::string checkpoint_slot(const std::string& cut) {
  return cut + ".checkpoint";
}

/// One run on its way through the stages.
class Runner {
 public:
  Runner(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options, Workers& workers,
         Monitor& monitor, ProductSink& sink)
      : settings_(settings),
        inputs_(inputs),
        cache_(cache),
        options_(options),
        workers_(workers),
        monitor_(monitor),
        sink_(sink),
        must_resume_(options.must_resume) {}

  Study run() {
    using Step = bool (Runner::*)();
    static constexpr std::array<Step, 7> kSteps{&Runner::segment, &Runner::mesh,     &Runner::stretch_tissue,
                                                &Runner::plan,    &Runner::simulate, &Runner::compensate,
                                                &Runner::verify};
    read_inputs();
    for (std::size_t i = 0; i <= static_cast<std::size_t>(options_.until); ++i) {
      throw_if_cancelled(monitor_, "the run");
      if (static_cast<Stage>(i) == Stage::Simulate && goes_without_simulation()) {
        study_.stages.push_back({Stage::Simulate, StageState::Skipped, 0.0});
        choose_path();
        for (const char* cut : {"as_planned", "corrected"}) sink_.absent(cut);
        continue;
      }
      if (!(this->*kSteps[i])()) break;
    }
    if (must_resume_) refuse_to_resume("cuts that are all finished");
    if (options_.until >= Stage::Compensate && !study_.correction) sink_.absent("correction");
    if (options_.until >= Stage::Verify && !study_.corrected) sink_.absent("corrected");
    const bool was_correction_asked = options_.until >= Stage::Verify && settings_.plan.kind == PlanKind::Ring;
    hand_over_verdicts(was_correction_asked && !study_.is_accepted);
    if (study_.plan && !study_.as_planned) refuse_before_cut();
    study_.verdict = verdict_of_run(
        settings_, study_.about_inputs, verifying_cut(study_),
        was_correction_asked && !study_.is_accepted ? std::optional(study_.correction_note) : std::nullopt);
    return std::move(study_);
  }

 private:
  /// Returns whether the run needs no cut: a correction by photographs that is not verified.
  [[nodiscard]] bool goes_without_simulation() const {
    return options_.until == Stage::Compensate && settings_.compensation.method == CompensationMethod::Profile;
  }

  /// Reads the small inputs first: a damaged contour is reported before any long computation.
  void read_inputs() {
    tumor_edge_ = inputs_.read_tumor_edge();
    tumor_surface_ = inputs_.read_tumor_surface();
    line_ = inputs_.read_line();
    given_path_ = inputs_.read_given_path();
    const bool is_ring = settings_.plan.kind == PlanKind::Ring;
    if (given_path_ && given_path_->is_closed != is_ring) {
      throw CaseError("case", "path", given_path_->is_closed ? "a closed path" : "an open path",
                      is_ring ? "a closed path for plan.kind: ring" : "an open path for plan.kind: line");
    }
    if (given_path_ && expects_by_direction(settings_.compensation)) {
      throw CaseError("case", "path", "a given path, and errors that are expected along the planned one",
                      "one of the two", "Leave out path, or photographed_mm, residual_mm and simulated_share");
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
    if (problem) throw CaseError("case", "tumor.surface", problem->found, problem->expected, "Lengths are in mm");
  }

  [[noreturn]] static void refuse_to_resume(const std::string& found) {
    throw CaseError("command line", "--resume", found, "an interrupted cut of this case, with its settings and inputs",
                    "Without --resume, missing results are computed from the beginning");
  }

  /// Adds how the specimen is held and what it consists of.
  void add_specimen(CacheKey& key) const {
    key.add(settings_.material).add(settings_.variation).add(settings_.gravity_mm_s2).add(settings_.constraints);
  }

  /// Adds everything but the tissue that determines the path. The power does not.
  void add_plan(CacheKey& key) const {
    PlanSettings plan = settings_.plan;
    plan.power_w = PlanSettings{}.power_w;
    key.add(plan).add(settings_.tumor_configuration).add(settings_.surface_tolerance_mm).add(tumor_edge_).add(line_);
  }

  /// Takes a product from the cache, or makes and keeps it; reports which, and the time it took.
  template <class T, class Make>
  T product(Stage stage, ProductNote& note, const CacheKey& key, const Make& make, bool may_resume_in_it = false) {
    const auto start = std::chrono::steady_clock::now();
    note.key = key.digest();
    bool is_made = false;
    const auto make_in_time = [&] {
      if (must_resume_ && !may_resume_in_it)
        refuse_to_resume(fmt::format("no finished {} of this case", to_string(stage)));
      is_made = true;
      Timed<T> made{make(), 0.0};
      made.wall_s = seconds_since(start);
      return made;
    };
    Timed<T> timed = cache_.get_or_make<Timed<T>>(
        note.name, key, monitor_, [this](const Timed<T>& kept) { return fits_mesh(kept.value); }, make_in_time);
    note.wall_s = timed.wall_s;
    if (is_made) {
      report_done(stage, timed.wall_s);
    } else {
      study_.stages.push_back({stage, StageState::Reused, seconds_since(start)});
    }
    return std::move(timed.value);
  }

  /// Returns whether a product is consistent, also with the mesh if it refers to one.
  template <class T>
  bool fits_mesh(const T& value) const {
    if constexpr (std::is_same_v<T, StaticResult>) return fits(*study_.model, value.state);
    if constexpr (std::is_same_v<T, MeshProduct>) return are_of(value.meshing.mesh.vertices, value.meshing.mesh.tets);
    if constexpr (std::is_same_v<T, Segmentation>) {
      const std::size_t voxels = value.labels.grid.voxel_count();
      const auto is_of = [&](const MadeVoxel& made) {
        return made.voxel >= 0 && static_cast<std::size_t>(made.voxel) < voxels && made.side >= 0 && made.side < 6;
      };
      return value.labels.voxels.size() == voxels &&
             value.occupancy.voxels.size() == value.occupancy.grid.voxel_count() &&
             std::ranges::all_of(value.cut, is_of) && std::ranges::all_of(value.painted, is_of);
    }
    if constexpr (std::is_same_v<T, Correction>)
      return !value.iteration || value.iteration->best < value.iteration->passes.size();
    return true;
  }

  void report_done(Stage stage, double wall_s) {
    study_.stages.push_back({stage, StageState::Computed, wall_s});
    monitor_.message(Severity::Notice, fmt::format("{}: done in {:.1f} s", to_string(stage), wall_s));
  }

  bool segment() {
    given_mesh_ = inputs_.read_specimen_mesh(monitor_);
    if (given_mesh_) {
      study_.stages.push_back({Stage::Segment, StageState::Skipped, 0.0});
      return true;
    }
    CacheKey key("labels");
    key.add(settings_.segmentation).add_text(inputs_.scan_digest(monitor_));
    ProductNote note{"labels", {}, 0.0};
    study_.segmentation = product<Segmentation>(Stage::Segment, note, key, [&] {
      if (const auto labels = inputs_.read_labels(monitor_))
        return segment_labels(*labels, settings_.segmentation, workers_, monitor_);
      return incise::segment(inputs_.read_ct(monitor_), settings_.segmentation, workers_, monitor_);
    });
    sink_.labels(note, *study_.segmentation);
    report("the scan", study_.segmentation->verdict);
    study_.about_inputs.add(study_.segmentation->verdict);
    made_skin_ = MadeSkin(*study_.segmentation);
    return true;
  }

  bool mesh() {
    sources_ = read_material_sources(settings_, inputs_, monitor_);
    TetMesh mesh;
    if (given_mesh_) {
      mesh = std::move(*given_mesh_);
      study_.stages.push_back({Stage::Mesh, StageState::Skipped, 0.0});
    } else {
      CacheKey key = CacheKey("mesh").add(study_.segmentation->occupancy).add(settings_.meshing);
      add_specimen(key);
      add_plan(key);
      key.add_text(digest_of(sources_));
      ProductNote note{"mesh", {}, 0.0};
      MeshProduct made = product<MeshProduct>(Stage::Mesh, note, key, [&] { return make_mesh(); });
      sink_.mesh(note, made);
      mesh = std::move(made.meshing.mesh);
    }
    if (const std::optional<MapCoverage> map = lay_on_mesh(settings_, sources_, mesh)) {
      monitor_.message(Severity::Notice,
                       fmt::format("elasticity map: {:.4g} to {:.4g} kPa, known in {:.0f} % of the specimen",
                                   map->least_kpa, map->greatest_kpa, 100.0 * map->share));
      report("the elasticity map", verdict_of_map(*map));
      study_.about_inputs.add(verdict_of_map(*map));
    }
    sources_ = {};  // they may be large
    require_memory(mesh);
    study_.model = std::make_shared<TissueModel>(tissue_of(settings_, std::move(mesh)));
    require_memory_of_points(*study_.model);
    if (options_.until >= Stage::Simulate) require_no_locking(*study_.model);
    return true;
  }

  [[nodiscard]] std::uint64_t memory_of(const TetMesh& mesh, int frames) const {
    return expected_memory_bytes(mesh.vertices.size(), mesh.tets.size(), settings_.material.volume, frames,
                                 viscous_terms(settings_.material));
  }

  /// Reports the memory that the rest needs, and refuses the run if less is available.
  void require_memory(const TetMesh& mesh) {
    const std::uint64_t needed = memory_of(mesh, settings_.frames);
    const std::optional<std::uint64_t> held = held_memory_bytes();
    monitor_.message(Severity::Notice,
                     fmt::format("tissue: {} tets, {} vertices; stretching and cutting it takes about {:.0f} MB{}",
                                 mesh.tets.size(), mesh.vertices.size(), megabytes(needed),
                                 held ? fmt::format(" beyond the {:.0f} MB in use", megabytes(*held)) : ""));
    refuse_without(needed, mesh.tets.size());
  }

  /// Does the same for what a cut by points needs besides.
  void require_memory_of_points(const TissueModel& model) {
    if (settings_.cut.rule != CutRule::Lattice || options_.until < Stage::Simulate || goes_without_simulation()) return;
    const std::uint64_t needed = expected_point_memory_bytes(memory_of(model.mesh, 0), model.volumes_mm3,
                                                             planned_length_mm(), planned_depth_mm(), settings_.cut);
    monitor_.message(Severity::Notice, fmt::format("cut by points: takes about {:.0f} MB more", megabytes(needed)));
    refuse_without(memory_of(model.mesh, settings_.frames) + needed, model.mesh.tets.size());
  }

  void refuse_without(std::uint64_t needed, std::size_t tets) const {
    const std::optional<std::uint64_t> available = available_memory_bytes();
    if (!available || needed <= *available) return;
    throw DataError("this machine", "memory", fmt::format("{:.0f} MB available", megabytes(*available)),
                    fmt::format("about {:.0f} MB for {} tets", megabytes(needed), tets),
                    "A coarser mesh needs less: meshing.fine_mm, meshing.coarse_mm, meshing.tets");
  }

  /// Returns the approximate length of the path, which is planned later, on the stretched tissue.
  [[nodiscard]] double planned_length_mm() const {
    if (given_path_) return length_mm(entry_contour(*given_path_));
    if (settings_.plan.kind == PlanKind::Line) return line_ ? length_mm(*line_) : 0.0;
    return tumor_edge_ ? length_mm(*tumor_edge_) + 2.0 * units::kPi * settings_.plan.lateral_margin_mm : 0.0;
  }
  [[nodiscard]] double planned_depth_mm() const {
    if (!given_path_) return settings_.plan.depth_mm;
    double deepest = 0.0;
    for (const Waypoint& waypoint : given_path_->waypoints) deepest = std::max(deepest, waypoint.depth_mm);
    return deepest;
  }

  /// The mesher reports impossible lengths or counts as a broken precondition; here they came from the case.
  MeshProduct make_mesh() {
    try {
      return mesh_around_planned_cut(settings_, study_.segmentation->occupancy, tumor_edge_, line_, workers_, monitor_,
                                     made_skin_, sources_);
    } catch (const InvalidArgument& error) {
      throw CaseError("case", "meshing", error.text(),
                      "edge lengths and a number of tets with which the tissue can be meshed");
    }
  }

  bool stretch_tissue() {
    const TissueModel& model = *study_.model;
    CacheKey key = CacheKey("stretched").add(model.mesh);
    add_specimen(key);
    ProductNote note{"stretched", {}, 0.0};
    study_.stretched = product<StaticResult>(Stage::Stretch, note, key, [&] {
      StaticResult made = stretch(model, workers_, monitor_);
      if (made.outcome == Outcome::Cancelled) throw Cancelled("the stretch was interrupted and will start over");
      return made;
    });
    sink_.stretched(note, model, *study_.stretched);
    study_.outcome = study_.stretched->outcome;
    if (study_.outcome != Outcome::Success) monitor_.message(Severity::Warning, explain_stretch(*study_.stretched));
    return study_.outcome == Outcome::Success;
  }

  bool plan() {
    CacheKey key = CacheKey("plan").add(study_.model->mesh).add(study_.stretched->state.positions);
    add_plan(key);
    ProductNote note{"plan", {}, 0.0};
    study_.plan = product<ToolPath>(Stage::Plan, note, key, [&] {
      return plan_on(settings_, *study_.model, study_.stretched->state.positions, tumor_edge_, line_, made_skin_);
    });
    sink_.plan(note, *study_.plan);
    CacheKey held = CacheKey("held").add(study_.model->mesh).add(study_.stretched->state).add(settings_.toughness);
    add_specimen(held);
    held_ = held.digest();
    return true;
  }

  /// Returns the key of a cut along a path into the held tissue.
  CacheKey key_of_cut(const ToolPath& path) const {
    ToolPath course = unmarked(path);
    course.tumor_edge = study_.plan->tumor_edge;
    return CacheKey("cut").add_text(held_).add(course).add(incision_settings_for(settings_, path, placed_tumor()));
  }

  /// The tool continues beyond the start of a ring, but not round it again.
  void require_overlap_on(const ToolPath& path) const {
    const double round_mm = tip_way_mm(path);
    if (!path.is_closed || settings_.cut.overlap_mm < round_mm) return;
    throw CaseError("case", "cut.overlap_mm", fmt::format("{} mm", settings_.cut.overlap_mm),
                    fmt::format("less than the {:.1f} mm that the tip travels round the ring", round_mm));
  }

  /// Attaches objections that already refuse the plan to its path, although no cut was made.
  void refuse_before_cut() {
    const auto refusals = [this](const char* what, const ToolPath& path) -> std::optional<Verdict> {
      const Verdict of_path =
          verdict_before_cut(settings_, *study_.model, made_skin_, study_.stretched->state.positions, path);
      Verdict early = study_.about_inputs;
      early.add(of_path);
      if (early.status() != VerdictStatus::Refused) return std::nullopt;
      if (of_path.status() == VerdictStatus::Refused) report(what, of_path);
      return refusals_of(early, "the run ended before it cut along the path");
    };
    const std::optional<Verdict> of_plan = refusals("the plan", *study_.plan);
    std::optional<Verdict> of_correction;
    if (study_.correction) of_correction = refusals("the corrected path", study_.correction->moves.path);
    if (of_plan || of_correction) sink_.verdicts(of_plan, of_correction);
  }

  /// Hands over the verdicts, so that the file of a path shows them.
  void hand_over_verdicts(bool is_correction_rejected) {
    const auto of = [&](const std::optional<SimulatedCut>& cut,
                        const std::string& rejection) -> std::optional<Verdict> {
      if (!cut) return std::nullopt;
      Verdict verdict = study_.about_inputs;
      verdict.add(cut->verdict);
      if (is_correction_rejected) verdict.add("not_corrected", {}, rejection);
      return verdict;
    };
    sink_.verdicts(given_path_ ? std::nullopt : of(study_.as_planned, uncorrected_path(study_.correction_note)),
                   of(study_.corrected, rejected_correction(study_.correction_note)));
  }

  /// Returns a cut with its verdict.
  SimulatedCut judged(IncisionResult incision, const ToolPath& path) const {
    SimulatedCut cut = judge(settings_, std::move(incision), path, *study_.plan, study_.model->mesh.tets.size());
    const SimulatedCut& along_plan = study_.as_planned ? *study_.as_planned : cut;
    cut.verdict = verdict_of_cut(settings_, cut, expected_errors(settings_, along_plan, study_.plan->tumor_edge));
    cut.verdict.add(verdict_before_cut(settings_, *study_.model, made_skin_, study_.stretched->state.positions, path));
    return cut;
  }

  using KeptCut = Timed<SimulatedCut>;

  std::optional<KeptCut> find_cut(const std::string& name, const CacheKey& key, const ToolPath& path) {
    auto kept = cache_.find<Timed<IncisionResult>>(
        name, key, monitor_, [this](const Timed<IncisionResult>& cut) { return fits(*study_.model, cut.value); });
    if (!kept) return std::nullopt;
    cache_.remove(checkpoint_slot(name));  // left by a run that was killed after it kept the cut
    return KeptCut{judged(std::move(kept->value), path), kept->wall_s};
  }

  void keep_cut(const std::string& name, const CacheKey& key, KeptCut& made) {
    Timed<IncisionResult> timed{std::move(made.value.incision), made.wall_s};  // large: moved here and back, not copied
    cache_.keep(name, key, timed);
    made.value.incision = std::move(timed.value);
    cache_.remove(checkpoint_slot(name));
  }

  /// Simulates a cut, from its checkpoint or from the beginning, and keeps it.
  /// @param what  name of the stage or pass, for messages.
  KeptCut make_cut(std::string_view what, const std::string& name, const CacheKey& key, const ToolPath& path) {
    const auto start = std::chrono::steady_clock::now();
    const std::string slot = checkpoint_slot(name);
    std::optional<IncisionProgress> from = cache_.find<IncisionProgress>(
        slot, key, monitor_, [this](const IncisionProgress& progress) { return fits(*study_.model, progress); });
    if (must_resume_ && !from) refuse_to_resume(fmt::format("no checkpoint of the cut {} that fits", name));
    must_resume_ = false;
    if (from) {
      monitor_.message(Severity::Notice, fmt::format("{}: continues after step {}", what, from->state.step));
    } else if (cache_.holds(slot)) {
      monitor_.message(
          Severity::Notice,
          fmt::format("{}: its checkpoint is from other settings, inputs or another build, or is damaged; the cut "
                      "starts from the beginning",
                      what));
    }
    auto last_kept = start;
    const auto keep_checkpoint = [&](const IncisionProgress& progress, bool is_interrupted) {
      if (!is_interrupted && seconds_since(last_kept) < options_.checkpoint_s) return;
      try {
        cache_.keep(slot, key, progress);
        last_kept = std::chrono::steady_clock::now();
      } catch (const DataError& error) {
        if (is_interrupted) throw;  // the whole cut would be lost
        monitor_.message(Severity::Warning, fmt::format("{}. The cut continues without a checkpoint", error.what()));
      }
    };
    const auto keep = [&](const IncisionProgress& progress, bool is_interrupted) {
      keep_checkpoint(progress, is_interrupted);
      if (options_.watch) options_.watch(name, *study_.model, progress);
    };
    const IncisionSettings incision = incision_settings_for(settings_, path, placed_tumor());
    const TissueState& stretched = study_.stretched->state;
    ToolPath with_edge = path;
    with_edge.tumor_edge = study_.plan->tumor_edge;
    if (!from) from = begin_incision(*study_.model, stretched, with_edge, incision);
    IncisionResult made =
        continue_incision(*study_.model, stretched, with_edge, incision, std::move(*from), workers_, monitor_, keep);
    if (made.outcome == Outcome::Cancelled) {
      throw CutInterrupted(fmt::format("the cut was interrupted after step {}", made.final_state.step), slot);
    }
    KeptCut whole{judged(std::move(made), path), seconds_since(start)};
    keep_cut(name, key, whole);
    made_.insert(key.digest());
    return whole;
  }

  /// Returns the cut of a stage, from the cache or simulated. @param also  another slot that may hold it.
  SimulatedCut cut(Stage stage, const std::string& name, const ToolPath& path, const std::string& also = {}) {
    require_overlap_on(path);
    const auto start = std::chrono::steady_clock::now();
    const CacheKey key = key_of_cut(path);
    std::optional<KeptCut> there = find_cut(name, key, path);
    if (!there && !also.empty()) {
      there = find_cut(also, key, path);
      if (there) keep_cut(name, key, *there);
    }
    if (there) {
      const bool is_of_this_run = made_.contains(key.digest());
      study_.stages.push_back({stage, is_of_this_run ? StageState::Computed : StageState::Reused,
                               is_of_this_run ? 0.0 : seconds_since(start)});
    } else {
      there = make_cut(to_string(stage), name, key, path);
      report_done(stage, there->wall_s);
    }
    sink_.cut({name, key.digest(), there->wall_s}, *study_.model, *study_.stretched, there->value);
    return std::move(there->value);
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

  /// Chooses the path to follow: the planned one, or the given one after checks.
  void choose_path() {
    if (given_path_) {
      require_reached();
      check_path(*given_path_, SurfaceQuery(skin_of(study_.model->mesh, study_.stretched->state.positions)), settings_.plan.approach);
    }
    study_.followed = given_path_ ? *given_path_ : *study_.plan;
  }

  bool simulate() {
    choose_path();
    study_.as_planned = cut(Stage::Simulate, name_of_pass(0), *study_.followed);
    report("the cut as planned", study_.as_planned->verdict);
    study_.outcome = study_.as_planned->outcome;
    return true;
  }

  bool compensate() {
    const CompensationMethod method = settings_.compensation.method;
    const bool is_paper = method == CompensationMethod::Paper;
    const bool is_ring = settings_.plan.kind == PlanKind::Ring;
    if (!is_ring) return skip_correction("it needs a ring");
    if (is_paper && !study_.as_planned->incision.centerline)
      return skip_correction("it needs a ring whose mid-line could be measured");
    const CacheKey key = CacheKey("correction")
                             .add_text(key_of_cut(*study_.followed).digest())
                             .add(settings_.compensation)
                             .add(settings_.close_margin_mm)
                             .add(settings_.plan)
                             .add(unmarked(*study_.plan))
                             .add(unmarked(*study_.followed));
    ProductNote note{"correction", {}, 0.0};
    const auto make = [&] {
      const SurfaceQuery surface(skin_of(study_.model->mesh, study_.stretched->state.positions));
      const Contour& edge = study_.plan->tumor_edge;
      if (method == CompensationMethod::Profile) return correct_by_profile(settings_, *study_.followed, edge, surface);
      return is_paper ? correct_as_paper(settings_, *study_.followed, *study_.as_planned, edge, surface)
                      : correct_pass_by_pass(surface);
    };
    study_.correction = product<Correction>(Stage::Compensate, note, key, make, true);
    sink_.correction(note, *study_.correction);
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
    if (!floor) monitor_.message(Severity::Warning, "compensate: no mesh-resolution limit: on this mesh, a cut into "
                                                    "tissue that cannot move leaves nothing to measure");
    if (floor) monitor_.message(Severity::Notice, fmt::format("compensate: mesh-resolution limit {:.3f} mm", *floor));
    const auto cut_of_pass = [&](int pass, const ToolPath& path) {
      return pass == 0 ? *study_.as_planned : pass_cut(pass, path);
    };
    return correct_converging(settings_, *study_.followed, study_.plan->tumor_edge, surface, floor, cut_of_pass, monitor_);
  }

  SimulatedCut pass_cut(int pass, const ToolPath& path) {
    require_overlap_on(path);
    const std::string name = name_of_pass(pass);
    const CacheKey key = key_of_cut(path);
    std::optional<KeptCut> there = find_cut(name, key, path);
    if (!there) there = make_cut(fmt::format("pass {}", pass), name, key, path);
    return std::move(there->value);
  }

  /// Verifies the correction. With the default method, its cut was made during the iteration and is not repeated. The
  /// cuts of the other passes are no longer needed.
  bool verify() {
    const Correction& correction = *study_.correction;
    const std::string pass =
        correction.iteration ? name_of_pass(static_cast<int>(correction.iteration->best)) : std::string();
    study_.corrected = cut(Stage::Verify, "corrected", correction.moves.path, pass);
    for (int k = 1; k <= kMostPasses; ++k) {
      cache_.remove(name_of_pass(k));
      cache_.remove(checkpoint_slot(name_of_pass(k)));
    }
    report("the corrected cut", study_.corrected->verdict);
    study_.outcome = study_.corrected->outcome;
    study_.correction_note = objection_to(settings_, correction, *study_.as_planned, *study_.corrected);
    study_.is_accepted = study_.correction_note.empty();
    return true;
  }

  const Case& settings_;
  Inputs& inputs_;
  Cache& cache_;
  const RunOptions& options_;
  Workers& workers_;
  Monitor& monitor_;
  ProductSink& sink_;
  bool must_resume_;  ///< the run has to resume a cut and has not done so yet
  std::optional<TetMesh> given_mesh_;
  MadeSkin made_skin_;
  MaterialSources sources_;
  std::optional<Contour> tumor_edge_;
  std::optional<TriMesh> tumor_surface_;
  std::optional<Contour> line_;
  std::optional<ToolPath> given_path_;
  std::set<std::string> made_;  ///< digests of the cuts that this run has made
  std::string held_;            ///< digest of the held tissue before the cut
  Study study_;
};

}  // namespace

const SimulatedCut* verifying_cut(const Study& study) {
  if (study.is_accepted && study.corrected) return &*study.corrected;
  return study.as_planned ? &*study.as_planned : nullptr;
}

std::string name_of_pass(int pass) {
  return pass == 0 ? std::string("as_planned") : fmt::format("pass_{}", pass);
}

Study run_study(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options, Workers& workers,
                Monitor& monitor, ProductSink& sink) {
  return Runner(settings, inputs, cache, options, workers, monitor, sink).run();
}

Study run_study(const Case& settings, Inputs& inputs, Cache& cache, const RunOptions& options, Workers& workers,
                Monitor& monitor) {
  ProductSink none;
  return run_study(settings, inputs, cache, options, workers, monitor, none);
}

}  // namespace incise
