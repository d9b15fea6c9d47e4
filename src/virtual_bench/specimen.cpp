#include <incise/virtual_bench/specimen.hpp>

namespace incise {
namespace {

using S = Specimen;
constexpr auto kUniform = DrawnAs::Uniform;
constexpr auto kNormal = DrawnAs::Normal;
constexpr auto kLogNormal = DrawnAs::LogNormal;
constexpr std::string_view kMark = "marked contour in the RGB-D frame";
constexpr std::string_view kCloud = "camera cloud";
constexpr std::string_view kPull = "stretch_force_n";
constexpr std::string_view kMap = "elasticity map";
constexpr std::string_view kNone = "none";

constexpr ParameterSpec kSpecs[] = {
    {"tumor_diameter_mm", &S::tumor_diameter_mm, kNormal, 18.5, 0.5, 14.0, 22.0,
     "Mean diameter of the tumour's edge at rest; some 20 mm once stretched.",
     "Paper: II-A, 2 cm; spread chosen: a hand-drawn mark", kMark},
    {"tumor_irregularity", &S::tumor_irregularity, kUniform, 0.08, 0.16, 0.0, 0.25,
     "Sum of the amplitudes of the edge's harmonics divided by its radius.", "Paper: figure 5, read off", kMark},
    {"tumor_depth_mm", &S::tumor_depth_mm, kUniform, 3.0, 5.0, 1.0, 8.0,
     "Depth of the stiff inclusion beneath the edge.", "chosen: T1, less than 5 mm deep", kNone},
    {"tumor_position", &S::tumor_position, kUniform, 0.44, 0.50, 0.4, 0.6,
     "Distance of the tumour's middle from the tip, as a share of the specimen's length.", "Paper: figure 2, read off",
     kMark},

    {"youngs_modulus_kpa", &S::youngs_modulus_kpa, kLogNormal, 12.0, 0.20, 3.0, 120.0,
     "Long-time Young's modulus of the muscle across its fibres.",
     "[Cheng2011]: shear modulus 2.67 +- 0.29 kPa in vivo, E some 8 kPa; [Buchaillard2009]: 6.2 kPa; "
     "raised for dead muscle, spread chosen",
     kPull},
    {"poissons_ratio", &S::poissons_ratio, kUniform, 0.45, 0.47, 0.3, 0.49, "Poisson's ratio.",
     "chosen: nearly incompressible, without locking the mesh", kNone},
    {"stiffness_spread", &S::stiffness_spread, kUniform, 0.05, 0.15, 0.0, 0.6,
     "Standard deviation of the logarithm of stiffness from place to place, in 15 mm waves.",
     "chosen: below that between specimens", kMap},
    {"inclusion_ratio", &S::inclusion_ratio, kLogNormal, 3.0, 0.3, 0.5, 15.0,
     "Stiffness inside the tumour divided by that outside.",
     "[TongueStrain2022]: strain ratio of tongue cancer 9.7 +- 9.8 (n = 62), skewed; lower here, since "
     "specimens contain a stand-in for cancer: chosen",
     kMap},
    {"fibre_ratio", &S::fibre_ratio, kUniform, 0.2, 0.6, 0.0, 3.0,
     "Stiffness added along the fibres divided by Young's modulus.",
     "[Song2007]: porcine muscle tested along and across its fibres; amount chosen", kPull},
    {"fibre_angle_deg", &S::fibre_angle_deg, kNormal, 0.0, 15.0, -60.0, 60.0,
     "Angle of the fibres from the long axis, seen from above.",
     "chosen: fibres of the back run lengthwise, more or less", kNone},
    {"relaxing_ratio", &S::relaxing_ratio, kUniform, 1.0, 2.0, 0.0, 8.0,
     "Shear stiffness that relaxes divided by the long-time one.",
     "[Palevski2006]: porcine muscle relaxes from 5711 Pa to 807 Pa after an indentation at 2 m/s; less "
     "here, where rates are small: chosen",
     kNone},
    {"relaxation_time_s", &S::relaxation_time_s, kUniform, 4.0, 8.0, 0.1, 60.0,
     "Relaxation time of the stiffness that relaxes.",
     "[Palevski2006]: a plateau after some 20 s, three to five of these times", kNone},

    {"toughness_j_m2", &S::toughness_j_m2, kLogNormal, 300.0, 0.10, 50.0, 3000.0, "Work that parts tissue, per area.",
     "[Liu2022], table 2: porcine lamina propria 169 to 451 J/m2, liver 76 to 225; the middle, spread "
     "between specimens chosen",
     kNone},
    {"toughness_spread", &S::toughness_spread, kUniform, 0.05, 0.15, 0.0, 0.6,
     "Standard deviation of the logarithm of toughness from place to place, in 12 mm waves.",
     "[Liu2022], table 2: lamina propria differs by location by a factor of 2.7; less here, on one back: chosen",
     kNone},
    {"lost_power_w", &S::lost_power_w, kNormal, 15.0, 0.5, 0.0, 24.0,
     "Power lost in leads, plate and drying before the arc holds.",
     "[Karaki2020], porcine liver: no effect at 10 W, coagulates without cutting at 25 W; in between: chosen", kNone},
    {"rupture_percent", &S::rupture_percent, kLogNormal, 1.2, 0.06, 0.01, 10.0,
     "Share of the remaining power that steam turns into work on tissue.",
     "chosen: fits Paper II-B.3, bulging below 35 W at 7 mm/s", kNone},
    {"full_arc_w", &S::full_arc_w, kNormal, 45.0, 1.0, 41.0, 80.0,
     "Power at which the arc never breaks off; steam then keeps tissue off the electrode.",
     "Paper [14] on contact and arc; chosen: fits Paper II-B.3", kNone},
    {"adhesion_kpa_s_mm2", &S::adhesion_kpa_s_mm2, kLogNormal, 300.0, 0.15, 0.1, 3000.0,
     "Drag of the electrode on tissue per volume and speed.", "chosen: fits Paper Table II, S1 and S2", kNone},
    {"adhesion_limit_kpa_mm", &S::adhesion_limit_kpa_mm, kLogNormal, 740.0, 0.10, 1.0, 5000.0,
     "Limit of the electrode's drag while electrode and tissue touch.", "chosen: fits Paper Table II, S1 and S2",
     kNone},
    {"heat_percent", &S::heat_percent, kNormal, 55.0, 1.5, 5.0, 100.0,
     "Share of the power that heats the kerf's walls.",
     "[Monteiro2019], oral mucosa: 1.0 +- 0.4 mm of damage; Paper II-B.3: discoloured at 40 W, not at 35 W",
     "discoloured rim in the photograph"},

    {"clamp_slip_mm", &S::clamp_slip_mm, kUniform, 0.0, 2.0, 0.0, 12.0,
     "Distance by which the root is pulled out of the clamp.", "chosen: wet muscle between jaws", kCloud},
    {"stretch_error_mm", &S::stretch_error_mm, kNormal, 0.0, 1.0, -12.0, 12.0,
     "Error of the 20 mm by which the suture is drawn.", "chosen: the suture cuts in and knots slip", kCloud},
    {"stretch_angle_deg", &S::stretch_angle_deg, kNormal, 0.0, 3.0, -20.0, 20.0, "Sideways angle of the pull.",
     "chosen: set by eye", kCloud},

    {"robot_offset_x_mm", &S::robot_offset_x_mm, kNormal, 0.0, 0.3, -3.0, 3.0,
     "Offset of the tip from its intended place along x, base frame.",
     "Paper [21]: millimetre accuracy in all, hand-eye calibration "
     "included; spread chosen",
     kNone},
    {"robot_offset_y_mm", &S::robot_offset_y_mm, kNormal, 0.0, 0.3, -3.0, 3.0,
     "Offset of the tip from its intended place along y, base frame.", "as robot_offset_x_mm", kNone},
    {"robot_offset_z_mm", &S::robot_offset_z_mm, kNormal, 0.0, 0.3, -3.0, 3.0,
     "Offset of the tip from its intended place along z, base frame.", "as robot_offset_x_mm", kNone},
    {"robot_turn_deg", &S::robot_turn_deg, kNormal, 0.0, 0.2, -5.0, 5.0,
     "Turn of the course about the vertical through the tumour.", "as robot_offset_x_mm", kNone},
    {"robot_wander_mm", &S::robot_wander_mm, kUniform, 0.03, 0.08, 0.0, 1.0,
     "Standard deviation of the tip from its course, in 20 mm waves.", "[UrDataSheet]: repeatability 0.05 mm", kNone},

    {"placement_x_mm", &S::placement_x_mm, kNormal, 0.0, 8.0, -40.0, 40.0,
     "Place of the specimen on the table along x, base frame.", "chosen: set down by hand", kCloud},
    {"placement_y_mm", &S::placement_y_mm, kNormal, 0.0, 8.0, -40.0, 40.0,
     "Place of the specimen on the table along y, base frame.", "chosen: set down by hand", kCloud},
    {"placement_turn_deg", &S::placement_turn_deg, kNormal, 0.0, 5.0, -45.0, 45.0,
     "Turn of the specimen on the table about the vertical.", "chosen: set down by hand", kCloud},
    {"camera_tilt_deg", &S::camera_tilt_deg, kNormal, 0.0, 4.0, -20.0, 20.0, "Tilt of the camera from straight down.",
     "chosen: mounted on the arm", kCloud},
    {"depth_scale", &S::depth_scale, kNormal, 1.0, 0.006, 0.9, 1.1,
     "Measured distance from the camera divided by the true one.",
     "[RealSenseD400]: accuracy within 2 % at 50 cm; spread chosen, calibrated", kCloud},
    {"depth_noise_mm", &S::depth_noise_mm, kUniform, 0.1, 0.3, 0.0, 3.0, "Standard deviation of a pixel's depth.",
     "[RealSenseD400]: range 7 to 50 cm; noise chosen, below 1 mm at 20 cm", kCloud},
    {"hole_percent", &S::hole_percent, kUniform, 1.0, 5.0, 0.0, 40.0,
     "Share of the depth picture without a reading, in patches.", "chosen: wet tissue glares", kCloud},
    {"ct_noise_hu", &S::ct_noise_hu, kUniform, 10.0, 20.0, 0.0, 60.0, "Standard deviation of a voxel's value.",
     "chosen: a clinical head protocol", "CT"},
};

}  // namespace

std::span<const ParameterSpec> parameter_specs() {
  return kSpecs;
}

Specimen draw_specimen(std::uint64_t seed) {
  Specimen specimen;
  specimen.seed = seed;
  for (const ParameterSpec& spec : kSpecs) specimen.*spec.member = drawn(spec, seed);
  return specimen;
}

void describe(Visitor& v, Specimen& specimen) {
  v("seed", specimen.seed, "Seed of the shape, of the fields inside and of all noise.");
  for (const ParameterSpec& spec : parameter_specs())
    v(spec.name, specimen.*spec.member, spec.meaning, Range{spec.low, spec.high});
}

}  // namespace incise
