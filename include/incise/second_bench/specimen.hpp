#pragma once

#include <incise/bench_kit/hidden_parameter.hpp>
#include <incise/core/describe.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string_view>

namespace incise::second_bench {

/// A group of hidden parameters that either vary from specimen to specimen or keep their defaults.
enum class Factor {
  Ring,          ///< size, shape and place of the tumour
  Prescription,  ///< margin, depth, speed and start of the cut
  Fibres,
  Stiffening,
  Tumor,       ///< stiffness of the tumour
  Relaxation,  ///< ratio and time of the viscous branch; times of cut and gauge reading
  Cutting,     ///< ablation energy, lost power, reach of the arc, toughness, adhesion, char
  Pull,        ///< bias of the gauge
  Suture,      ///< creep of the suture during the cut
  Platform,    ///< friction and relief
  Motion,      ///< drift and breathing
  HandEye,     ///< hand-eye error, shared by all specimens of a series
  Imaging,     ///< scanner, segmentation, pose in the scanner, lens
  Photograph,  ///< distance and tilt of its camera, hand of the annotator, stains
  Arm,         ///< lag, wandering, bending of the needle
  Heat,        ///< shrinking of heated tissue
};
inline constexpr std::array<std::string_view, 16> kFactorNames{
    "ring",   "prescription", "fibres", "stiffening", "tumor",   "relaxation", "cutting", "pull",
    "suture", "platform",     "motion", "hand_eye",   "imaging", "photograph", "arm",     "heat"};
[[nodiscard]] constexpr Names names_of(Factor) {
  return kFactorNames;
}
using Factors = std::set<Factor>;
[[nodiscard]] Factors all_factors();

/// The hidden parameters of a specimen of the second bench, and its prescription. A parameter keeps its default if its
/// factor does not vary. parameters() gives the meaning, spread and source of each.
struct Specimen {
  std::uint64_t seed = 1;    ///< of shape, fields inside, all noise and all parameters but the hand-eye error
  std::uint64_t series = 1;  ///< seed of the hand-eye error, which the specimens of a series share

  // The tumour, at rest.
  double tumor_diameter_mm = 18.5;
  double tumor_irregularity = 0.12;
  double tumor_depth_mm = 4.0;
  double tumor_along = 0.47;
  double tumor_aside = 0.0;

  // Prescription, known to the planner.
  double margin_mm = 5.0;
  double depth_mm = 5.0;
  double speed_mm_s = 7.0;
  double start_deg = 0.0;

  // Mechanics of the tissue; times from the stretch to the cut and to the gauge's reading.
  double youngs_modulus_kpa = 10.0;
  double poissons_ratio = 0.46;
  double stiffness_spread = 0.12;
  double fibre_ratio = 1.0;
  double stiffening = 0.0;
  double tumor_ratio = 3.0;
  double relaxing_ratio = 1.0;
  double relaxation_time_s = 8.0;
  double wait_s = 120.0;
  double gauge_s = 120.0;

  // Cutting.
  double ablation_j_mm3 = 0.38;
  double ablation_spread = 0.07;
  double lost_power_w = 15.0;
  double reach_mm = 0.25;
  double toughness_j_m2 = 300.0;
  double adhesion_kpa = 90.0;
  double char_per_mm = 0.0;
  double shrinking = 0.0;

  // Holder, and motion during the cut.
  double stretch_error_mm = 0.0;
  double stretch_angle_deg = 0.0;
  double clamp_slip_mm = 0.8;
  double force_bias = 0.0;
  double suture_creep_mm = 0.0;
  double friction = 0.0;
  double sole_relief_mm = 0.0;
  double breathing_mm = 0.0;
  double drift_mm = 0.0;

  // Arm, scanner, cameras and placement.
  double hand_eye_x_mm = 0.0;
  double hand_eye_y_mm = 0.0;
  double hand_eye_z_mm = 0.0;
  double ct_blur_mm = 0.4;
  double ct_slice_mm = 0.8;
  double segmentation_mm = 0.0;
  double sag = 0.0;
  double lens_distortion = 0.0;
  double camera_distance_mm = 10000.0;
  double photograph_tilt_deg = 0.0;
  double annotator_mm = 0.03;
  double stains = 0.0;
  double lag_s = 0.0;
  double wander_mm = 0.05;
  double bending_mm_n = 0.0;
  double placement_x_mm = 0.0;
  double placement_y_mm = 0.0;
  double placement_turn_deg = 0.0;

  [[nodiscard]] bool operator==(const Specimen&) const = default;
};
void describe(Visitor& v, Specimen& specimen);

/// One hidden parameter, and the factor with which it varies.
struct Parameter : HiddenParameter<Specimen> {
  std::optional<Factor> factor;  ///< absent: it always varies
};
/// Returns all hidden parameters, in the order of Specimen.
[[nodiscard]] std::span<const Parameter> parameters();

/// Draws a specimen at random. Each parameter has its own random stream, so a new parameter leaves the others
/// unchanged.
/// @param factors  the factors that vary, beside the parameters without a factor; other parameters keep the defaults of
///                 Specimen.
[[nodiscard]] Specimen draw_specimen(std::uint64_t seed, std::uint64_t series, const Factors& factors);

/// Returns the power that the surgeon sets for the specimen's depth and speed, W: the power that ablates a kerf as wide
/// as electrode and arc (20 W at 5 mm and 7 mm/s, proportional to both) plus the 15 W that are lost; at least 20 W.
/// Paper II-B.3: 35 W at 5 mm and 7 mm/s.
[[nodiscard]] double prescribed_power_w(const Specimen& specimen);

}  // namespace incise::second_bench
