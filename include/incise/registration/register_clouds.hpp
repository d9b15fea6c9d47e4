#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/names.hpp>
#include <incise/core/problem.hpp>
#include <incise/core/workers.hpp>
#include <incise/geometry/point_cloud.hpp>
#include <incise/registration/drift.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Settings of register_clouds. Lengths are shares of the target's root mean square radius, except `settling_mm`, which
/// is in the clouds' unit.
struct RegistrationSettings {
  ScaleRange scale{0.9, 1.1};
  double outlier_weight = 0.3;
  std::optional<Similarity> start;  ///< one start; absent: a search over rotations
  int rotations = 160;
  bool finish_with_icp = true;
  int max_iterations = 300;
  std::size_t drift_points = 20000;
  double settling_mm = 0.0;
  double largest_rmse = 0.03;
  double least_inliers = 0.15;
  double least_fit = 0.7;
  double largest_shape_residual = 0.0055;
  double largest_sd = 0.01;
  double largest_settled_sd = 0.02;
  double least_sharpness = 7e-4;
  double largest_rival = 0.95;
};
void describe(Visitor& v, RegistrationSettings& s);

/// Returns every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const RegistrationSettings& settings);

enum class RegistrationOutcome {
  Converged,
  IterationLimit,  ///< the pose was still changing when the iterations ran out
  IllDetermined,   ///< the surfaces can slide along each other: some motion hardly changes the residual
  Ambiguous,       ///< another pose fits about as well
  Mirrored,        ///< the source's mirror image fits clearly better: one of the clouds is reflected
  PoorFit,         ///< the residual is too large, or too little of the source has a counterpart
  OtherShape,      ///< the surfaces have different ridges and hollows: another specimen, or changed tissue
  ScaleAtLimit,    ///< the scale is at an end of its range: the clouds fit a scale beyond it better
  Degenerate,      ///< no transform: a cloud is a point or a line or has fewer than 12 points, or too few find a
                   ///< counterpart
  Cancelled,
};
inline constexpr std::array<std::string_view, 10> kRegistrationOutcomeNames{
    "converged", "iteration_limit", "ill_determined", "ambiguous",  "mirrored",
    "poor_fit",  "other_shape",     "scale_at_limit", "degenerate", "cancelled"};
[[nodiscard]] constexpr Names names_of(RegistrationOutcome) {
  return kRegistrationOutcomeNames;
}

/// How well two surfaces determine the transform between them. The motions (three turns about the overlap's centroid,
/// three shifts, and the logarithm of the scale) are combined into independent ones, ordered from the least to the most
/// visible in the distances along the normals. The size of a motion is how far it moves the overlap (rms). On a plane
/// three motions (four with scale) have visibility 0, on a sphere three, on a cylinder two. Sources: [Gelfand2003] for
/// the slippage, [Censi2007] for the covariance.
struct PoseObservability {
  int motions = 0;                  ///< 7, or 6 with the scale fixed
  std::array<double, 7> visible{};  ///< share of each motion that shows in the distances, [0, 1], ascending:
                                    ///< eigenvalues of the Gauss-Newton matrix
  /// The same for the two least visible motions, measured: the source is moved both ways and the nearest points are
  /// found again; rise of the mean squared distance over the squared motion, [0, 1]. Unlike `visible`, not affected by
  /// noise in the normals, which makes a plane look determined.
  std::array<double, 2> sharpness{};
  double sd_mm = 0.0;          ///< standard deviation of the overlap's position, all motions together (rms); infinite
                               ///< if fewer than 12 pairs of points were found
  double weakest_sd_mm = 0.0;  ///< largest standard deviation along one of the motions
  double rotation_sd_deg = 0.0;
  double translation_sd_mm = 0.0;  ///< of the overlap's centroid
  double scale_sd = 0.0;           ///< relative
  Eigen::Matrix<double, 7, 7> covariance =
      Eigen::Matrix<double, 7, 7>::Zero();  ///< rotation vector (rad), translation (mm), log scale; about `center_mm`
  Vec3 center_mm = Vec3::Zero();            ///< centroid of the overlap, target frame
  std::string weakest;                      ///< the motion of `weakest_sd_mm`, in words for a person
};
inline void describe(Visitor& v, PoseObservability& c) {
  v("motions", c.motions, "Number of motions: 7, or 6 with the scale fixed.");
  std::vector<std::optional<double>> visible;
  for (int k = 0; k < c.motions; ++k) visible.push_back(if_finite(c.visible[static_cast<std::size_t>(k)]));
  v.derived("visible", visible, "Share of each motion that appears in the distances, ascending.");
  v.derived("sharpness", std::vector{if_finite(c.sharpness[0]), if_finite(c.sharpness[1])},
            "Sharpness of the two least visible motions, measured by moving the source to and fro.");
  v("weakest_motion", c.weakest, "Motion that is least determined, in words.");
  v.derived("weakest_sd_mm", if_finite(c.weakest_sd_mm), "Standard deviation along the least determined motion.");
  v.derived("sd_mm", if_finite(c.sd_mm),
            "Standard deviation of the overlap's position due to noise, all motions together (rms).");
  v.derived("rotation_sd_deg", if_finite(c.rotation_sd_deg), "Standard deviation of the rotation.");
  v.derived("translation_sd_mm", if_finite(c.translation_sd_mm), "Standard deviation of the overlap's middle.");
  v.derived("scale_sd", if_finite(c.scale_sd), "Relative standard deviation of the scale.");
  v({"center_mm", "Middle of the overlap, in the target's frame.", "mm"}, c.center_mm);
  std::vector<std::vector<std::optional<double>>> covariance(7);
  for (int i = 0; i < 7; ++i)
    for (int k = 0; k < 7; ++k) covariance[static_cast<std::size_t>(i)].push_back(if_finite(c.covariance(i, k)));
  v.derived("covariance", covariance,
            "Covariance of rotation vector (rad), translation (mm) and log scale, about center_mm.");
}

struct Registration {
  Similarity T_target_source;
  RegistrationOutcome outcome = RegistrationOutcome::Degenerate;
  std::vector<std::string> reasons;  ///< why it is not a success, and cautions: sentences for a person, worst first
  double rmse_mm = 0.0;   ///< rms of `residuals_mm`
  double noise_mm = 0.0;  ///< expected rmse_mm if the surfaces had the same shape: roughness of both clouds
  double inlier_fraction =
      0.0;  ///< of the source's points, [0, 1]: above the target, distance below 3 robust standard deviations
  double fit_fraction = 0.0;     ///< inliers as a share of the source's points above the target: low for another shape
  double target_fraction = 0.0;  ///< matched share of the target's points, by the drift's probability, [0, 1]
  double drift_sigma_mm = 0.0;   ///< width of the drift's Gaussians at the end
  int iterations = 0;            ///< of drift, ICP finish and settling together
  int starts = 0;                ///< of the search; 1 if a start was given
  double score = 0.0;               ///< share of the source that lies on the target to within the noise, [0, 1]
  double rival_score = 0.0;         ///< of the rival, the best pose that is distinct from this one; 0: none
  std::optional<Similarity> rival;  ///< that pose
  double shape_rmse_mm = 0.0;   ///< `rmse_mm` before settling was searched for
  double mirror_score = 0.0;    ///< `score` of the best pose found for the source's mirror image
  double mirror_rmse_mm = 0.0;  ///< `rmse_mm` of that pose
  bool is_handedness_determined = false;  ///< the mirror image fits clearly less well than the source
  /// Signed distances along the normals, from target to source, of the source's points above the target and within a
  /// tenth of its radius, mm.
  std::vector<double> residuals_mm;
  /// Misfit that neither noise nor settling explains: the 90th percentile over neighbourhoods, each the median distance
  /// within a fifth of the target's radius, less its noise.
  double shape_residual_mm = 0.0;
  double settled_rms_mm = 0.0;  ///< of the settling found with the pose; 0 if it was not searched for
  double settled_max_mm = 0.0;  ///< the greatest amount of that settling
  bool scale_at_limit = false;       ///< the scale is at an end of its range
  bool is_scale_suspicious = false;  ///< the scale is outside 0.95 to 1.05, although both sensors are metric
  PoseObservability certificate;
};
void describe(Visitor& v, Registration& r);

/// Finds the similarity that lays a source surface on a target surface. The target may show only a part of the source,
/// with noise, holes and stray points. The search runs rigid coherent point drift on coarse clusters from rotations
/// spread evenly over all rotations, each at seven positions along the source's two longest axes, and refines the best
/// poses. The best three then pass through the drift on the clouds (as at most about `drift_points` clusters) and an
/// ICP finish on all points. If both clouds have normals, they decide which side is up. With `settling_mm` the last
/// step finds the pose together with a smooth displacement along the source's mean normal, so that a dip is not
/// mistaken for a shift. The result is never a reflection; the source's mirror image is fitted too, and if it fits
/// better, the outcome is Mirrored. Trust the transform only if `outcome` is Converged; `reasons` lists every
/// objection. Same bits at any thread count.
/// @param source, target  at least 1 point each, finite, any unit, the result's too; unit normals or none.
/// @throws InvalidArgument for unusable clouds or settings. Sources: [Myronenko2010], [Alexa2022] (even rotations).
[[nodiscard]] Registration register_clouds(const PointCloud& source, const PointCloud& target,
                                           const RegistrationSettings& settings, Workers& workers, Monitor& monitor);

}  // namespace incise
