#include "robot/tip_route.hpp"

#include <algorithm>
#include <cmath>

namespace incise::robot_detail {
namespace {

constexpr double kTrapezoidJerk = 1e9;        // mm/s³: nearly the controller's trapezoid
constexpr double kStraightRad = 1e-9;         // a turn that needs no circle
constexpr double kOverlapToleranceMm = 1e-5;  // the script's last digit
constexpr double kSamePlaceMm = 1e-9;

}  // namespace

Eigen::Quaterniond turn_of(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

TipRoute::TipRoute(const Vec3& start_mm, const Mat3& R_start, std::span<const ScriptCommand> commands, double slider) {
  knots_.push_back({0.0, Eigen::Quaterniond(R_start)});
  Vec3 here = start_mm;
  double trimmed = 0.0;  // length that the previous blend takes from this move
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const ScriptCommand& command = commands[i];
    const Vec3 corner_from = i == 0 ? start_mm : commands[i - 1].tip_mm;
    const Vec3 way = command.tip_mm - corner_from;
    const double length = way.norm();
    const bool is_last = i + 1 == commands.size();
    const double blend = is_last ? 0.0 : command.blend_mm;
    if (trimmed + blend > length + kOverlapToleranceMm) {
      overlap_command_ = static_cast<int>(i);
      overlap_line_ = command.line;
      return;
    }
    const double speed = slider * command.speed;
    if (length > kSamePlaceMm) add(here, way / length, std::max(0.0, length - trimmed - blend), speed);
    if (blend > 0.0 && length > kSamePlaceMm) {
      const Vec3 in = way / length;
      const Vec3 out = (commands[i + 1].tip_mm - command.tip_mm).normalized();
      const double theta = std::atan2(in.cross(out).norm(), in.dot(out));
      const Vec3 begin = command.tip_mm - blend * in;
      if (theta < kStraightRad) {
        add(begin, in, 2.0 * blend, speed);
      } else {
        const double radius = blend / std::tan(0.5 * theta);
        add(begin, in, radius * theta, speed, (out - in.dot(out) * in).normalized(), radius);
      }
      knots_.push_back({length_mm_ - 0.5 * (length_mm_ - pieces_.back().begin_mm), turn_of(command.rotation_vector)});
      here = command.tip_mm + blend * out;
    } else {
      knots_.push_back({length_mm_, turn_of(command.rotation_vector)});
      here = command.tip_mm;
    }
    trimmed = blend;
  }
  if (length_mm_ > 0.0) law_ = SpeedLaw(speeds_, slider * slider * commands.front().acceleration, kTrapezoidJerk);
}

void TipRoute::add(const Vec3& from, const Vec3& along, double length_mm, double speed_mm_s, const Vec3& inwards,
                   double radius_mm) {
  pieces_.push_back({length_mm_, from, along, inwards, radius_mm});
  if (!speeds_.empty() && speeds_.back().speed_mm_s == speed_mm_s)
    speeds_.back().length_mm += length_mm;
  else
    speeds_.push_back({length_mm, speed_mm_s});
  length_mm_ += length_mm;
}

Mat4 TipRoute::at(double time_s, std::size_t& command) const {
  const double arc = law_.arc_mm(time_s);
  Mat4 T = Mat4::Identity();
  const auto knot = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, arc,
                                     [](double place, const Knot& k) { return place < k.arc_mm; });
  const Knot &a = *(knot - 1), &b = *knot;
  command = static_cast<std::size_t>(knot - knots_.begin()) - 1;
  const double share = b.arc_mm > a.arc_mm ? std::clamp((arc - a.arc_mm) / (b.arc_mm - a.arc_mm), 0.0, 1.0) : 1.0;
  T.topLeftCorner<3, 3>() = a.turn.slerp(share, b.turn).toRotationMatrix();
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), arc,
                                      [](double place, const Piece& p) { return place < p.begin_mm; });
  const Piece& piece = *(after - 1);
  const double s = arc - piece.begin_mm;
  if (piece.radius_mm > 0.0) {
    const double angle = s / piece.radius_mm;
    const double half = std::sin(0.5 * angle);  // 1 - cos without loss of digits
    T.topRightCorner<3, 1>() =
        piece.from + piece.radius_mm * (std::sin(angle) * piece.along + 2.0 * half * half * piece.inwards);
  } else {
    T.topRightCorner<3, 1>() = piece.from + s * piece.along;
  }
  return T;
}

}  // namespace incise::robot_detail
