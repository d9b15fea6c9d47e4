#include <incise/core/expect.hpp>
#include <incise/cutting/tool.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

constexpr double kAlongAxis = 1e-9;  // component perpendicular to the axis below which a direction lies along it

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

/// Describes a dimension of the tool.
/// @param value  null: the tool has no such dimension.
/// @throws as Visitor::refuse if a file gives such a dimension.
void dimension(Visitor& v, std::string_view tool, const Field& field, double* value, const Range& range) {
  if (value != nullptr) return v(field, *value, range);
  std::optional<double> none;
  v(field, none, range);
  if (none) v.refuse(field, "a dimension of another tool", fmt::format("no such key for tool.kind: {}", tool));
}

void dimensions(Visitor& v, std::string_view tool, double* diameter_mm, double* length_mm, double* thickness_mm,
                double* width_mm) {
  dimension(v, tool, {"diameter_mm", "Diameter of a needle or ball.", "mm"}, diameter_mm, {0.05, 10.0});
  dimension(v, tool, {"length_mm", "Length of a needle or blade, from its tip.", "mm"}, length_mm, {0.0, 200.0, true});
  dimension(v, tool, {"thickness_mm", "Thickness of a blade; 0.5 unless given.", "mm"}, thickness_mm, {0.05, 10.0});
  dimension(v, tool, {"width_mm", "Width of a blade, in the direction of travel; 2.4 unless given.", "mm"}, width_mm,
            {0.05, 50.0});
}

void describe_dimensions(Visitor& v, Needle& t) {
  dimensions(v, "needle", &t.diameter_mm, &t.length_mm, nullptr, nullptr);
}
void describe_dimensions(Visitor& v, Blade& t) {
  dimensions(v, "blade", nullptr, &t.length_mm, &t.thickness_mm, &t.width_mm);
}
void describe_dimensions(Visitor& v, Ball& t) {
  dimensions(v, "ball", &t.diameter_mm, nullptr, nullptr, nullptr);
}

}  // namespace

void describe(Visitor& v, Tool& tool) {
  v.kind({"kind", "A needle, a blade that moves edge first, or a ball."}, tool);
  std::visit([&v](auto& t) { describe_dimensions(v, t); }, tool);
}

std::string_view kind_of(const Tool& tool) {
  return kToolNames[tool.index()];
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

std::vector<Problem> validate(const Tool& tool) {
  std::vector<Problem> violations;
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
