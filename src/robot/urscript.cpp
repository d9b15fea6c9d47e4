#include "robot/program_digest.hpp"
#include "robot/text_form.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

bool is_identifier(const std::string& name) {
  const std::string letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
  return !name.empty() && letters.find(name[0]) != std::string::npos &&
         name.find_first_not_of(letters + "0123456789") == std::string::npos;
}

/// p[x, y, z, rx, ry, rz] in m and rad; 10 nm and 0.1 µrad are far below what an arm resolves.
std::string pose_text(const Vec3& position_mm, const Vec3& rotation_vector) {
  const Vec3 p = position_mm / units::kMmPerM;
  return fmt::format("p[{:.8f}, {:.8f}, {:.8f}, {:.7f}, {:.7f}, {:.7f}]", p.x(), p.y(), p.z(), rotation_vector.x(),
                     rotation_vector.y(), rotation_vector.z());
}

std::string joints_text(const Joints& q) {
  return fmt::format("[{:.8f}, {:.8f}, {:.8f}, {:.8f}, {:.8f}, {:.8f}]", q[0], q[1], q[2], q[3], q[4], q[5]);
}

std::string tcp_line(const Mat4& T_flange_tool) {
  const Eigen::AngleAxisd turn(Mat3(T_flange_tool.topLeftCorner<3, 3>()));
  return fmt::format("  set_tcp({})\n", pose_text(T_flange_tool.topRightCorner<3, 1>(), turn.angle() * turn.axis()));
}

/// Blend radius at pose i, m; 0 where the course stops.
double blend_m(const RobotProgram& program, std::size_t i, double fraction) {
  if (i + 1 >= program.poses.size() || !is_cut(program.poses[i + 1].phase)) return 0.0;
  const double before = (program.poses[i].tip_mm - program.poses[i - 1].tip_mm).norm();
  const double after = (program.poses[i + 1].tip_mm - program.poses[i].tip_mm).norm();
  return units::m_from_mm(fraction * std::min(before, after));
}

std::string moves(const RobotProgram& program, const UrScriptSettings& settings) {
  std::string text;
  const double a = units::m_from_mm(program.settings.acceleration_mm_s2);
  for (std::size_t i = 1; i < program.poses.size(); ++i) {
    const ProgramPose& pose = program.poses[i];
    if (i == 1 || pose.phase != program.poses[i - 1].phase)
      text += fmt::format("  # phase: {}\n", to_string(pose.phase));
    const std::string place = pose_text(pose.tip_mm, pose.rotation_vector);
    const double v = units::m_from_mm(pose.tip_speed_mm_s);
    if (pose.phase == ProgramPhase::Dwell) {
      text += fmt::format("  sleep({:.3f})\n", pose.time_s - program.poses[i - 1].time_s);
    } else if (is_cut(pose.phase)) {
      text += fmt::format("  movep({}, a={:.4f}, v={:.6f}, r={:.6f})\n", place, a, v,
                          blend_m(program, i, settings.blend_fraction));
    } else {
      text += fmt::format("  movel({}, a={:.4f}, v={:.6f})\n", place, a, v);
    }
  }
  return text;
}

std::string stream(const RobotProgram& program, const UrScriptSettings& settings) {
  std::string text;
  const JointMotion& motion = program.motion;
  const std::string rest = fmt::format("t={:.4f}, lookahead_time={:.3f}, gain={:.0f})\n", motion.period_s,
                                       settings.lookahead_s, settings.gain);
  const auto settle = static_cast<int>(std::ceil(settings.settle_s / motion.period_s));
  std::optional<ProgramPhase> phase;
  for (std::size_t i = 0; i < motion.samples.size(); ++i) {
    const JointSample& sample = motion.samples[i];
    const ProgramPhase now = program.poses[std::min(sample.pose + 1, program.poses.size() - 1)].phase;
    const std::string line = fmt::format("  servoj({}, 0, 0, {}", joints_text(sample.q_rad), rest);
    if (phase && now != *phase && !(now == ProgramPhase::Overlap && *phase == ProgramPhase::Cut)) {
      // The motion has come to rest here. The arm trails the stream, so it needs time to arrive.
      for (int k = 0; k < settle; ++k) text += line;
    }
    if (!phase || now != *phase) text += fmt::format("  # phase: {}\n", to_string(now));
    phase = now;
    text += line;
    if (i + 1 == motion.samples.size()) {
      for (int k = 0; k < settle; ++k) text += line;
    }
  }
  return text + "  stopj(2.0)\n";
}

}  // namespace

std::vector<Problem> validate(const UrScriptSettings& s) {
  std::vector<Problem> broken = problems_of(s);
  if (!is_identifier(s.function_name))
    broken.push_back({"function_name", "'" + s.function_name + "'", "letters, digits and _, not a digit first"});
  return broken;
}

std::string to_urscript(const RobotProgram& program, const ProgramHeader& header, const UrScriptSettings& settings) {
  robot_detail::require_motion(program);
  require_none(validate(settings));
  std::string text = robot_detail::header_lines(header);
  text +=
      "# Units: m, s, rad, m/s, m/s^2. Poses p[x, y, z, rx, ry, rz] of the tool's tip in the base frame, rotation as "
      "axis "
      "times angle.\n"
      "# The program does not switch the electrode. Make sure that the way to the start is clear: the arm moves "
      "there in joint space from wherever it is.\n";
  text += fmt::format("def {}():\n", settings.function_name) + tcp_line(program.setup.T_flange_tool);
  text += fmt::format("  movej({}, a={:.4f}, v={:.4f})\n", joints_text(program.motion.samples.front().q_rad),
                      robot_detail::kStartAcceleration, robot_detail::kStartSpeed);
  text += settings.motion == ScriptMotion::MoveP ? moves(program, settings) : stream(program, settings);
  return robot_detail::sealed(text + fmt::format("end\n\n{}()\n", settings.function_name));
}

}  // namespace incise
