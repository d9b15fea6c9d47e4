#include "planning/path_course.hpp"
#include "planning/safe_moves.hpp"
#include "planning/tissue_response.hpp"

#include <incise/core/anderson.hpp>
#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/planning/converging_compensation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr int kMostHalvings = 6;
/// Share of the mesh-resolution limit that remains of the mesh's grain once errors are averaged along the path.
constexpr double kSmoothedGrain = 0.25;

/// The iteration: passes made so far, and where the next one goes.
class ConvergingIteration {
 public:
  ConvergingIteration(const ToolPath& intended, const SurfaceQuery& surface, const MeasureCut& measure,
                      const ConvergenceSettings& settings)
      : intended_(intended),
        measure_(measure),
        settings_(settings),
        course_(intended),
        movable_(intended, surface, settings.region),
        trust_mm_(settings.trust_mm) {}

  ConvergedCompensation run() {
    const std::size_t n = intended_.waypoints.size();
    carry_out({intended_, std::vector<double>(n, 0.0), std::vector<std::uint8_t>(n, 0)}, 0.0);
    if (!passes_.front().mean_abs_error_mm) return finish(CompensationOutcome::NoMeasure);
    bool is_at_rest = false;
    while (!is_converged() && !is_at_rest && static_cast<int>(passes_.size()) < settings_.simulations) {
      const std::optional<MovablePath::Moved> next = next_path();
      if (next) carry_out(*next, greatest_move(passes_[nearest_].offset_mm, next->offset_mm));
      is_at_rest = !next;
    }
    mend_by_moving();
    if (is_converged()) return finish(CompensationOutcome::Converged);
    if (is_at_rest) return finish(CompensationOutcome::AtRest);
    const bool is_last_best = best_ + 1 == passes_.size();
    return finish(is_last_best ? CompensationOutcome::BudgetSpent : CompensationOutcome::BestKept);
  }

 private:
  static double greatest_move(const std::vector<double>& from, const std::vector<double>& to) {
    double greatest = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) greatest = std::max(greatest, std::abs(to[i] - from[i]));
    return greatest;
  }

  /// A bridge of a fraction of a millimetre can hold a ring open where its end meets its start, because tissue that
  /// hangs there is pushed aside. A tenth of a millimetre farther out or in, the tool cuts through it. The same holds
  /// for a place that is slightly too shallow.
  void mend_by_moving() {
    for (int k = 0; k < settings_.more_simulations && is_to_be_mended(); ++k) {
      const double move_mm =
          settings_.more_move_mm * (k / 2 + 1) * (k % 2 == 0 ? 1.0 : -1.0);  // out, in, farther out, farther in
      std::vector<double> offset = passes_[nearest_].offset_mm;
      for (double& o : offset) o += move_mm;
      const MovablePath::Moved moved = movable_.at(offset);
      if (!movable_.can_be_cut(moved.path)) continue;
      carry_out(moved, greatest_move(passes_[nearest_].offset_mm, moved.offset_mm));
    }
  }

  void carry_out(const MovablePath::Moved& moved, double move_mm) {
    CompensationPass pass;
    pass.offset_mm = moved.offset_mm;
    pass.is_limited = moved.is_limited;
    pass.max_move_mm = move_mm;
    if (const std::optional<PathErrors> errors = measure_(moved.path)) note(*errors, pass);
    passes_.push_back(std::move(pass));
    const std::size_t last = passes_.size() - 1;
    if (last == 0 || is_better(passes_[last], passes_[best_])) {
      best_ = last;
      best_path_ = moved.path;
    }
    if (last == 0 || is_nearer(passes_[last], passes_[nearest_])) {
      nearest_ = last;
    } else {
      trust_mm_ = 0.5 * move_mm;
    }
  }

  /// Sets the errors of a real cut beyond the simulated one and its bias: the residual, and (share − 1) times the first
  /// cut's errors.
  void expect_beyond(const CompensationPass& first) {
    beyond_mm_ = settings_.residual_mm;
    if (settings_.simulated_share == 1.0) return;
    const std::vector<double> simulated =
        course_.average(first.along_mm, first.point_error_mm, settings_.smoothing_mm).value;
    beyond_mm_.resize(simulated.size(), 0.0);
    for (std::size_t i = 0; i < simulated.size(); ++i)
      beyond_mm_[i] += (settings_.simulated_share - 1.0) * simulated[i];
  }

  void note(const PathErrors& errors, CompensationPass& pass) {
    INCISE_REQUIRE(errors.places.size() == errors.signed_error_mm.size() && !errors.places.empty(),
                   fmt::format("expected one error for each measured place, found {} for {}",
                               errors.signed_error_mm.size(), errors.places.size()));
    pass.point_error_mm = errors.signed_error_mm;
    double sum = 0.0;
    double greatest = 0.0;
    for (std::size_t k = 0; k < errors.places.size(); ++k) {
      double& expected = pass.point_error_mm[k];
      pass.along_mm.push_back(course_.along_mm(errors.places[k]));
      if (!settings_.bias_mm.empty()) expected += course_.interpolate(settings_.bias_mm, pass.along_mm[k]);
    }
    if (passes_.empty()) expect_beyond(pass);
    for (std::size_t k = 0; k < errors.places.size(); ++k) {
      double& expected = pass.point_error_mm[k];
      if (!beyond_mm_.empty()) expected += course_.interpolate(beyond_mm_, pass.along_mm[k]);
      sum += std::abs(expected);
      greatest = std::max(greatest, std::abs(expected));
    }
    PathCourse::Averages averages = course_.average(pass.along_mm, pass.point_error_mm, settings_.smoothing_mm);
    pass.error_mm = std::move(averages.value);
    pass.is_interpolated = std::move(averages.is_interpolated);
    pass.mean_abs_error_mm = sum / static_cast<double>(errors.places.size());
    pass.max_abs_error_mm = greatest;
    pass.smooth_error_mm = 0.0;
    for (const double e : pass.error_mm)
      *pass.smooth_error_mm += std::abs(e) / static_cast<double>(pass.error_mm.size());
    pass.is_success = errors.is_success;
    pass.shortfall_mm = errors.shortfall_mm;
    pass.open_layers = errors.open_layers;
    pass.verdict = errors.verdict;
    pass.lag_mm = errors.lag_mm;
  }

  static bool is_better(const CompensationPass& a, const CompensationPass& b) {
    if (!a.mean_abs_error_mm) return false;
    if (a.is_success != b.is_success) return a.is_success;
    if (a.open_layers != b.open_layers) return a.open_layers < b.open_layers;
    if (a.verdict != b.verdict) return a.verdict < b.verdict;
    return a.cost_mm() < b.cost_mm();
  }

  /// Returns whether a is the better start of the next pass. A path a tenth of a millimetre off whose ring stays open
  /// in one layer leads to a closed ring sooner than a closed ring that is a millimetre off.
  static bool is_nearer(const CompensationPass& a, const CompensationPass& b) { return a.mean_abs_error_mm && a.cost_mm() < b.cost_mm(); }

  /// Returns whether no objection to the cut remains that another path may remove.
  static bool is_sound(const CompensationPass& pass) { return pass.is_success && pass.verdict == VerdictStatus::Ok; }

  /// Returns whether more simulations should mend the nearest pass: no sound pass is as near within the tolerance, and
  /// the nearest errs little enough to be accepted. If the nearest pass is itself the best, it must lack little: a ring
  /// that is open or shallow all round stays so a tenth of a millimetre away.
  [[nodiscard]] bool is_to_be_mended() const {
    const CompensationPass& best = passes_[best_];
    const CompensationPass& nearest = passes_[nearest_];
    if (is_sound(best) && best.cost_mm() <= nearest.cost_mm() + settings_.tolerance_mm) return false;
    if (*nearest.mean_abs_error_mm >= settings_.region.electrode_radius_mm) return false;
    return best_ != nearest_ || (nearest.open_layers <= 1 && nearest.shortfall_mm <= settings_.tolerance_mm);
  }

  [[nodiscard]] bool is_converged() const {
    const CompensationPass& best = passes_[best_];
    return is_sound(best) && *best.mean_abs_error_mm <= settings_.floor_mm + settings_.tolerance_mm;
  }

  [[nodiscard]] IterationPoint as_point(const CompensationPass& pass) const {
    const double lag = passes_.front().lag_mm;
    const TissueResponse response(course_, settings_.shift_lags * lag, settings_.spread_lags * lag);
    IterationPoint point{pass.offset_mm, response.answer(pass.error_mm)};
    for (double& move : point.f) move *= settings_.relaxation;
    return point;
  }

  /// Returns the next path: from the nearest pass, inside the trust region, shortened until it can be cut; nullopt if
  /// it would hardly move or cannot be cut.
  [[nodiscard]] std::optional<MovablePath::Moved> next_path() const {
    const IterationPoint base = as_point(passes_[nearest_]);
    std::vector<IterationPoint> earlier;
    for (std::size_t back = 0; back < passes_.size() && static_cast<int>(earlier.size()) < settings_.memory; ++back) {
      const std::size_t k = passes_.size() - 1 - back;
      if (k != nearest_ && passes_[k].mean_abs_error_mm) earlier.push_back(as_point(passes_[k]));
    }
    const std::vector<double> wanted = accelerated_step(base, earlier, kSmoothedGrain * settings_.floor_mm);
    double share = std::min(1.0, trust_mm_ / std::max(trust_mm_, greatest_move(base.x, wanted)));
    for (int halving = 0; halving <= kMostHalvings; ++halving, share *= 0.5) {
      std::vector<double> offset = base.x;
      for (std::size_t i = 0; i < offset.size(); ++i) offset[i] += share * (wanted[i] - base.x[i]);
      MovablePath::Moved moved = movable_.at(offset);
      if (greatest_move(base.x, moved.offset_mm) <= settings_.least_move_mm) return std::nullopt;
      if (movable_.can_be_cut(moved.path)) return moved;
    }
    return std::nullopt;
  }

  ConvergedCompensation finish(CompensationOutcome outcome) {
    ConvergedCompensation result{std::move(best_path_), std::move(passes_), best_, outcome, {}};
    if (best_ > 0) {
      const double left = *result.result().mean_abs_error_mm / *result.passes.front().mean_abs_error_mm;
      result.contraction = std::pow(left, 1.0 / static_cast<double>(best_));
    }
    return result;
  }

  const ToolPath& intended_;
  const MeasureCut& measure_;
  const ConvergenceSettings& settings_;
  const PathCourse course_;
  const MovablePath movable_;
  double trust_mm_;
  std::vector<CompensationPass> passes_;
  std::vector<double> beyond_mm_;  ///< errors expected beyond simulation and bias, per waypoint; empty: none
  std::size_t best_ = 0;     // the pass to return
  std::size_t nearest_ = 0;  // the pass nearest to the intended cut: the next pass starts from it
  ToolPath best_path_;
};

}  // namespace

ConvergedCompensation compensate_converging(const ToolPath& intended, const SurfaceQuery& surface,
                                            const MeasureCut& measure, const ConvergenceSettings& settings) {
  require_none(problems_of(settings));
  INCISE_REQUIRE(intended.is_closed, "expected a closed path, found an open one");
  INCISE_REQUIRE(intended.tumor_edge.is_closed && intended.tumor_edge.points.size() >= 3,
                 "expected a path with a closed tumour edge of at least 3 points");
  INCISE_REQUIRE(settings.bias_mm.size() <= 1 || settings.bias_mm.size() == intended.waypoints.size(),
                 fmt::format("expected no bias_mm, one, or one for each of {} waypoints, found {}",
                             intended.waypoints.size(), settings.bias_mm.size()));
  INCISE_REQUIRE(settings.residual_mm.empty() || settings.residual_mm.size() == intended.waypoints.size(),
                 fmt::format("expected no residual_mm, or one for each of {} waypoints, found {}",
                             intended.waypoints.size(), settings.residual_mm.size()));
  check_path_as({"compensation"}, intended, surface, settings.region.approach, 0.0);
  return ConvergingIteration(intended, surface, measure, settings).run();
}

}  // namespace incise
