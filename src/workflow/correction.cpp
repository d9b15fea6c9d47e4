#include <incise/core/error.hpp>
#include <incise/evaluation/error_profile.hpp>
#include <incise/geometry/surface_query.hpp>
#include <incise/planning/shift_path.hpp>
#include <incise/workflow/correction.hpp>
#include <incise/workflow/cut_verdict.hpp>
#include <incise/workflow/study.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace incise {
namespace {

constexpr std::string_view kNoSuccess = "is open, touches the tumour's edge or did not converge";

/// Errors of the inner edge, tool out, at the places of its points in the stretched tissue before the cut.
PathErrors inner_edge_errors(const SimulatedCut& cut) {
  const Contour& seen = *cut.incision.inner_edge;
  const Contour& reference = *cut.incision.kerf.inner_edge_reference;
  PathErrors errors;
  errors.signed_error_mm = cut.inner_edge.errors.signed_error_mm;
  for (const Vec3& p : cut.inner_edge.errors.points.points) {
    const ContourPoint at = nearest_on(seen, p);
    const Vec3& start = reference.points[at.segment];
    const Vec3& end = reference.points[(at.segment + 1) % reference.points.size()];
    errors.places.push_back(start + at.fraction * (end - start));
  }
  errors.is_success = cut.outcome == Outcome::Success && cut.inner_edge.outcome == Outcome::Success;
  return errors;
}

/// Errors of the mid-line of the shallowest closed layer, at the skin's height; for an inner edge, of a line nearer to
/// the tumour by half the kerf's width there.
std::optional<PathErrors> layer_path_errors(const Case& settings, const SimulatedCut& cut, const Contour& tumor_edge,
                                            Monitor& monitor) {
  const std::optional<ClosedRing> ring = shallowest_closed_ring(cut.incision.kerf, settings.plan.approach.normalized());
  if (!ring) return std::nullopt;
  ContourErrors found =
      contour_errors(ring->midline, tumor_edge, settings.plan.lateral_margin_mm, settings.plan.approach);
  if (settings.compensation.observable == ContourKind::InnerEdge) {  // its target is nearer by the radius, too
    for (double& error : found.signed_error_mm) error -= ring->half_width_mm - radius_mm(settings.tool);
  }
  monitor.message(
      Severity::Notice,
      fmt::format("the ring is open near the skin; its path is corrected by the {} {} mm deep",
                  settings.compensation.observable == ContourKind::InnerEdge ? "mid-line minus half the kerf's width"
                                                                             : "mid-line",
                  ring->depth_mm));
  return PathErrors{std::move(found.points.points), std::move(found.signed_error_mm), 0.0, false};
}

/// Depth, mm, that the kerf lacks of the least depth accepted without a caution, averaged over the path.
double mean_shortfall_mm(const Case& settings, const SimulatedCut& cut) {
  const std::vector<DepthShare> shares = depth_shares(settings, cut.incision.kerf.depth);
  if (shares.empty()) return 0.0;
  const double limit = *verdict_rule("depth").limit;
  double missing = 0.0;
  for (const DepthShare& one : shares) missing += one.planned_mm * std::max(0.0, limit - one.share);
  return missing / static_cast<double>(shares.size());
}

/// Verdict on a cut by objections that another path may remove. Heat is not among them: it follows from the intended
/// place of the cut.
VerdictStatus status_of_course(const Verdict& verdict) {
  constexpr std::array<std::string_view, 6> kOfCourse{"outcome",    "tumor_distance", "lateral_margin",
                                                      "open_layer", "depth",          "convergence"};
  VerdictStatus worst = VerdictStatus::Ok;
  for (const VerdictReason& reason : verdict.reasons()) {
    if (std::find(kOfCourse.begin(), kOfCourse.end(), reason.id) != kOfCourse.end())
      worst = std::max(worst, reason.severity);
  }
  return worst;
}

/// Returns what a correction loses in depth or closure; empty: nothing. It may leave no more layers open than the first
/// cut, and its least depth must reach the rule's limit or that of the first cut.
std::string loss_of_depth_or_closure(const Case& settings, const SimulatedCut& first, const SimulatedCut& corrected) {
  const std::vector<double> open = open_layers_mm(corrected.incision), before = open_layers_mm(first.incision);
  if (open.size() > before.size())
    return fmt::format(
        "it leaves more of the planned depth open, where uncut tissue still holds the piece: {} of the measured layers "
        "({} mm deep); the cut before left {}",
        open.size(), fmt::join(open, ", "), before.size());
  const auto least = [&settings](const SimulatedCut& cut) {
    const std::vector<DepthShare> shares = depth_shares(settings, cut.incision.kerf.depth);
    return shares.empty() ? 0.0 : std::ranges::min(shares, {}, &DepthShare::share).share;
  };
  if (least(corrected) >= std::min(*verdict_rule("depth").limit, least(first))) return {};
  return fmt::format("at its shallowest it reaches {:.0f} % of the planned depth, the cut before {:.0f} %",
                     100.0 * least(corrected), 100.0 * least(first));
}

ConvergenceSettings convergence_settings(const Case& settings, double floor_mm) {
  ConvergenceSettings convergence;
  convergence.region = safe_region(settings);
  convergence.simulations = 1 + kUsualPasses;
  convergence.more_simulations = kMostPasses - kUsualPasses;
  convergence.floor_mm = floor_mm;
  if (settings.compensation.bias_mm != 0.0) convergence.bias_mm = {settings.compensation.bias_mm};
  convergence.simulated_share = settings.compensation.simulated_share;
  return convergence;
}

std::string in_words(int pass, const std::optional<PathErrors>& errors) {
  const std::string name = pass == 0 ? std::string("as planned") : fmt::format("pass {}", pass);
  if (!errors) return fmt::format("compensate: {}: nothing to measure", name);
  double sum = 0.0;
  for (const double e : errors->signed_error_mm) sum += std::abs(e);
  return fmt::format("compensate: {}: mean |error| {:.3f} mm", name,
                     sum / static_cast<double>(errors->signed_error_mm.size()));
}

/// Returns why no pass replaced the first cut although one came nearer; empty if none did.
std::string why_none_was_kept(const ConvergedCompensation& done) {
  const CompensationPass& first = done.passes.front();
  const CompensationPass* nearest = nullptr;
  for (const CompensationPass& pass : done.passes) {
    if (!pass.mean_abs_error_mm || (first.mean_abs_error_mm && *pass.mean_abs_error_mm >= *first.mean_abs_error_mm))
      continue;
    if (nearest == nullptr || *pass.mean_abs_error_mm < *nearest->mean_abs_error_mm) nearest = &pass;
  }
  if (nearest == nullptr) return {};
  const std::string worse =
      nearest->open_layers > first.open_layers
          ? fmt::format("leaves more layers open ({} instead of {})", nearest->open_layers, first.open_layers)
      : nearest->is_success < first.is_success ? std::string(kNoSuccess)
      : nearest->verdict > first.verdict
          ? fmt::format("is {} instead of {}", to_string(nearest->verdict), to_string(first.verdict))
          : fmt::format("falls {:.2f} mm short in depth instead of {:.2f} mm", nearest->shortfall_mm,
                        first.shortfall_mm);
  return fmt::format("; the pass that came nearest, with a mean |error| of {:.2f} mm, {}", *nearest->mean_abs_error_mm,
                     worse);
}

}  // namespace

SafeRegion safe_region(const Case& settings) {
  return {.close_margin_mm = settings.close_margin_mm,
          .electrode_radius_mm = radius_mm(settings.tool),
          .rim_clearance_mm = settings.plan.rim_clearance_mm,
          .approach = settings.plan.approach,
          .axis_mode = settings.plan.axis_mode};
}

std::vector<double> values_at_waypoints(const Case& settings, const std::vector<double>& sectors, const ToolPath& path,
                                        const Contour& tumor_edge) {
  return values_at(sectors, entry_contour(path).points, tumor_edge,
                   {.approach = settings.plan.approach, .start_direction = settings.plan.start_direction});
}

std::optional<PathErrors> path_errors(const Case& settings, const SimulatedCut& cut, const Contour& tumor_edge,
                                      Monitor& monitor) {
  std::optional<PathErrors> errors;
  const bool is_by_edge = settings.compensation.observable == ContourKind::InnerEdge;
  if (is_by_edge && cut.incision.inner_edge && cut.incision.kerf.inner_edge_reference && cut.inner_edge.abs_error_mm) {
    errors = inner_edge_errors(cut);
  } else if (!is_by_edge && cut.centerline.abs_error_mm && cut.incision.is_closed_loop.value_or(false)) {
    const ContourErrors& found = cut.centerline.errors;
    errors = PathErrors{found.points.points, found.signed_error_mm, 0.0, cut.outcome == Outcome::Success};
  } else {
    errors = layer_path_errors(settings, cut, tumor_edge, monitor);
  }
  if (!errors) return errors;
  if (cut.incision.kerf.drag) errors->lag_mm = std::max(0.0, cut.incision.kerf.drag->lag.mean);
  errors->shortfall_mm = mean_shortfall_mm(settings, cut);
  errors->open_layers = static_cast<int>(open_layers_mm(cut.incision).size());
  errors->is_success = errors->is_success && errors->open_layers == 0;
  errors->verdict = status_of_course(cut.verdict);
  return errors;
}

Correction correct_as_paper(const Case& settings, const ToolPath& followed, const SimulatedCut& cut,
                            const Contour& tumor_edge, const SurfaceQuery& surface) {
  const CompensationSettings compensation{.target_mm = settings.plan.lateral_margin_mm,
                                          .close_margin_mm = settings.close_margin_mm,
                                          .electrode_radius_mm = radius_mm(settings.tool),
                                          .approach = settings.plan.approach,
                                          .axis_mode = settings.plan.axis_mode};
  return {.method = CompensationMethod::Paper,
          .moves = compensate_paper(followed, *cut.incision.centerline, tumor_edge, surface, compensation)};
}

Correction correct_by_profile(const Case& settings, const ToolPath& followed, const Contour& tumor_edge,
                              const SurfaceQuery& surface) {
  std::vector<double> offset_mm =
      values_at_waypoints(settings, settings.compensation.photographed_mm, followed, tumor_edge);
  for (double& offset : offset_mm) offset = -offset;
  ToolPath start = followed;
  start.tumor_edge = tumor_edge;
  return {.method = CompensationMethod::Profile, .moves = shift_path(start, surface, offset_mm, safe_region(settings))};
}

Correction correct_converging(const Case& settings, const ToolPath& followed, const Contour& tumor_edge,
                              const SurfaceQuery& surface, std::optional<double> floor_mm, const CutOfPass& cut,
                              Monitor& monitor) {
  int pass = 0;
  const MeasureCut measure = [&](const ToolPath& path) {
    std::optional<PathErrors> errors = path_errors(settings, cut(pass, path), tumor_edge, monitor);
    monitor.message(Severity::Notice, in_words(pass, errors));
    ++pass;
    return errors;
  };
  ToolPath start = followed;
  start.tumor_edge = tumor_edge;
  ConvergenceSettings convergence = convergence_settings(settings, floor_mm.value_or(0.0));
  const std::vector<double>& residual_mm = settings.compensation.residual_mm;
  if (!residual_mm.empty()) convergence.residual_mm = values_at_waypoints(settings, residual_mm, start, tumor_edge);
  Correction correction;
  correction.floor_mm = floor_mm;
  correction.iteration = compensate_converging(start, surface, measure, convergence);
  const ConvergedCompensation& done = *correction.iteration;
  Compensation& moves = correction.moves;
  moves.path = done.path;
  moves.error_mm = done.passes.front().error_mm;
  moves.move_mm = done.result().offset_mm;
  moves.is_limited = done.result().is_limited;
  moves.is_interpolated = done.passes.front().is_interpolated;
  count_moves(moves);
  return correction;
}

std::string objection_to(const Case& settings, const Correction& correction, const SimulatedCut& first,
                         const SimulatedCut& corrected) {
  if (corrected.outcome != Outcome::Success) return fmt::format("its cut {}", in_words(corrected.outcome));
  if (std::string loss = loss_of_depth_or_closure(settings, first, corrected); !loss.empty()) return loss;
  if (correction.method == CompensationMethod::Profile) return {};  // it does not rely on simulated errors
  std::optional<double> before, after;
  std::string none_kept;
  bool is_at_first = false, is_first_measured = true;
  if (correction.iteration) {
    const ConvergedCompensation& done = *correction.iteration;
    const CompensationPass& best = done.result();
    is_at_first = done.best == 0;
    if (is_at_first) none_kept = why_none_was_kept(done);
    if (!best.is_success) {
      return is_at_first
                 ? fmt::format("no pass is better than the cut before it, which itself {}{}", kNoSuccess, none_kept)
                 : fmt::format("its best pass {}", kNoSuccess);
    }
    is_first_measured = done.passes.front().is_success;
    before = done.passes.front().mean_abs_error_mm;
    after = best.mean_abs_error_mm;
  } else {
    if (first.centerline.abs_error_mm) before = first.centerline.abs_error_mm->mean;
    if (corrected.centerline.abs_error_mm) after = corrected.centerline.abs_error_mm->mean;
  }
  if (!after || (is_first_measured && !before)) return "its error could not be measured";
  const double radius = radius_mm(settings.tool);
  if (!(*after < radius))
    return fmt::format("{} mean |error| is {:.2f} mm, but must be below the electrode's radius, {:.2f} mm{}",
                       is_at_first ? "no pass is better than the cut before it, whose" : "its", *after, radius,
                       none_kept);
  if (!is_at_first && is_first_measured && !(*after < *before))
    return fmt::format("its mean |error| is {:.2f} mm, not below the {:.2f} mm of the cut before it", *after, *before);
  return {};
}

}  // namespace incise
