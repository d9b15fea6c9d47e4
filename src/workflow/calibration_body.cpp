#include "workflow/calibration_body.hpp"

#include <incise/core/error.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/cut_doubts.hpp>
#include <incise/workflow/ring_covariates.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kMnPerN = 1000.0;

/// Pull of all displaced constraints together, as a load cell behind them would feel it.
double pull_n(const TissueModel& model, const StaticResult& stretched) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < model.constraints.size() && i < stretched.reactions_mn.size(); ++i) {
    if (std::holds_alternative<DisplacedConstraint>(model.constraints[i])) sum += stretched.reactions_mn[i];
  }
  return sum.norm() / kMnPerN;
}

/// Scales the stiffness that the mesh itself states for its tets.
TetMesh stiffened(TetMesh mesh, double factor) {
  for (const char* name : {"youngs_modulus_kpa", kLaidModulusArray}) {
    const auto array = mesh.cell_data.find(name);
    if (array == mesh.cell_data.end()) continue;
    for (double& value : array->second.values) value *= factor;
  }
  return mesh;
}

void require_stretched(const StaticResult& stretched, double stiffness_of_case) {
  if (stretched.outcome == Outcome::Success) return;
  throw CaseError("case", "specimen",
                  fmt::format("{} (at {:.3g} times its stiffness)", explain_stretch(stretched), stiffness_of_case),
                  "a specimen that can be stretched");
}

}  // namespace

Case with_setting(const Case& settings, const RunSetting& setting) {
  Case changed = settings;
  changed.material.youngs_modulus_kpa *= setting.stiffness_of_case;
  for (LabelMaterial& label : changed.variation.labels) {
    if (label.youngs_modulus_kpa) *label.youngs_modulus_kpa *= setting.stiffness_of_case;
  }
  changed.cut.speed_mm_s = setting.speed_mm_s;
  changed.cut.dullness = setting.dullness;
  changed.frames = 0;
  return changed;
}

CalibrationBody::CalibrationBody(const CalibrationSubject& subject, Workers& workers, Monitor& monitor)
    : subject_(subject) {
  if (subject.settings.plan.kind != PlanKind::Ring) {
    throw CaseError("case", "plan.kind", std::string(to_string(subject.settings.plan.kind)),
                    "ring: a calibration compares rings round a tumour");
  }
  ProductSink none;
  Case planning = subject.settings;
  planning.compensation = {};  // of a corrected cut: it belongs to the planned path, but the case names its own path
  study_ = run_study(planning, *subject.inputs, *subject.cache, {.until = Stage::Plan}, workers, monitor,
                     subject.sink ? *subject.sink : none);
  require_no_locking(*study_.model);
  require_stretched(*study_.stretched, 1.0);
  drawn_edge_ = subject.inputs->read_tumor_edge();
  given_path_ = subject.inputs->read_given_path();
  digest_ = digest_of_all();
  simulated_force_n_ = pull_n(*study_.model, *study_.stretched);
  if (subject.photographed.stretch_force_n && !(simulated_force_n_ > 0.0)) {
    throw CaseError("case", "specimen.constraints", "none that pulls", "one of kind displaced",
                    "A measured force is the force of the stretch");
  }
}

std::string CalibrationBody::digest_of_all() const {
  const Case& settings = subject_.settings;
  const RunSetting none{.speed_mm_s = 1.0, .dullness = 1.0, .stiffness_of_case = 1.0};
  CacheKey key("held");
  key.add(study_.model->mesh)
      .add(settings.material)
      .add(settings.variation)
      .add(settings.toughness)
      .add(settings.constraints);
  key.add(settings.gravity_mm_s2)
      .add(study_.stretched->state)
      .add(unmarked(*study_.plan))
      .add(settings.plan)
      .add(settings.tumor_configuration);
  key.add(settings.surface_tolerance_mm).add(settings.close_margin_mm).add(drawn_edge_);
  key.add(given_path_ ? std::optional(unmarked(*given_path_)) : std::nullopt)
      .add(incision_settings(with_setting(settings, none), given_path_.value_or(*study_.plan)));
  return key.digest();
}

double CalibrationBody::stretched_by_mm() const {
  return stretch_mm(*study_.model);
}

double CalibrationBody::reference_stiffness() const {
  const std::optional<double>& measured = subject_.photographed.stretch_force_n;
  return measured ? *measured / simulated_force_n_ : 1.0;
}

std::vector<double> CalibrationBody::moved_mm() const {
  if (!given_path_) return {};
  const ProfileSettings profile = profile_of_inner_edge(subject_.settings);
  const std::optional<std::vector<double>> planned = error_profile(entry_contour(*study_.plan), tumor_edge(), profile);
  std::optional<std::vector<double>> moved = error_profile(entry_contour(*given_path_), tumor_edge(), profile);
  if (!planned || !moved)
    throw CaseError("case", "path", "a path that does not go round the middle of the tumour's edge",
                    "a ring round the tumour, like the planned path");
  for (std::size_t i = 0; i < moved->size(); ++i) (*moved)[i] -= (*planned)[i];
  return std::move(*moved);
}

RingCovariates CalibrationBody::ring() const {
  return ring_covariates(subject_.settings, *study_.model, study_.stretched->state.positions, tumor_edge(),
                         subject_.settings.material.youngs_modulus_kpa * reference_stiffness());
}

HeldBody CalibrationBody::make(double stiffness_of_case, Workers& workers, Monitor& monitor) {
  if (stiffness_of_case == 1.0)
    return {*study_.model, *study_.stretched, *study_.plan, given_path_.value_or(*study_.plan)};
  const RunSetting stiffness{.stiffness_of_case = stiffness_of_case};
  const Case settings = with_setting(subject_.settings, stiffness);
  HeldBody body{tissue_of(settings, stiffened(study_.model->mesh, stiffness_of_case)), {}, {}, {}};
  body.stretched = stretch(body.model, workers, monitor);
  if (body.stretched.outcome == Outcome::Cancelled) throw Cancelled("the calibration was interrupted");
  require_stretched(body.stretched, stiffness_of_case);
  body.plan = plan_on(settings, body.model, body.stretched.state.positions, drawn_edge_, std::nullopt);
  body.followed = given_path_.value_or(body.plan);
  return body;
}

const HeldBody& CalibrationBody::with_stiffness(double stiffness_of_case, Workers& workers, Monitor& monitor) {
  if (const auto refusal = refusals_.find(stiffness_of_case); refusal != refusals_.end()) throw refusal->second;
  std::unique_ptr<HeldBody>& body = bodies_[stiffness_of_case];
  try {
    if (!body) body = std::make_unique<HeldBody>(make(stiffness_of_case, workers, monitor));
  } catch (const CaseError& error) {
    refusals_.emplace(stiffness_of_case, error);
    throw;
  }
  return *body;
}

ProfileSettings profile_of_inner_edge(const Case& settings) {
  return {.target_mm = settings.plan.lateral_margin_mm - radius_mm(settings.tool),
          .approach = settings.plan.approach,
          .start_direction = settings.plan.start_direction};
}

CalibrationRun run_of(const Case& settings, const RunSetting& setting, IncisionJobResult result, const HeldBody& body) {
  CalibrationRun run;
  run.setting = setting;
  run.reference_step_s = settings.cut.reference_step_s;
  run.problem = result.problem;
  run.wall_s = result.incision.wall_s;
  run.tets = body.model.mesh.tets.size();
  if (!run.problem.empty()) return run;
  const SimulatedCut cut = judge(settings, std::move(result.incision), body.followed, body.plan, run.tets);
  run.outcome = cut.outcome;
  run.closed_loop = cut.incision.is_closed_loop.value_or(false);
  run.paper_success = cut.centerline.paper_success.value_or(false);
  run.signed_error_mm = cut.centerline.signed_error_mm;
  run.inner_signed_error_mm = cut.inner_edge.signed_error_mm;
  run.inner_abs_error_mm = cut.inner_edge.abs_error_mm;
  if (!cut.centerline.errors.signed_distance_mm.empty()) {
    const double paper_target = settings.plan.lateral_margin_mm - radius_mm(settings.tool);
    std::vector<double> errors = cut.centerline.errors.signed_distance_mm;
    for (double& e : errors) e = std::abs(e - paper_target);
    run.paper_abs_error_mm = summarize(errors);
  }
  run.inner_edge = cut.incision.inner_edge;
  run.final_tumor_edge = cut.incision.final_tumor_edge;
  run.ring = shallowest_closed_ring(cut.incision.kerf, settings.plan.approach.normalized());
  return run;
}

}  // namespace incise
