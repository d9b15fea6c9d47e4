#pragma once

#include <incise/robot/program_text.hpp>

#include <string>

namespace incise::robot_detail {

/// Visits every setting that a program was made with, then every limit of its checks, with key and name in the header.
template <class Record, class Visit>
void describe(Record& r, Visit&& visit) {
  auto& s = r.settings;
  visit("setting", "approach_speed_mm_s", s.approach_speed_mm_s);
  visit("setting", "plunge_speed_mm_s", s.plunge_speed_mm_s);
  visit("setting", "dwell_s", s.dwell_s);
  visit("setting", "chord_error_mm", s.chord_error_mm);
  visit("setting", "max_spacing_mm", s.max_spacing_mm);
  visit("setting", "acceleration_mm_s2", s.acceleration_mm_s2);
  visit("setting", "jerk_mm_s3", s.jerk_mm_s3);
  visit("setting", "tool_x_hint_x", s.tool_x_hint.x());
  visit("setting", "tool_x_hint_y", s.tool_x_hint.y());
  visit("setting", "tool_x_hint_z", s.tool_x_hint.z());
  visit("setting", "near_1_rad", r.setup.near_rad[0]);
  visit("setting", "near_2_rad", r.setup.near_rad[1]);
  visit("setting", "near_3_rad", r.setup.near_rad[2]);
  visit("setting", "near_4_rad", r.setup.near_rad[3]);
  visit("setting", "near_5_rad", r.setup.near_rad[4]);
  visit("setting", "near_6_rad", r.setup.near_rad[5]);
  visit("setting", "table_z_mm", r.setup.table_z_mm);
  visit("setting", "period_s", r.setup.period_s);
  auto& l = r.limits;
  visit("setting", "must_be_ring", l.must_be_ring);
  visit("setting", "planned_depth_mm", l.planned_depth_mm);
  visit("setting", "needle_length_mm", l.needle_length_mm);
  visit("setting", "needle_radius_mm", l.needle_radius_mm);
  visit("setting", "shaft_radius_mm", l.shaft_radius_mm);
  visit("limit", "min_speed_mm_s", l.min_speed_mm_s);
  visit("limit", "max_speed_mm_s", l.max_speed_mm_s);
  visit("limit", "depth_tolerance_mm", l.depth_tolerance_mm);
  visit("limit", "close_margin_mm", l.close_margin_mm);
  visit("limit", "max_gap_ratio", l.max_gap_ratio);
  visit("limit", "max_gap_mm", l.max_gap_mm);
  visit("limit", "max_edge_height_mm", l.max_edge_height_mm);
  visit("limit", "max_tilt_deg", l.max_tilt_deg);
  visit("limit", "tool_table_clearance_mm", l.tool_table_clearance_mm);
  visit("limit", "max_deviation_mm", l.max_deviation_mm);
  visit("limit", "mark_distance_mm", l.mark_distance_mm);
  visit("limit", "mark_depth_mm", l.mark_depth_mm);
  visit("limit", "mark_depth_tolerance_mm", l.mark_depth_tolerance_mm);
  visit("limit", "mark_speed_mm_s", l.mark_speed_mm_s);
  visit("limit", "mark_speed_tolerance", l.mark_speed_tolerance);
  visit("limit", "min_singular_value", l.min_singular_value);
  visit("limit", "joint_margin_deg", l.joint_margin_deg);
  visit("limit", "joint_speed_share", l.joint_speed_share);
  visit("limit", "max_joint_acceleration_rad_s2", l.max_joint_acceleration_rad_s2);
  visit("limit", "table_clearance_mm", l.table_clearance_mm);
  visit("limit", "arm_clearance_mm", l.arm_clearance_mm);
  visit("limit", "surface_clearance_mm", l.surface_clearance_mm);
  visit("limit", "tip_speed_tolerance", l.tip_speed_tolerance);
  visit("limit", "max_chord_error_mm", l.max_chord_error_mm);
  visit("limit", "shaft_clearance_mm", l.shaft_clearance_mm);
  visit("limit", "needle_clearance_mm", l.needle_clearance_mm);
  visit("limit", "min_power_w", l.min_power_w);
  visit("limit", "max_power_w", l.max_power_w);
  visit("limit", "min_scale", l.min_scale);
  visit("limit", "max_scale", l.max_scale);
  visit("limit", "max_rmse_mm", l.max_rmse_mm);
  visit("limit", "min_inlier_fraction", l.min_inlier_fraction);
}

/// Returns the header's line on a check: "margin passed: 5.03 mm >= 2.2 mm".
[[nodiscard]] std::string held_against_its_limit(const ProgramCheck& check);

}  // namespace incise::robot_detail
