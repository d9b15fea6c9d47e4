#include "planning/scenario_cuts.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr int kNewtonSteps = 60;
constexpr double kStillMm = 1e-4;
constexpr double kRoughnessWeight = 0.02;  // of squared second differences, mm, against mm of error
constexpr int kPriceBisections = 24;
constexpr double kHighestLogPrice = 12.0;  // ln(price of a mm of expected shortfall, in mm of expected error)
constexpr int kShortenings = 6;
constexpr double kSameWeight = 1e-9;

/// Sum of squared second differences round the ring, as a matrix.
Eigen::MatrixXd roughness(Eigen::Index n) {
  Eigen::MatrixXd second = -2.0 * Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    second(i, (i + 1) % n) += 1.0;
    second(i, (i + n - 1) % n) += 1.0;
  }
  return second.transpose() * second;
}

/// Finds the move that minimises expected |error| + price · expected shortfall, per waypoint, + roughness. This
/// function is convex; Newton's method halves its steps until the function falls. Residuals are taken as normal with
/// their variances here; the probability by which a path is chosen is counted over samples.
class PricedMove {
 public:
  PricedMove(const std::vector<LinearScenario>& scenarios, const MarginRisk& risk)
      : scenarios_(scenarios),
        risk_(risk),
        sd_(risk.sd_mm()),
        n_(scenarios.front().error_mm.size()),
        roughness_(roughness(n_)) {}

  [[nodiscard]] Eigen::VectorXd find(double price, Eigen::VectorXd move) const {
    for (int step = 0; step < kNewtonSteps; ++step) {
      Eigen::VectorXd slope;
      Eigen::MatrixXd curvature;
      const double before = value(price, move, &slope, &curvature);
      curvature.diagonal().array() += 1e-6;
      Eigen::VectorXd way = -curvature.ldlt().solve(slope);
      while (way.cwiseAbs().maxCoeff() > kStillMm && value(price, move + way, nullptr, nullptr) > before) way *= 0.5;
      if (way.cwiseAbs().maxCoeff() <= kStillMm) break;
      move += way;
    }
    return move;
  }

 private:
  double value(double price, const Eigen::VectorXd& move, Eigen::VectorXd* slope, Eigen::MatrixXd* curvature) const {
    const Eigen::VectorXd rough = kRoughnessWeight * (roughness_ * move);
    double sum = 0.5 * move.dot(rough);
    if (slope != nullptr) *slope = rough;
    if (curvature != nullptr) *curvature = kRoughnessWeight * roughness_;
    for (const LinearScenario& s : scenarios_) {
      const Eigen::VectorXd error = s.error_mm + s.response * move;
      Eigen::VectorXd first(n_);
      Eigen::VectorXd second(n_);
      for (Eigen::Index i = 0; i < n_; ++i) {
        const FoldedNormal off = folded_normal(error[i], sd_[i]);
        const FoldedNormal close = expected_shortfall(error[i], sd_[i], risk_.least_error_mm());
        sum += s.weight * (off.value + price * close.value);
        first[i] = s.weight * (off.slope + price * close.slope);
        second[i] = s.weight * (off.curvature + price * close.curvature);
      }
      if (slope != nullptr) *slope += s.response.transpose() * first;
      if (curvature != nullptr) *curvature += s.response.transpose() * second.asDiagonal() * s.response;
    }
    return sum;
  }

  const std::vector<LinearScenario>& scenarios_;
  const MarginRisk& risk_;
  const Eigen::VectorXd& sd_;
  Eigen::Index n_;
  Eigen::MatrixXd roughness_;
};

class RobustChoice {
 public:
  using Cut = ScenarioCuts::Cut;

  RobustChoice(ScenarioCuts& cuts, const RobustSettings& settings) : cuts_(cuts), settings_(settings) {}

  RobustCompensation run(const std::vector<double>& corrected_offset) {
    const Cut intended = cuts_.along_intended();
    Cut base = cuts_.along(corrected_offset);
    result_.intended = intended.risk;
    result_.corrected = base.risk;
    keep(base);
    if (!intended.scenarios.empty() && !base.scenarios.empty()) choose_in_rounds(std::move(base));
    result_.simulations = cuts_.simulations();
    return result_;
  }

 private:
  void choose_in_rounds(Cut base) {
    const Eigen::VectorXd corrected = as_vector(base.moved.offset_mm);
    double aim = settings_.max_probability;
    for (int round = 0; round < settings_.rounds; ++round) {
      const std::optional<MovablePath::Moved> next = choose(base, corrected, aim);
      if (!next) break;
      Cut chosen = cuts_.along(*next);
      if (chosen.scenarios.empty()) break;
      if (is_better(chosen.risk, result_.robust)) keep(chosen);
      if (chosen.risk.p_close_margin <= settings_.max_probability) break;
      // The cuts themselves give a higher probability than predicted: aim lower by as much, from here.
      aim *= 0.5 * settings_.max_probability / chosen.risk.p_close_margin;
      base = std::move(chosen);
    }
    const bool is_met = result_.robust.p_close_bound() <= settings_.max_probability;
    result_.outcome = is_met ? RobustOutcome::Met : RobustOutcome::NotMet;
  }

  /// Returns the path of the lowest price that is predicted to keep the probability, or of the highest price if none
  /// is.
  [[nodiscard]] std::optional<MovablePath::Moved> choose(const Cut& base, const Eigen::VectorXd& corrected,
                                                         double aim) const {
    const PricedMove priced(base.scenarios, cuts_.risk());
    const Eigen::VectorXd start = Eigen::VectorXd::Zero(corrected.size());
    const auto at_price = [&](double price) {
      const Eigen::VectorXd move = priced.find(price, start);
      return reachable(as_vector(base.moved.offset_mm), move, corrected);
    };
    const auto foretold = [&](const MovablePath::Moved& path) {
      const Eigen::VectorXd move = as_vector(path.offset_mm) - as_vector(base.moved.offset_mm);
      return cuts_.risk().p_close(moved_errors(base.scenarios, move));
    };
    std::optional<MovablePath::Moved> best = at_price(0.0);
    if (!best || foretold(*best) <= aim) return best;
    double low = -kHighestLogPrice;
    double high = kHighestLogPrice;
    best = at_price(std::exp(high));
    for (int n = 0; n < kPriceBisections && best; ++n) {
      const double middle = 0.5 * (low + high);
      const std::optional<MovablePath::Moved> there = at_price(std::exp(middle));
      if (there && foretold(*there) <= aim) {
        best = there;
        high = middle;
      } else {
        low = middle;
      }
    }
    return best;
  }

  /// Returns the path after a move from `base`, inside the trust region about the corrected path, shortened until it
  /// can be cut.
  [[nodiscard]] std::optional<MovablePath::Moved> reachable(const Eigen::VectorXd& base, const Eigen::VectorXd& move,
                                                            const Eigen::VectorXd& corrected) const {
    double share = 1.0;
    for (int n = 0; n <= kShortenings; ++n, share *= 0.5) {
      std::vector<double> offset(static_cast<std::size_t>(base.size()));
      for (Eigen::Index i = 0; i < base.size(); ++i) {
        const double wanted = base[i] + share * move[i];
        offset[static_cast<std::size_t>(i)] =
            std::clamp(wanted, corrected[i] - settings_.trust_mm, corrected[i] + settings_.trust_mm);
      }
      MovablePath::Moved path = cuts_.movable().at(offset);
      if (cuts_.movable().can_be_cut(path.path)) return path;
    }
    return std::nullopt;
  }

  /// Prefers the path that leaves fewer rings open (leaving a scenario out must not lower the probability), then the
  /// one that keeps the probability, then the smaller error; if neither keeps the probability, the lower probability.
  [[nodiscard]] bool is_better(const PathRisk& a, const PathRisk& b) const {
    if (std::abs(a.unmeasured_weight - b.unmeasured_weight) > kSameWeight)
      return a.unmeasured_weight < b.unmeasured_weight;
    const bool a_kept = a.p_close_margin <= settings_.max_probability;
    const bool b_kept = b.p_close_margin <= settings_.max_probability;
    if (a_kept != b_kept) return a_kept;
    return a_kept ? a.expected_abs_error_mm < b.expected_abs_error_mm : a.p_close_margin < b.p_close_margin;
  }

  void keep(const Cut& made) {
    result_.path = made.moved.path;
    result_.offset_mm = made.moved.offset_mm;
    result_.is_limited = made.moved.is_limited;
    result_.robust = made.risk;
  }

  ScenarioCuts& cuts_;
  const RobustSettings& settings_;
  RobustCompensation result_;
};

/// Errors of one cut in the scenarios that were measured along both paths.
std::vector<ScenarioErrors> errors_in_common(const ScenarioCuts::Cut& of, const ScenarioCuts::Cut& with) {
  std::vector<ScenarioErrors> errors;
  for (const LinearScenario& mine : of.scenarios) {
    for (const LinearScenario& other : with.scenarios) {
      if (mine.place == other.place) errors.push_back({mine.weight, mine.error_mm});
    }
  }
  return errors;
}

}  // namespace

RobustCompensation compensate_robust(const ToolPath& intended, const std::vector<double>& corrected_offset_mm,
                                     const SurfaceQuery& surface, const std::vector<CutScenario>& scenarios,
                                     const MeasureScenarios& measure, const CutResidual& residual,
                                     const RobustSettings& settings) {
  require_scenarios(intended, corrected_offset_mm, surface, scenarios, residual, settings);
  ScenarioCuts cuts(intended, surface, scenarios, measure, residual, settings);
  return RobustChoice(cuts, settings).run(corrected_offset_mm);
}

PathOutlook foresee_paths(const ToolPath& intended, const std::vector<double>& corrected_offset_mm,
                          const SurfaceQuery& surface, const std::vector<CutScenario>& scenarios,
                          const MeasureScenarios& measure, const CutResidual& residual,
                          const RobustSettings& settings) {
  require_scenarios(intended, corrected_offset_mm, surface, scenarios, residual, settings);
  ScenarioCuts cuts(intended, surface, scenarios, measure, residual, settings);
  const ScenarioCuts::Cut planned = cuts.along_intended();
  const ScenarioCuts::Cut corrected = cuts.along(corrected_offset_mm);
  PathOutlook outlook;
  outlook.intended = planned.risk;
  outlook.corrected = corrected.risk;
  const std::vector<ScenarioErrors> before = errors_in_common(planned, corrected);
  if (!before.empty()) outlook.gain = cuts.risk().gain(before, errors_in_common(corrected, planned));
  return outlook;
}

}  // namespace incise
