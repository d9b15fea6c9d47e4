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

/// What can be made to vary from specimen to specimen, or be held still.
enum class Factor {
  Ring,          ///< size, shape and place of the tumour
  Prescription,  ///< margin, depth, speed and start of the cut
  Fibres,
  Stiffening,
  Tumor,  ///< its stiffness
  Relaxation,
  Cutting,  ///< energy that ablates, toughness, adhesion, char
  Pull,     ///< what the gauge says of it
  Suture,   ///< its creep during the cut
  Platform,
  Motion,   ///< drift and breathing
  HandEye,  ///< shared by all specimens of a series
  Imaging,  ///< scanner, segmentation, pose in the scanner, lens
  Photograph,
  Arm,
  Heat,  ///< shrinking rim
};
inline constexpr std::array<std::string_view, 16> kFactorNames{
    "ring",   "prescription", "fibres", "stiffening", "tumor",   "relaxation", "cutting", "pull",
    "suture", "platform",     "motion", "hand_eye",   "imaging", "photograph", "arm",     "heat"};
[[nodiscard]] constexpr Names names_of(Factor) {
  return kFactorNames;
}
using Factors = std::set<Factor>;
[[nodiscard]] Factors all_factors();

/// Everything that is hidden about a specimen of the second laboratory, and what its surgeon prescribes. A default is
/// what a parameter is where its factor is held still.
struct Specimen {
  std::uint64_t seed = 1;    ///< of the shape, of the fields inside, of all noise and of every parameter
  std::uint64_t series = 1;  ///< of the hand-eye error: specimens of one series share it

  // The tumour, at rest.
  double tumor_diameter_mm = 18.5;
  double tumor_irregularity = 0.12;
  double tumor_depth_mm = 4.0;
  double tumor_along = 0.47;
  double tumor_aside = 0.0;

  // What is prescribed: known to whoever plans.
  double margin_mm = 5.0;
  double depth_mm = 5.0;
  double speed_mm_s = 7.0;
  double start_deg = 0.0;

  // What it is made of.
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

  // How it is cut.
  double ablation_j_mm3 = 0.38;
  double ablation_spread = 0.07;
  double lost_power_w = 15.0;
  double reach_mm = 0.25;
  double toughness_j_m2 = 300.0;
  double adhesion_kpa = 90.0;
  double char_per_mm = 0.0;
  double shrinking = 0.0;

  // How it is held.
  double stretch_error_mm = 0.0;
  double stretch_angle_deg = 0.0;
  double clamp_slip_mm = 0.8;
  double force_bias = 0.0;
  double suture_creep_mm = 0.0;
  double friction = 0.0;
  double sole_relief_mm = 0.0;
  double breathing_mm = 0.0;
  double drift_mm = 0.0;

  // Eyes and arm.
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
/// All of them, in the order of Specimen.
[[nodiscard]] std::span<const Parameter> parameters();

/// A specimen at random. Each parameter has a stream of its own: a new one leaves the others as they were.
/// @param factors  what varies beside parameters without a factor; the rest stays at the defaults of Specimen.
[[nodiscard]] Specimen draw_specimen(std::uint64_t seed, std::uint64_t series, const Factors& factors);

/// Power that the surgeon sets for a cut of this depth and speed, W: what ablates a kerf as wide as electrode and arc,
/// 20 W at 5 mm and 7 mm/s, beside the 15 W that are lost; at least 20 W. Paper II-B.3: 35 W at 5 mm and 7 mm/s.
[[nodiscard]] double prescribed_power_w(const Specimen& specimen);

}  // namespace incise::second_bench
