#include <incise/virtual_bench/course.hpp>

namespace incise {

std::vector<TipPose> tip_course(const std::vector<TipPose>& asked, const Specimen& specimen,
                                const Mat4& T_specimen_robot) {
  const ArmErrors errors{specimen.seed,
                         {specimen.robot_offset_x_mm, specimen.robot_offset_y_mm, specimen.robot_offset_z_mm},
                         specimen.robot_turn_deg,
                         specimen.robot_wander_mm};
  return tip_course(asked, errors, T_specimen_robot);
}

std::optional<std::string> find_misfit(const BenchBody& body, const std::vector<TipPose>& course) {
  return find_misfit(skin_at(body, body.stretched.positions), tumor_edge_at(body, body.stretched.positions),
                     body.approach, course);
}

}  // namespace incise
