#pragma once

#include <incise/bench_kit/hidden_parameter.hpp>
#include <incise/core/describe.hpp>

#include <cstdint>
#include <span>

namespace incise {

/// The hidden parameters of a virtual specimen, its holder, the arm and the camera over it. Defaults are the middle of
/// each spread. parameter_specs() gives the meaning, spread and source of each parameter, and the reading that shows
/// it.
struct Specimen {
  std::uint64_t seed = 1;  ///< of the shape, of the fields inside and of all noise

  // The tumour, at rest.
  double tumor_diameter_mm = 18.5;
  double tumor_irregularity = 0.12;
  double tumor_depth_mm = 4.0;
  double tumor_position = 0.46;

  // Mechanics of the tissue.
  double youngs_modulus_kpa = 12.0;
  double poissons_ratio = 0.46;
  double stiffness_spread = 0.12;
  double inclusion_ratio = 3.0;
  double fibre_ratio = 0.4;
  double fibre_angle_deg = 0.0;
  double relaxing_ratio = 1.5;
  double relaxation_time_s = 6.0;

  // Cutting.
  double toughness_j_m2 = 300.0;
  double toughness_spread = 0.12;
  double lost_power_w = 15.0;
  double rupture_percent = 1.2;
  double full_arc_w = 45.0;
  double adhesion_kpa_s_mm2 = 300.0;
  double adhesion_limit_kpa_mm = 740.0;
  double heat_percent = 55.0;

  // Holder.
  double clamp_slip_mm = 0.8;
  double stretch_error_mm = 0.0;
  double stretch_angle_deg = 0.0;

  // Arm: errors of its tip.
  double robot_offset_x_mm = 0.0;
  double robot_offset_y_mm = 0.0;
  double robot_offset_z_mm = 0.0;
  double robot_turn_deg = 0.0;
  double robot_wander_mm = 0.05;

  // Camera and scanner.
  double placement_x_mm = 0.0;
  double placement_y_mm = 0.0;
  double placement_turn_deg = 0.0;
  double camera_tilt_deg = 0.0;
  double depth_scale = 1.0;
  double depth_noise_mm = 0.2;
  double hole_percent = 3.0;
  double ct_noise_hu = 15.0;

  [[nodiscard]] bool operator==(const Specimen&) const = default;
};

using ParameterSpec = HiddenParameter<Specimen>;
/// Returns all hidden parameters, in the order of Specimen.
[[nodiscard]] std::span<const ParameterSpec> parameter_specs();

void describe(Visitor& v, Specimen& specimen);

/// Draws a specimen at random. Each parameter has its own random stream, so a new parameter leaves the others
/// unchanged.
[[nodiscard]] Specimen draw_specimen(std::uint64_t seed);

}  // namespace incise
