#include "registration/icp.hpp"
#include "registration/levels.hpp"
#include "registration/mirror_image.hpp"
#include "registration/observability.hpp"
#include "registration/pose_search.hpp"
#include "registration/rival_reason.hpp"
#include "registration/settling.hpp"
#include "registration/shape_residual.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/units.hpp>
#include <incise/registration/register_clouds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

constexpr std::size_t kFewestPoints = 12;
constexpr std::size_t kCandidates = 3;  // poses that are carried through drift and ICP
constexpr std::size_t kRivalPoints = 1000;
constexpr int kDriftSteps = 60;
constexpr int kFinishSteps = 100;
constexpr double kFinalSigma = 0.06;        // first width of the drift that starts from a pose of the search
constexpr double kFinalWidth = 0.08;        // first width of the ICP after the drift
constexpr double kDifferent = 0.08;         // rms distance, in radii, above which two poses are distinct
constexpr double kLeastScoreWidth = 0.002;  // in radii: no camera resolves less
constexpr double kMirrorRatio = 0.95;       // ratio of scores or residuals below which one clearly fits better
constexpr double kUsualScale = 0.05;        // largest usual deviation of the scale from 1: both sensors are metric
// Settling is suspected above this rms of the smooth part that no change of the pose explains, in radii of the target:
// 0.08 mm on a tongue. It is 0.01 mm where nothing has settled, and 0.2 to 0.3 mm where tissue has settled by 1 mm.
constexpr double kSettled = 0.003;
// Likewise for the whole smooth part: 0.5 mm on a tongue. It is up to 0.4 mm where nothing has settled. Without this
// limit a step across the tissue, which looks like a tilt, would not be suspected.
constexpr double kSettledOrMoved = 0.02;
constexpr double kAtLimit = 1e-6;           // relative distance up to which a scale is at an end of its range

void require_usable(const PointCloud& cloud, const char* name) {
  incise::require_usable(cloud.points, name);
  INCISE_REQUIRE(cloud.normals.empty() || cloud.normals.size() == cloud.points.size(),
                 fmt::format("{}: expected no normals or one per point, found {} for {} points", name,
                             cloud.normals.size(), cloud.points.size()));
  for (std::size_t i = 0; i < cloud.normals.size(); ++i) {
    INCISE_REQUIRE(std::abs(cloud.normals[i].norm() - 1.0) < 1e-3,
                   fmt::format("{}: normal {} is not of length 1", name, i));
  }
}

/// Returns a cloud with too many points for the drift as at most `most` clusters; a smaller cloud unchanged.
Points thinned(const Points& points, std::size_t most) {
  if (points.size() <= most) return points;
  const PointCloud cloud{points, {}};
  double voxel = spacing_mm(points) + 1e-9;
  PointCloud few = downsample(cloud, voxel);
  while (few.points.size() > most) few = downsample(cloud, voxel *= 1.15);
  return few.points;
}

/// One pose after drift and ICP on all points.
struct Candidate {
  Similarity transform;
  double score = 0.0;
  bool has_converged = false;
  bool is_degenerate = false;
  int iterations = 0;
  double sigma = 0.0;
  double matched = 0.0;
  double width = 0.0;
};

class Registering {
 public:
  Registering(const PointCloud& source, const PointCloud& target, const SearchFrame& frame,
              const RegistrationSettings& settings, Workers& workers, Monitor& monitor)
      : frame_(frame),
        settings_(settings),
        workers_(workers),
        monitor_(monitor),
        source_({normalised(source.points, frame.source_center, frame.length), source.normals}, workers),
        target_({normalised(target.points, frame.target_center, frame.length), target.normals}, workers),
        asked_(spread_indices(source.points.size(), kScorePoints)) {
    noise_ = std::hypot(source_.roughness, target_.roughness);
    score_width_ = std::max(0.7 * noise_, kLeastScoreWidth);
  }

  void run(Registration& result) {
    std::vector<Pose> poses;
    if (settings_.start) {
      poses.push_back({frame_.to_search(*settings_.start), 0.0});
      result.starts = 1;
    } else {
      PoseSearch found = search_poses(source_, target_, search_settings(), workers_, monitor_);
      poses = std::move(found.poses);
      result.starts = found.starts;
    }
    std::vector<Candidate> candidates;
    for (std::size_t k = 0; k < std::min(poses.size(), kCandidates); ++k) {
      throw_if_cancelled(monitor_, "registering");
      monitor_.progress("registering", static_cast<double>(k) / static_cast<double>(kCandidates));
      candidates.push_back(carried_through(poses[k].transform));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    monitor_.progress("registering", 1.0);
    conclude(result, candidates, poses);
  }

 private:
  [[nodiscard]] PoseSearchSettings search_settings() const {
    return {.scale = settings_.scale,
            .outlier_weight = settings_.outlier_weight,
            .rotations = settings_.rotations,
            .score_width = 2.0 * score_width_};  // rough poses
  }

  [[nodiscard]] IcpSettings finish_settings() const {
    return {.scale = settings_.scale,
            .first_width = kFinalWidth,
            .max_iterations = std::min(settings_.max_iterations, kFinishSteps)};
  }

  [[nodiscard]] double score_of(const Similarity& t) const {
    return overlap_score(source_, asked_, target_, t, score_width_);
  }

  Candidate carried_through(const Similarity& start) {
    Candidate drifted = by_drift(start);
    if (!settings_.finish_with_icp) return drifted;
    // The drift pulls parts without a counterpart towards the rest; if that leads it astray, the pose of the search is
    // a better start.
    Candidate finished = by_icp(drifted.is_degenerate ? start : drifted.transform);
    if (!settings_.start) {
      Candidate direct = by_icp(start);
      if (direct.score > finished.score) finished = direct;
    }
    finished.iterations += drifted.iterations;
    finished.sigma = drifted.sigma;
    finished.matched = drifted.matched;
    return finished;
  }

  Candidate by_drift(const Similarity& start) {
    DriftSettings drift{.scale = settings_.scale,
                        .outlier_weight = settings_.outlier_weight,
                        .max_iterations = settings_.max_iterations};
    if (!settings_.start) drift.first_sigma = kFinalSigma;
    // If the ICP finish follows, the drift need not converge.
    if (settings_.finish_with_icp) drift.max_iterations = std::min(drift.max_iterations, kDriftSteps);
    const CoherentPointDrift done =
        rigid_drift(thinned(source_.cloud.points, settings_.drift_points),
                    thinned(target_.cloud.points, settings_.drift_points), start, drift, workers_, monitor_);
    if (done.outcome == DriftOutcome::Cancelled) throw_if_cancelled(monitor_, "registering");
    return {.transform = done.T_target_source,
            .score = score_of(done.T_target_source),
            .has_converged = done.outcome == DriftOutcome::Converged,
            .is_degenerate = done.outcome == DriftOutcome::Degenerate,
            .iterations = done.iterations,
            .sigma = done.sigma_mm,
            .matched = done.matched_share,
            .width = std::max(2.5 * noise_, kLeastScoreWidth)};
  }

  Candidate by_icp(const Similarity& start) {
    const Icp done = icp(source_, target_, start, finish_settings(), workers_);
    return {done.transform, score_of(done.transform), done.has_converged, done.is_degenerate, done.iterations, 0.0, 0.0,
            done.width};
  }

  void conclude(Registration& result, const std::vector<Candidate>& candidates, const std::vector<Pose>& poses) {
    if (candidates.empty() || candidates.front().is_degenerate) {
      result.outcome = RegistrationOutcome::Degenerate;
      result.reasons.emplace_back("too few points of the source find a counterpart on the target");
      return;
    }
    Candidate best = candidates.front();
    compare_with_mirror_image(result, best);
    const std::optional<SettledPose> settled = settled_from(best);
    result.T_target_source = frame_.from_search(best.transform);
    result.iterations = best.iterations;
    result.score = best.score;
    result.drift_sigma_mm = best.sigma * frame_.length;
    result.target_fraction = best.matched;
    result.noise_mm = noise_ * frame_.length;
    measure_residuals(result, best);
    find_rival(result, best, candidates, poses);
    result.certificate =
        pose_observability(source_, target_, best.transform, best.width, !settings_.scale.is_fixed(), workers_);
    if (settled) take_over(result, *settled);
    const ShapeResidual shape =
        shape_residual(source_, target_, best.transform, settings_.scale, settings_.settling_mm / frame_.length, workers_);
    result.shape_residual_mm = frame_.length * shape.left;
    judge(result, best);
    note_settling(result, shape);
    to_millimetres(result.certificate);
  }

  /// Finds the best pose once more, together with the settling. Keeps the score without settling.
  std::optional<SettledPose> settled_from(Candidate& best) const {
    if (!(settings_.settling_mm > 0.0)) return std::nullopt;
    const SettlingSettings settings{.scale = settings_.scale, .largest = settings_.settling_mm / frame_.length};
    SettledPose settled = settled_pose(source_, target_, best.transform, settings, workers_);
    best.iterations += settled.iterations;
    best.has_converged = best.has_converged && settled.has_converged && !settled.is_degenerate;
    if (!settled.is_degenerate) best.transform = settled.transform;
    return settled;
  }

  /// Stores the settling, and replaces the covariance from noise alone by that from noise and settling.
  void take_over(Registration& result, const SettledPose& settled) const {
    result.settled_rms_mm = frame_.length * settled.settled_rms;
    result.settled_max_mm = frame_.length * settled.settled_largest;
    if (settled.is_degenerate) return;  // the outcome reports it; there is no covariance
    set_covariance(result.certificate, settled.covariance, settled.center, settled.length);
    find_weakest(result.certificate, settled.length);
  }

  void measure_residuals(Registration& result, const Candidate& best) {
    const Misfit misfit = misfit_of(source_, asked_, target_, best.transform, best.width, score_width_, workers_);
    for (const double distance : misfit.distances) result.residuals_mm.push_back(frame_.length * distance);
    result.rmse_mm = frame_.length * misfit.rmse;
    result.inlier_fraction = misfit.inlier_fraction;
    result.fit_fraction = misfit.fit_fraction;
  }

  /// Compares source and mirror image. Call before settling, which would absorb part of the difference between them.
  void compare_with_mirror_image(Registration& result, const Candidate& best) {
    std::optional<PoseSearchSettings> search;
    if (!settings_.start) search = search_settings();
    const Misfit proper = misfit_of(source_, asked_, target_, best.transform, best.width, score_width_, workers_);
    const Misfit mirror = mirror_image_misfit(source_, target_, best.transform, search, finish_settings(), score_width_,
                                              workers_, monitor_);
    result.shape_rmse_mm = proper.rmse * frame_.length;
    result.mirror_score = mirror.score;
    result.mirror_rmse_mm = mirror.rmse * frame_.length;
    // All conditions must hold. If tissue has settled, a few points of the mirror image may fit better and most of them
    // worse; and if the clouds are two halves of a symmetric shape, one may cover the other's mirror image completely.
    is_mirrored_ = proper.score < kMirrorRatio * mirror.score && mirror.rmse < kMirrorRatio * proper.rmse &&
                   proper.score_above < kMirrorRatio * mirror.score_above &&
                   mirror.fit_fraction >= settings_.least_fit && mirror.rmse <= settings_.largest_rmse;
    result.is_handedness_determined = mirror.score < kMirrorRatio * proper.score;
  }

  void find_rival(Registration& result, const Candidate& best, const std::vector<Candidate>& candidates,
                  const std::vector<Pose>& poses) {
    const auto consider = [&](const Similarity& t, double score) {
      if (score <= result.rival_score || !differ(t, best.transform, source_.cloud.points, kDifferent)) return;
      result.rival_score = score;
      result.rival = frame_.from_search(t);
    };
    for (const Candidate& candidate : candidates) consider(candidate.transform, candidate.score);
    // The search stops when its poses are good enough to be ranked: after convergence some of them coincide with the
    // best.
    const IcpSettings settings{
        .scale = settings_.scale, .first_width = kFinalWidth, .tolerance = 1e-3, .max_points = kRivalPoints};
    for (const Pose& pose : poses) {
      const Icp done = icp(source_, target_, pose.transform, settings, workers_);
      if (!done.is_degenerate) consider(done.transform, score_of(done.transform));
    }
  }

  /// Sets the outcome and the reasons, worst first.
  void judge(Registration& result, const Candidate& best) const {
    const PoseObservability& c = result.certificate;
    result.outcome = RegistrationOutcome::Converged;
    const auto fail = [&result](bool has_failed, RegistrationOutcome outcome, std::string reason) {
      if (!has_failed) return;
      if (result.outcome == RegistrationOutcome::Converged) result.outcome = outcome;
      result.reasons.push_back(std::move(reason));
    };
    const std::string both_residuals =
        fmt::format("residual {:.3g} mm (rms) and score {:.3f}, against {:.3g} mm and {:.3f} for the source itself",
                    result.mirror_rmse_mm, result.mirror_score, result.shape_rmse_mm, result.score);
    fail(is_mirrored_, RegistrationOutcome::Mirrored,
         fmt::format("the source's mirror image fits the target better than the source ({}): one of the two clouds is "
                     "reflected",
                     both_residuals));
    fail(!best.has_converged, RegistrationOutcome::IterationLimit,
         fmt::format("still moving after {} iterations", best.iterations));
    fail(result.inlier_fraction < settings_.least_inliers, RegistrationOutcome::PoorFit,
         fmt::format("only {:.0f} % of the source's points lie on the target, expected at least {:.0f} %",
                     100.0 * result.inlier_fraction, 100.0 * settings_.least_inliers));
    fail(result.fit_fraction < settings_.least_fit, RegistrationOutcome::PoorFit,
         fmt::format(
             "only {:.0f} % of the source's points above the target lie on it, expected at least {:.0f} %: another "
             "shape, or its mirror image",
             100.0 * result.fit_fraction, 100.0 * settings_.least_fit));
    fail(result.rmse_mm > settings_.largest_rmse * frame_.length, RegistrationOutcome::PoorFit,
         fmt::format("the residual of {:.3g} mm (rms) is above {:.3g} mm", result.rmse_mm,
                     settings_.largest_rmse * frame_.length));
    fail(result.shape_residual_mm > settings_.largest_shape_residual * frame_.length, RegistrationOutcome::OtherShape,
         fmt::format("another shape: neither noise nor settling explains {:.3g} mm of the residual, expected at most "
                     "{:.3g} mm",
                     result.shape_residual_mm, settings_.largest_shape_residual * frame_.length));
    const double largest_sd = settings_.settling_mm > 0.0 ? settings_.largest_settled_sd : settings_.largest_sd;
    fail(c.sharpness[0] < settings_.least_sharpness || !(c.weakest_sd_mm < largest_sd),
         RegistrationOutcome::IllDetermined,
         fmt::format("{} hardly changes the residual: its standard deviation is {:.3g} mm, and {:.2g} % of the least "
                     "visible motion shows in the distances",
                     c.weakest.empty() ? "a motion" : c.weakest, c.weakest_sd_mm * frame_.length,
                     100.0 * c.sharpness[0]));
    fail(result.rival_score > settings_.largest_rival * result.score, RegistrationOutcome::Ambiguous,
         rival_reason(result.rival_score, result.score));
    const double scale = result.T_target_source.scale;
    const double tiny = kAtLimit * scale;
    result.scale_at_limit =
        !settings_.scale.is_fixed() && (scale <= settings_.scale.low + tiny || scale >= settings_.scale.high - tiny);
    fail(result.scale_at_limit, RegistrationOutcome::ScaleAtLimit,
         fmt::format("the scale is at the end of its range, {:.4g}: the clouds fit a scale beyond it better", scale));
    if (!is_mirrored_ && !result.is_handedness_determined) {
      result.reasons.push_back(fmt::format(
          "the source's mirror image fits about as well ({}): the shapes do not show whether one is reflected",
          both_residuals));
    }
    result.is_scale_suspicious = std::abs(scale - 1.0) > kUsualScale;
    if (result.is_scale_suspicious) {
      result.reasons.push_back(fmt::format(
          "the scale of {:.4g} is outside 0.95 to 1.05: if both clouds are metric, something is wrong", scale));
    }
  }

  /// Adds a reason if the tissue may have settled and settling was not searched for: it would pass for a shift or a
  /// tilt.
  void note_settling(Registration& result, const ShapeResidual& shape) const {
    const bool is_suspected = shape.apart_rms > kSettled || shape.settled_rms > kSettledOrMoved;
    if (settings_.settling_mm > 0.0 || !is_suspected) return;
    result.reasons.push_back(
        fmt::format("apart from the pose, the surfaces differ smoothly by {:.2g} mm (rms), up to {:.2g} mm, as if the "
                    "tissue had settled or were held differently; the pose may be off by as much. Run "
                    "`incise register` again with `--settling-mm 1` to find pose and settling together",
                    frame_.length * shape.apart_rms, frame_.length * shape.apart_largest));
  }

  void to_millimetres(PoseObservability& c) const {
    const double length = frame_.length;
    c.sd_mm *= length;
    c.weakest_sd_mm *= length;
    c.translation_sd_mm *= length;
    c.center_mm = length * c.center_mm + frame_.target_center;
    Vec7 units = Vec7::Ones();
    units.segment<3>(3).setConstant(length);
    c.covariance = units.asDiagonal() * c.covariance * units.asDiagonal();
  }

  const SearchFrame frame_;
  const RegistrationSettings& settings_;
  Workers& workers_;
  Monitor& monitor_;
  SampledSurface source_;
  SampledSurface target_;
  std::vector<std::size_t> asked_;
  double noise_ = 0.0;
  double score_width_ = 0.0;
  bool is_mirrored_ = false;
};

}  // namespace

void describe(Visitor& v, RegistrationSettings& s) {
  v("scale", s.scale, "Range of the scale; low = high fixes it.");
  v("outlier_weight", s.outlier_weight, "Share of the target that has no counterpart in the source.", {0.001, 0.95});
  v.internal("start", s.start, "One start; absent: a search over rotations.");
  v("rotations", s.rotations, "Starts of the search, spread evenly over all rotations.", {8.0, 2000.0});
  v("finish_with_icp", s.finish_with_icp, "Whether a point-to-plane refinement follows the drift.");
  v("max_iterations", s.max_iterations, "Greatest number of iterations of the drift, and of the refinement after it.",
    {1.0, 100000.0});
  v("drift_points", s.drift_points, "A larger cloud enters the drift as about this many clusters.", {100.0});
  v({"settling_mm",
     "How far the tissue may have settled along the source's mean normal (up or down) since it was simulated. Pose and "
     "settling are then found together; 0: the pose alone.",
     "mm"},
    s.settling_mm, {0.0, 20.0});
  v("largest_rmse", s.largest_rmse, "Greatest residual (rms) for a success.", kPositive);
  v("least_inliers", s.least_inliers, "Least share of inliers among the source's points, for a success.", {0.0, 1.0});
  v("least_fit", s.least_fit, "Least share of the source's points above the target that lie on it, for a success.",
    {0.0, 1.0});
  v("largest_shape_residual", s.largest_shape_residual,
    "Greatest misfit, for a success, that neither noise nor settling explains.", kPositive);
  v("largest_sd", s.largest_sd, "Greatest standard deviation of the pose along its weakest direction, for a success.",
    kPositive);
  v("largest_settled_sd", s.largest_settled_sd,
    "The same where settling is searched for, which leaves the pose less certain.", kPositive);
  v("least_sharpness", s.least_sharpness, "Least sharpness of the least visible motion, for a success.", kNotNegative);
  v("largest_rival", s.largest_rival, "Greatest ratio of the rival's score to that of the pose found, for a success.",
    {0.0, 1.0, true});
}

std::vector<Problem> validate(const RegistrationSettings& s) {
  std::vector<Problem> problems = problems_of(s);
  Expect{problems}(s.scale.low <= s.scale.high, "scale.low", s.scale.low, fmt::format("at most {}", s.scale.high));
  return problems;
}

Registration register_clouds(const PointCloud& source, const PointCloud& target, const RegistrationSettings& settings,
                             Workers& workers, Monitor& monitor) {
  require_usable(source, "source");
  require_usable(target, "target");
  require_none(validate(settings));
  Registration result;
  const Measure source_measure = measure_of(source.points);
  const Measure target_measure = measure_of(target.points);
  for (const auto& [name, cloud, measure] :
       {std::tuple("source", &source, &source_measure), std::tuple("target", &target, &target_measure)}) {
    if (cloud->points.size() < kFewestPoints) {
      result.reasons.push_back(
          fmt::format("the {} has {} points, expected at least {}", name, cloud->points.size(), kFewestPoints));
    } else if (is_line(measure->variances)) {
      result.reasons.push_back(
          fmt::format("the {}'s points lie on a line or coincide: they do not determine a rotation", name));
    }
  }
  if (!result.reasons.empty()) return result;
  const SearchFrame frame{source_measure.center, target_measure.center, target_measure.radius};
  try {
    Registering(source, target, frame, settings, workers, monitor).run(result);
  } catch (const Cancelled& stop) {
    result = {};
    result.outcome = RegistrationOutcome::Cancelled;
    result.reasons.emplace_back(stop.what());
  }
  return result;
}

void describe(Visitor& v, Registration& r) {
  const bool is_found = r.outcome != RegistrationOutcome::Degenerate && r.outcome != RegistrationOutcome::Cancelled;
  const auto if_found = [is_found](auto value) { return is_found ? std::optional(value) : std::nullopt; };
  const auto finite_if_found = [is_found](double value) { return is_found ? if_finite(value) : std::nullopt; };
  const Similarity& t = r.T_target_source;
  v("outcome", r.outcome, "How the registration ended.");
  v.derived("converged", r.outcome == RegistrationOutcome::Converged, "Whether nothing argues against the transform.");
  v("reasons", r.reasons, "Why the registration is not a success, and cautions; worst first.");
  v.derived("scale", if_found(t.scale), "Scale of the transform.");
  v.derived("rotation", if_found(t.rotation), "Rotation of the transform.");
  v.derived("rotation_deg", if_found(units::deg_from_rad(rotation_vector(t.rotation).norm())),
            "Angle of the rotation.");
  v.derived("translation_mm", if_found(t.translation_mm), "Translation of the transform.");
  v.derived("T_target_source", if_found(matrix_of(t)), "Matrix of the transform, 4 x 4, by rows, scale included.");
  v.derived("rmse_mm", finite_if_found(r.rmse_mm),
            "Residual (rms) of the source's points above the target, along the normals.");
  v.derived("inlier_fraction", finite_if_found(r.inlier_fraction),
            "Share of the source's points that lie above the target within 3 robust standard deviations.");
  v.derived("settled_rms_mm", if_finite(r.settled_rms_mm), "Settling found together with the pose (rms).");
  v.derived("settled_max_mm", if_finite(r.settled_max_mm), "Greatest settling found together with the pose.");
  v.derived("noise_mm", if_finite(r.noise_mm), "What rmse_mm would be if the surfaces had the same shape.");
  v.derived("fit_fraction", if_finite(r.fit_fraction), "Inliers as a share of the source's points above the target.");
  v.derived("target_fraction", if_finite(r.target_fraction),
            "Matched share of the target's points, by the drift's probability.");
  v.derived("drift_sigma_mm", if_finite(r.drift_sigma_mm), "Width of the drift's Gaussians at the end.");
  v("iterations", r.iterations, "Iterations of drift and finish.");
  v("starts", r.starts, "Starts of the search.");
  v.derived("score", if_finite(r.score), "Share of the source that lies on the target to within the noise.");
  v.derived("rival_score", if_finite(r.rival_score),
            "Score of the rival, the best pose distinct from this one; 0: none.");
  v.derived("rival_T_target_source", r.rival ? std::optional(matrix_of(*r.rival)) : std::nullopt,
            "Matrix of the rival.");
  v.derived("shape_rmse_mm", if_finite(r.shape_rmse_mm), "rmse_mm before settling was searched for.");
  v.derived("shape_residual_mm", if_finite(r.shape_residual_mm), "Misfit that neither noise nor settling explains.");
  v.derived("mirror_score", if_finite(r.mirror_score), "Score of the best pose found for the source's mirror image.");
  v.derived("mirror_rmse_mm", if_finite(r.mirror_rmse_mm), "Residual (rms) of that pose.");
  v("handedness_determined", r.is_handedness_determined,
    "Whether the mirror image fits clearly less well than the source.");
  v("scale_at_limit", r.scale_at_limit, "Whether the scale is at an end of its range.");
  v("scale_suspicious", r.is_scale_suspicious,
    "Whether the scale is outside 0.95 to 1.05, although both sensors are metric.");
  v.derived("certificate", if_found(r.certificate), "How well the surfaces determine the pose.");
  v.bulk("residuals_mm", r.residuals_mm, "Signed distances along the normals, from target to source.");
}

}  // namespace incise
