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

/// Settings of register_clouds. Lengths are shares of the target's root mean square radius, so that units do not
/// matter; but for `settling_mm`, which is in the clouds' unit.
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

/// Every violation; empty: valid.
[[nodiscard]] std::vector<Problem> validate(const RegistrationSettings& settings);

enum class RegistrationOutcome {
  Converged,
  IterationLimit,  ///< still moving when the steps ran out
  IllDetermined,   ///< the surfaces can slide along each other: some motion leaves the residual as it is
  Ambiguous,       ///< another pose fits about as well
  Mirrored,        ///< the source's mirror image fits clearly better: one of the clouds is reflected
  PoorFit,         ///< the residual is too large, or too little of the source finds a counterpart
  OtherShape,      ///< ridges and hollows of one surface are not those of the other: another specimen, or changed tissue
  ScaleAtLimit,    ///< the scale stands at an end of its range: what the clouds ask for lies beyond it
  Degenerate,      ///< a cloud is a point or a line, or has fewer than 12 points; no transform follows
  Cancelled,
};
inline constexpr std::array<std::string_view, 10> kRegistrationOutcomeNames{
    "converged", "iteration_limit", "ill_determined", "ambiguous",  "mirrored",
    "poor_fit",  "other_shape",     "scale_at_limit", "degenerate", "cancelled"};
[[nodiscard]] constexpr Names names_of(RegistrationOutcome) {
  return kRegistrationOutcomeNames;
}

/// How well two surfaces fix the transform between them. Seven motions (three turns and three shifts about the
/// overlap's middle, and the logarithm of the scale) are turned into the seven independent ones that the distances
/// along the normals see least to best, each measured by how far it moves the overlap (rms). A plane leaves three of
/// them (four with scale) at 0, a sphere three, a cylinder two. Sources: [Gelfand2003] for the slippage, [Censi2007]
/// for the covariance.
struct PoseObservability {
  int motions = 0;                  ///< 7, or 6 with the scale fixed
  std::array<double, 7> visible{};  ///< share of each motion that appears in the distances, ascending: eigenvalues of
                                    ///< the Gauss-Newton matrix
  /// The same for the two least visible ones, from moving the source to and fro and searching the nearest points anew:
  /// rise of the mean squared distance over the squared motion. Noise in the normals, which makes a plane look fixed
  /// above, does not show here.
  std::array<double, 2> sharpness{};
  double sd_mm = 0.0;          ///< standard deviation of the overlap's position from noise, all motions together (rms)
  double weakest_sd_mm = 0.0;  ///< along the least visible motion
  double rotation_sd_deg = 0.0;
  double translation_sd_mm = 0.0;  ///< of the overlap's middle
  double scale_sd = 0.0;           ///< relative
  Eigen::Matrix<double, 7, 7> covariance =
      Eigen::Matrix<double, 7, 7>::Zero();  ///< rotation vector (rad), translation (mm), log scale; about `center_mm`
  Vec3 center_mm = Vec3::Zero();            ///< middle of the overlap, target frame
  std::string weakest;                      ///< for a person: what kind of motion is least visible
};
inline void describe(Visitor& v, PoseObservability& c) {
  v("motions", c.motions, "7, or 6 with the scale fixed.");
  std::vector<std::optional<double>> visible;
  for (int k = 0; k < c.motions; ++k) visible.push_back(if_finite(c.visible[static_cast<std::size_t>(k)]));
  v.derived("visible", visible, "Share of each motion that appears in the distances, ascending.");
  v.derived("sharpness", std::vector{if_finite(c.sharpness[0]), if_finite(c.sharpness[1])},
            "Of the two least visible ones, from moving the source to and fro.");
  v("weakest_motion", c.weakest, "What kind of motion is least visible.");
  v.derived("weakest_sd_mm", if_finite(c.weakest_sd_mm), "Along the least visible motion.");
  v.derived("sd_mm", if_finite(c.sd_mm), "Of the overlap's position from noise, all motions together (rms).");
  v.derived("rotation_sd_deg", if_finite(c.rotation_sd_deg), "Of the rotation.");
  v.derived("translation_sd_mm", if_finite(c.translation_sd_mm), "Of the overlap's middle.");
  v.derived("scale_sd", if_finite(c.scale_sd), "Relative.");
  v({"center_mm", "Middle of the overlap, target frame.", "mm"}, c.center_mm);
  std::vector<std::vector<std::optional<double>>> covariance(7);
  for (int i = 0; i < 7; ++i)
    for (int k = 0; k < 7; ++k) covariance[static_cast<std::size_t>(i)].push_back(if_finite(c.covariance(i, k)));
  v.derived("covariance", covariance, "Of rotation vector (rad), translation (mm) and log scale, about center_mm.");
}

struct Registration {
  Similarity T_target_source;
  RegistrationOutcome outcome = RegistrationOutcome::Degenerate;
  std::vector<std::string> reasons;  ///< why it is not a success, or what to beware of: sentences for a person
  double rmse_mm = 0.0;   ///< of the distances along the normals, over the source's points that lie above the target
  double noise_mm = 0.0;  ///< what it would be if the surfaces were alike: roughness of both clouds
  double inlier_fraction =
      0.0;  ///< of the source's points: above the target, distance below 3 robust standard deviations
  double fit_fraction = 0.0;     ///< the same of those points alone that lie above the target: low for another shape
  double target_fraction = 0.0;  ///< of the target's points, by the drift's probability
  double drift_sigma_mm = 0.0;   ///< width of the drift's Gaussians at the end
  int iterations = 0;            ///< of drift and finish
  int starts = 0;
  double score = 0.0;               ///< share of the source that lies on the target to within the noise, [0, 1]
  double rival_score = 0.0;         ///< of the best pose that is another one; 0: none
  std::optional<Similarity> rival;  ///< that pose
  double shape_rmse_mm = 0.0;   ///< `rmse_mm` of the shapes as they are, before settling was looked for
  double mirror_score = 0.0;    ///< `score` of the best pose found for the source's mirror image
  double mirror_rmse_mm = 0.0;  ///< and its residual
  bool is_handedness_determined = false;  ///< the mirror image fits clearly less well than the source
  /// Distances along the normals, target to source, of the source's points that lie above the target (within a tenth of
  /// its radius), mm.
  std::vector<double> residuals_mm;
  /// Misfit that neither noise nor settling explains: what nine tenths of the surface keep within, of the residual
  /// averaged over some third of the target's radius.
  double shape_residual_mm = 0.0;
  double settled_rms_mm = 0.0;  ///< of the settling that was found beside the pose; 0 where none was looked for
  double settled_max_mm = 0.0;
  bool scale_at_limit = false;       ///< the scale stands at an end of its range
  bool is_scale_suspicious = false;  ///< outside 0.95 to 1.05: both sensors are metric
  PoseObservability certificate;
};
void describe(Visitor& v, Registration& r);

/// Finds the similarity that lays a source surface on a target surface which shows part of it, with noise, holes and
/// points that belong to nothing. Search: rigid coherent point drift on coarse clusters from starts spread over all
/// rotations (and three positions along the longest axis), the best few refined; then the drift on the full clouds and
/// an ICP finish. Where both clouds come with normals, these decide which side is up. Every result that is not to be
/// relied upon says so in `outcome` and `reasons`. With `settling_mm` the pose is, last, found together with a smooth
/// displacement along the source's mean normal, so that a dip is not taken for a shift. The same clouds give the same
/// bits at any thread count. A reflection is never returned; the source's mirror image is fitted too, and where it fits
/// better the outcome is Mirrored.
/// @param source, target  at least 1 point each, finite, any unit; normals of unit length or none.  @throws
/// InvalidArgument. Sources: [Myronenko2010], [Alexa2022] (even rotations).
[[nodiscard]] Registration register_clouds(const PointCloud& source, const PointCloud& target,
                                           const RegistrationSettings& settings, Workers& workers, Monitor& monitor);

}  // namespace incise
