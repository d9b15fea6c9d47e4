#include <incise/core/expect.hpp>
#include <incise/cutting/tool.hpp>

namespace incise {
namespace {

constexpr double kAlongAxis = 1e-9;  // of a unit direction across the axis: below, it lies along the axis

double radius(const Needle& needle) { return needle.radius_mm(); }
double radius(const Blade& blade) { return 0.5 * blade.thickness_mm; }
double radius(const Ball& ball) { return 0.5 * ball.diameter_mm; }

void list_violations(const Needle& needle, const Expect& expect) {
  expect(needle.diameter_mm > 0.0, "diameter_mm", needle.diameter_mm, "a diameter above 0 mm");
  expect(needle.length_mm > 0.0, "length_mm", needle.length_mm, "a length above 0 mm");
}

void list_violations(const Blade& blade, const Expect& expect) {
  expect(blade.thickness_mm > 0.0, "thickness_mm", blade.thickness_mm, "a thickness above 0 mm");
  expect(blade.width_mm > 0.0, "width_mm", blade.width_mm, "a width above 0 mm");
  expect(blade.length_mm > 0.0, "length_mm", blade.length_mm, "a length above 0 mm");
}

void list_violations(const Ball& ball, const Expect& expect) {
  expect(ball.diameter_mm > 0.0, "diameter_mm", ball.diameter_mm, "a diameter above 0 mm");
}

}  // namespace

std::string_view kind_of(const Tool& tool) {
  struct Kind {
    std::string_view operator()(const Needle&) const { return "needle"; }
    std::string_view operator()(const Blade&) const { return "blade"; }
    std::string_view operator()(const Ball&) const { return "ball"; }
  };
  return std::visit(Kind{}, tool);
}

double radius_mm(const Tool& tool) {
  return std::visit([](const auto& t) { return radius(t); }, tool);
}

std::optional<double> length_mm(const Tool& tool) {
  if (const auto* needle = std::get_if<Needle>(&tool)) return needle->length_mm;
  if (const auto* blade = std::get_if<Blade>(&tool)) return blade->length_mm;
  return std::nullopt;
}

double half_width_mm(const Tool& tool) {
  const auto* blade = std::get_if<Blade>(&tool);
  return blade != nullptr ? 0.5 * blade->width_mm : 0.0;
}

std::vector<std::string> validate(const Tool& tool) {
  std::vector<std::string> violations;
  const Expect expect(violations);
  std::visit([&expect](const auto& t) { list_violations(t, expect); }, tool);
  return violations;
}

Vec3 heading_across(const Vec3& direction, const Vec3& axis) {
  const Vec3 across = direction - axis.dot(direction) * axis;
  const double length = across.norm();
  return length > kAlongAxis * direction.norm() ? Vec3(across / length) : Vec3(axis.unitOrthogonal());
}

double turn_rad(const Vec3& from_heading, const Vec3& to_heading, const Vec3& axis) {
  const Vec3 from = heading_across(from_heading, axis);
  const Vec3 to = heading_across(to_heading, axis);
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

ToolPose between(const ToolPose& a, const ToolPose& b, double t) {
  ToolPose pose;
  pose.tip_mm = a.tip_mm + t * (b.tip_mm - a.tip_mm);
  pose.axis = (a.axis + t * (b.axis - a.axis)).normalized();
  const Eigen::AngleAxisd turn(t * turn_rad(a.heading, b.heading, pose.axis), pose.axis);
  pose.heading = turn * heading_across(a.heading, pose.axis);
  return pose;
}

ToolCore::ToolCore(const Tool& tool, const ToolPose& pose) {
  const double length = length_mm(tool).value_or(0.0);
  const Vec3 end = pose.tip_mm - length * pose.axis;
  const double half_width = half_width_mm(tool);
  if (half_width > 0.0) {
    const Vec3 side = half_width * pose.heading;
    corners_ = {pose.tip_mm - side, pose.tip_mm + side, end + side, end - side};
    count_ = 4;
  } else {
    corners_ = {pose.tip_mm, end, end, end};
    count_ = length > 0.0 ? 2 : 1;
  }
}

Mat3 held_directions(const Tool& tool, const ToolPose& pose) {
  if (std::holds_alternative<Ball>(tool)) return Mat3::Identity();
  return Mat3::Identity() - pose.axis * pose.axis.transpose();
}

Eigen::Quaterniond turn_of_held(const Tool& tool, const ToolPose& from, const ToolPose& to) {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (to.axis != from.axis) turn = Eigen::Quaterniond::FromTwoVectors(from.axis, to.axis);
  if (half_width_mm(tool) > 0.0) {
    const double angle = turn_rad(turn * from.heading, to.heading, to.axis);
    turn = Eigen::Quaterniond(Eigen::AngleAxisd(angle, to.axis)) * turn;
  }
  return turn;
}

}  // namespace incise
