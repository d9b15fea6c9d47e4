#include <incise/second_bench/specimen.hpp>

#include <algorithm>
#include <optional>

namespace incise::second_bench {
namespace {

using S = Specimen;
constexpr std::string_view kMark = "marked contour in the RGB-D frame";
constexpr std::string_view kCloud = "camera cloud";
constexpr std::string_view kPull = "stretch_force_n";
constexpr std::string_view kPrescription = "prescription";
constexpr std::string_view kPhoto = "photograph of the cut";
constexpr std::string_view kNone = "none";
constexpr auto kUniform = DrawnAs::Uniform;
constexpr auto kNormal = DrawnAs::Normal;
constexpr auto kLogNormal = DrawnAs::LogNormal;
constexpr std::optional<Factor> kAlways = std::nullopt;

/// Returns a parameter that varies with a factor, or always. @param values  the fields of HiddenParameter, in order.
template <class... Values>
constexpr Parameter varies(std::optional<Factor> with, const Values&... values) {
  return {{values...}, with};
}

constexpr std::array kParameters{
    varies(Factor::Ring, "tumor_diameter_mm", &S::tumor_diameter_mm, kUniform, 12.0, 26.0, 8.0, 30.0,
           "Mean diameter of the tumour's edge at rest.", "T1 and small T2 cancers: below 20 and 40 mm; chosen", kMark),
    varies(Factor::Ring, "tumor_irregularity", &S::tumor_irregularity, kUniform, 0.05, 0.20, 0.0, 0.25,
           "Sum of the amplitudes of the edge's harmonics divided by its radius.", "Paper: figure 5, read off; wider",
           kMark),
    varies(Factor::Ring, "tumor_depth_mm", &S::tumor_depth_mm, kUniform, 2.0, 6.0, 1.0, 9.0,
           "Depth of the stiff inclusion beneath the edge.", "T1: less than 5 mm deep; wider: chosen", kNone),
    varies(Factor::Ring, "tumor_along", &S::tumor_along, kUniform, 0.40, 0.54, 0.35, 0.60,
           "Distance of the tumour's middle from the tip, as a share of the specimen's length.",
           "chosen: what clamp and suture leave", kMark),
    varies(Factor::Ring, "tumor_aside", &S::tumor_aside, kUniform, -0.9, 0.9, -1.0, 1.0,
           "Distance of the tumour's middle from the mid-line, as a share of the room beside the ring.",
           "most tongue cancers lie at the lateral border; chosen", kMark),

    varies(Factor::Prescription, "margin_mm", &S::margin_mm, kUniform, 3.0, 8.0, 2.0, 10.0,
           "Margin of healthy tissue round the tumour.",
           "5 mm by custom, 2.2 to 7.5 mm proposed: PMC5473778 and its replies", kPrescription),
    varies(Factor::Prescription, "depth_mm", &S::depth_mm, kUniform, 3.0, 8.0, 2.0, 10.0,
           "Depth of the tool's tip below the skin.", "chosen: as the margin", kPrescription),
    varies(Factor::Prescription, "speed_mm_s", &S::speed_mm_s, kUniform, 2.0, 12.0, 1.0, 15.0, "Speed of the tool.",
           "2 mm/s: Ge 2024; 7 mm/s: Paper II-B.4; up to 10: nriaziat/thermo; wider: chosen", kPrescription),
    varies(Factor::Prescription, "start_deg", &S::start_deg, kUniform, 0.0, 360.0, 0.0, 360.0,
           "Direction in which the cut starts: turn about the vertical from the tip's side.", "chosen", kPrescription),

    varies(kAlways, "youngs_modulus_kpa", &S::youngs_modulus_kpa, kLogNormal, 10.0, 0.25, 3.0, 60.0,
           "Long-time Young's modulus across the fibres at small strain.",
           "[Cheng2011]: E some 8 kPa in vivo; [Buchaillard2009]: 6.2 kPa; raised for dead muscle; spread chosen",
           kPull),
    varies(kAlways, "poissons_ratio", &S::poissons_ratio, kUniform, 0.45, 0.47, 0.3, 0.48, "Poisson's ratio.",
           "chosen: nearly incompressible", kNone),
    varies(kAlways, "stiffness_spread", &S::stiffness_spread, kUniform, 0.05, 0.20, 0.0, 0.6,
           "Standard deviation of the logarithm of stiffness from place to place, in 15 mm waves.", "chosen", kNone),
    varies(Factor::Fibres, "fibre_ratio", &S::fibre_ratio, kUniform, 1.0, 6.0, 1.0, 8.0,
           "Stiffness along stretched fibres divided by that across them.",
           "porcine muscle is stiffer along its fibres (Song 2007, Pietsch 2014); range chosen", kPull),
    varies(Factor::Stiffening, "stiffening", &S::stiffening, kUniform, 0.2, 0.8, 0.0, 2.0, "c2 / c1 of Yeoh's energy.",
           "0.47 both in [Gerard2005] and [Buchaillard2009]; range chosen", kPull),
    varies(Factor::Tumor, "tumor_ratio", &S::tumor_ratio, kLogNormal, 7.0, 0.8, 1.0, 40.0,
           "Stiffness inside the tumour divided by that outside.",
           "[TongueStrain2022]: 9.7 +- 9.8 (n = 62): a log-normal of median 6.9, sd 0.84", kNone),
    varies(Factor::Relaxation, "relaxing_ratio", &S::relaxing_ratio, kUniform, 0.5, 3.0, 0.0, 10.0,
           "Stiffness that relaxes divided by that which remains.",
           "[Palevski2006]: up to 13 at a step, not preconditioned; less at the rates here: chosen", kPull),
    varies(Factor::Relaxation, "relaxation_time_s", &S::relaxation_time_s, kUniform, 4.0, 20.0, 1.0, 100.0,
           "Relaxation time of the stiffness that relaxes.", "[Palevski2006]: plateau at some 20 s", kPull),
    varies(Factor::Relaxation, "wait_s", &S::wait_s, kUniform, 30.0, 300.0, 0.0, 3600.0,
           "Time from the stretch to the cut.", "chosen", kNone),
    varies(Factor::Relaxation, "gauge_s", &S::gauge_s, kUniform, 2.0, 60.0, 0.0, 3600.0,
           "Time from the stretch to the reading of the pull.", "chosen", kPull),

    varies(Factor::Cutting, "ablation_j_mm3", &S::ablation_j_mm3, kLogNormal, 0.38, 0.10, 0.1, 3.0,
           "Energy that parts tissue by heat, per volume.",
           "2.6 J/mm3 boil tissue away, part of which rupture by steam saves; fits Paper II-B.3: at 7 mm/s 25 W do "
           "not cut, 35 W do",
           kNone),
    varies(Factor::Cutting, "ablation_spread", &S::ablation_spread, kUniform, 0.03, 0.12, 0.0, 0.6,
           "Standard deviation of the logarithm of ablation energy from place to place, in 12 mm waves.", "chosen",
           kNone),
    varies(Factor::Cutting, "lost_power_w", &S::lost_power_w, kNormal, 15.0, 0.5, 8.0, 22.0,
           "Power lost in leads, plate and drying before the arc holds.",
           "[Karaki2020], porcine liver: no effect at 10 W, no cut at 25 W; in between: chosen", kNone),
    varies(Factor::Cutting, "reach_mm", &S::reach_mm, kUniform, 0.15, 0.35, 0.1, 1.0,
           "Reach of the arc beyond the metal.", "kerfs of 0.15 to 0.70 mm beyond the tool: Life 13:162; chosen",
           kPhoto),
    varies(Factor::Cutting, "toughness_j_m2", &S::toughness_j_m2, kLogNormal, 300.0, 0.30, 50.0, 3000.0,
           "Work that tears tissue, per area.",
           "[Liu2022], table 2: porcine lamina propria 169 to 451 J/m2; three times the first bench's spread", kNone),
    varies(Factor::Cutting, "adhesion_kpa", &S::adhesion_kpa, kLogNormal, 90.0, 0.45, 5.0, 600.0,
           "Traction at which tissue lets go of the metal at high tool speed.",
           "chosen: errors as planned like Paper Table II; three times the first bench's spread", kNone),
    varies(Factor::Cutting, "char_per_mm", &S::char_per_mm, kUniform, 0.0, 0.008, 0.0, 0.05,
           "Relative growth of adhesion per millimetre of travel.", "chosen: char builds up on an electrode", kNone),
    varies(Factor::Heat, "shrinking", &S::shrinking, kUniform, 0.12, 0.22, 0.0, 0.4,
           "Share of its length by which heated tissue shrinks.", "liver: 12 to 22 % at 60 to 95 degrees C", kPhoto),

    varies(kAlways, "stretch_error_mm", &S::stretch_error_mm, kNormal, 0.0, 1.0, -8.0, 8.0,
           "Error of the 20 mm by which the suture is drawn.", "chosen: knots slip", kCloud),
    varies(kAlways, "stretch_angle_deg", &S::stretch_angle_deg, kNormal, 0.0, 3.0, -15.0, 15.0,
           "Sideways angle of the pull.", "chosen: set by eye", kCloud),
    varies(kAlways, "clamp_slip_mm", &S::clamp_slip_mm, kUniform, 0.0, 2.0, 0.0, 8.0,
           "Distance by which the root is pulled out of the clamp.", "chosen: wet muscle between jaws", kCloud),
    varies(Factor::Pull, "force_bias", &S::force_bias, kNormal, 0.0, 0.20, -0.6, 0.6,
           "Relative error of the force gauge.", "chosen: a spring scale, read in passing", kPull),
    varies(Factor::Suture, "suture_creep_mm", &S::suture_creep_mm, kUniform, 0.0, 1.5, 0.0, 10.0,
           "Distance by which the suture cuts into the tissue during the cut.", "chosen", kNone),
    varies(Factor::Platform, "friction", &S::friction, kUniform, 0.0, 0.5, 0.0, 1.0,
           "Coefficient of friction between sole and platform.", "chosen: wet to dry tissue on plastic", kNone),
    varies(Factor::Platform, "sole_relief_mm", &S::sole_relief_mm, kUniform, 0.0, 1.0, 0.0, 3.0,
           "Standard deviation of the platform's height under the sole, in 25 mm waves.", "chosen: drape and gauze",
           kNone),
    varies(Factor::Motion, "breathing_mm", &S::breathing_mm, kUniform, 0.1, 0.5, 0.0, 3.0,
           "Amplitude of a rise and fall every 4 s.", "chosen: 0.2 to 1 mm from end to end", kNone),
    varies(Factor::Motion, "drift_mm", &S::drift_mm, kUniform, -1.0, 1.0, -5.0, 5.0,
           "Sideways drift of the specimen over the cut.", "chosen", kNone),

    varies(Factor::HandEye, "hand_eye_x_mm", &S::hand_eye_x_mm, kNormal, 0.0, 0.6, -1.5, 1.5,
           "Offset of the tip from its intended place along x, base frame; one for a series.",
           "Paper [21]: millimetre accuracy in all; 0.5 to 1.5 mm: chosen", kPhoto),
    varies(Factor::HandEye, "hand_eye_y_mm", &S::hand_eye_y_mm, kNormal, 0.0, 0.6, -1.5, 1.5,
           "Offset of the tip from its intended place along y, base frame; one for a series.", "as hand_eye_x_mm",
           kPhoto),
    varies(Factor::HandEye, "hand_eye_z_mm", &S::hand_eye_z_mm, kNormal, 0.0, 0.6, -1.5, 1.5,
           "Offset of the tip from its intended place along z, base frame; one for a series.", "as hand_eye_x_mm",
           kNone),
    varies(Factor::Imaging, "ct_blur_mm", &S::ct_blur_mm, kUniform, 0.3, 1.0, 0.1, 2.0,
           "Standard deviation of the scanner's point spread.", "chosen: soft to sharp kernels", "CT"),
    varies(Factor::Imaging, "ct_slice_mm", &S::ct_slice_mm, kUniform, 0.8, 2.0, 0.5, 3.0, "Distance between slices.",
           "chosen", "CT"),
    varies(Factor::Imaging, "segmentation_mm", &S::segmentation_mm, kUniform, -0.7, 0.7, -2.0, 2.0,
           "Thickness by which the specimen seems larger all round.", "chosen", "CT"),
    varies(Factor::Imaging, "sag", &S::sag, kUniform, -0.01, 0.04, -0.1, 0.15,
           "Share by which the specimen is lower, and wider, in the scanner.", "chosen: it lay otherwise", "CT"),
    varies(Factor::Imaging, "lens_distortion", &S::lens_distortion, kUniform, -0.03, 0.03, -0.3, 0.3,
           "First radial coefficient of the distortion that the camera's calibration leaves.", "chosen", kCloud),
    varies(Factor::Photograph, "camera_distance_mm", &S::camera_distance_mm, kUniform, 200.0, 400.0, 100.0, 10000.0,
           "Distance of the photograph's camera from the tissue.", "chosen: held by hand", kPhoto),
    varies(Factor::Photograph, "photograph_tilt_deg", &S::photograph_tilt_deg, kUniform, 0.0, 8.0, 0.0, 20.0,
           "Tilt of the photograph's camera from straight down, in any direction.", "chosen: held by hand", kPhoto),
    varies(Factor::Photograph, "annotator_mm", &S::annotator_mm, kUniform, 0.2, 0.4, 0.0, 1.0,
           "Standard deviation of the hand that draws the kerf's inner edge.", "chosen", kPhoto),
    varies(Factor::Photograph, "stains", &S::stains, kUniform, 0.3, 1.0, 0.0, 1.0,
           "Amount of char, blood and glare in the photograph; 0: none.", "chosen", kPhoto),
    varies(Factor::Arm, "lag_s", &S::lag_s, kUniform, 0.0, 0.08, 0.0, 0.5, "Lag of the arm behind its program.",
           "servo loops of some tens of ms; chosen", kNone),
    varies(Factor::Arm, "wander_mm", &S::wander_mm, kUniform, 0.05, 0.20, 0.0, 1.0,
           "Standard deviation of the tip from its course, in 20 mm waves.", "[UrDataSheet]: repeatability 0.05 mm",
           kNone),
    varies(Factor::Arm, "bending_mm_n", &S::bending_mm_n, kUniform, 0.0, 0.4, 0.0, 3.0,
           "Deflection of the needle's tip per force.", "chosen: steel, 1 mm thick, 60 to 80 mm long", kNone),
    varies(kAlways, "placement_x_mm", &S::placement_x_mm, kNormal, 0.0, 8.0, -40.0, 40.0,
           "Place of the specimen on the table along x, base frame.", "chosen: set down by hand", kCloud),
    varies(kAlways, "placement_y_mm", &S::placement_y_mm, kNormal, 0.0, 8.0, -40.0, 40.0,
           "Place of the specimen on the table along y, base frame.", "chosen: set down by hand", kCloud),
    varies(kAlways, "placement_turn_deg", &S::placement_turn_deg, kNormal, 0.0, 5.0, -45.0, 45.0,
           "Turn of the specimen on the table about the vertical.", "chosen: set down by hand", kCloud),
};

}  // namespace

Factors all_factors() {
  Factors all;
  for (std::size_t n = 0; n < kFactorNames.size(); ++n) all.insert(static_cast<Factor>(n));
  return all;
}

std::span<const Parameter> parameters() {
  return kParameters;
}

Specimen draw_specimen(std::uint64_t seed, std::uint64_t series, const Factors& factors) {
  Specimen specimen;
  specimen.seed = seed;
  specimen.series = series;
  for (const Parameter& parameter : kParameters) {
    if (parameter.factor && !factors.contains(*parameter.factor)) continue;
    specimen.*parameter.member = drawn(parameter, parameter.factor == Factor::HandEye ? series : seed);
  }
  return specimen;
}

double prescribed_power_w(const Specimen& specimen) {
  return std::max(20.0, 15.0 + 20.0 * specimen.depth_mm * specimen.speed_mm_s / (5.0 * 7.0));
}

void describe(Visitor& v, Specimen& specimen) {
  v("seed", specimen.seed,
    "Seed of the shape, of the fields inside, of all noise and of all parameters but the hand-eye error.");
  v("series", specimen.series, "Seed of the hand-eye error, which the specimens of a series share.");
  for (const Parameter& parameter : kParameters)
    v(parameter.name, specimen.*parameter.member, parameter.meaning, Range{parameter.low, parameter.high});
}

}  // namespace incise::second_bench
