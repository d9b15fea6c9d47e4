#include "yaml_reader.hpp"

#include <fmt/format.h>

namespace incise {

YAML::Node YamlReader::required(const YAML::Node& map, const char* key, const std::string& field, const char* expected) const {
  const YAML::Node node = map[key];
  if (!node.IsDefined()) refuse(map, field, fmt::format("no `{}`", key), expected);
  return node;
}

Region YamlReader::read_region(const YAML::Node& node, const std::string& field) const {
  require_map(node, field);
  if (node.size() == 0) refuse(node, field, "an empty group", "box_mm, sphere, end or point_array");
  refuse_unknown_keys(node, field, {"box_mm", "sphere", "end", "point_array"});
  if (node.size() != 1) refuse(node, field, fmt::format("{} regions", node.size()), "one of box_mm, sphere, end, point_array");
  if (const YAML::Node box = node["box_mm"]; box.IsDefined()) {
    std::array<double, 6> v{};
    read_numbers(box, field + ".box_mm", v, kAny);
    const Box3 region(Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5]));
    if (region.isEmpty()) refuse(box, field + ".box_mm", "a low corner above the high corner", "[[low x, y, z], [high x, y, z]]");
    return BoxRegion{region};
  }
  if (const YAML::Node sphere = node["sphere"]; sphere.IsDefined()) {
    require_map(sphere, field + ".sphere");
    refuse_unknown_keys(sphere, field + ".sphere", {"center_mm", "radius_mm"});
    SphereRegion region;
    read_numbers(required(sphere, "center_mm", field + ".sphere", "center_mm and radius_mm"), field + ".sphere.center_mm",
                 {region.center_mm.data(), 3}, kAny);
    region.radius_mm = read_number(required(sphere, "radius_mm", field + ".sphere", "center_mm and radius_mm"),
                                   field + ".sphere.radius_mm", kPositive);
    return region;
  }
  if (const YAML::Node end = node["end"]; end.IsDefined()) {
    require_map(end, field + ".end");
    refuse_unknown_keys(end, field + ".end", {"direction", "within_mm"});
    EndRegion region;
    region.direction = read_direction(required(end, "direction", field + ".end", "direction and within_mm"), field + ".end.direction");
    region.within_mm = read_number(required(end, "within_mm", field + ".end", "direction and within_mm"),
                                   field + ".end.within_mm", kPositive);
    return region;
  }
  const YAML::Node array = node["point_array"];
  const std::string text = array.IsScalar() ? array.Scalar() : std::string();
  const std::size_t equals = text.find('=');
  double value = 0.0;
  if (equals == std::string::npos || equals == 0 || !YAML::convert<double>::decode(YAML::Node(text.substr(equals + 1)), value)) {
    refuse(array, field + ".point_array", "'" + text + "'", "NAME=VALUE, such as clamp=1");
  }
  return PointArrayRegion{text.substr(0, equals), value};
}

Constraint YamlReader::read_constraint(const YAML::Node& node, const std::string& field) const {
  static const std::vector<std::string> kKinds{"fixed", "displaced", "support", "traction"};
  require_map(node, field);
  const YAML::Node kind_node = required(node, "kind", field, "kind: fixed, displaced, support or traction");
  const std::string kind = kind_node.IsScalar() ? kind_node.Scalar() : std::string();
  if (kind == "fixed") {
    refuse_unknown_keys(node, field, {"kind", "where", "axes"});
    FixedConstraint constraint{read_region(required(node, "where", field, "where it acts"), field + ".where"), {}};
    const YAML::Node axes = node["axes"];
    const std::string letters = axes.IsDefined() && axes.IsScalar() ? axes.Scalar() : (axes.IsDefined() ? "" : "xyz");
    constraint.axes = {false, false, false};
    for (const char letter : letters) {
      if (letter < 'x' || letter > 'z') refuse(axes, field + ".axes", "'" + letters + "'", "some of the letters x, y, z");
      constraint.axes[static_cast<std::size_t>(letter - 'x')] = true;
    }
    if (letters.empty()) refuse(axes, field + ".axes", "nothing", "some of the letters x, y, z");
    return constraint;
  }
  if (kind == "displaced") {
    refuse_unknown_keys(node, field, {"kind", "where", "displacement_mm"});
    DisplacedConstraint constraint{read_region(required(node, "where", field, "where it acts"), field + ".where"), Vec3::Zero()};
    read_numbers(required(node, "displacement_mm", field, "displacement_mm"), field + ".displacement_mm",
                 {constraint.displacement_mm.data(), 3}, kAny);
    return constraint;
  }
  if (kind == "support") {
    refuse_unknown_keys(node, field, {"kind", "plane"});
    const YAML::Node plane = required(node, "plane", field, "plane: {point_mm, normal}");
    require_map(plane, field + ".plane");
    refuse_unknown_keys(plane, field + ".plane", {"point_mm", "normal"});
    SupportConstraint constraint;
    read_numbers(required(plane, "point_mm", field + ".plane", "point_mm and normal"), field + ".plane.point_mm",
                 {constraint.point_mm.data(), 3}, kAny);
    constraint.normal =
        read_direction(required(plane, "normal", field + ".plane", "point_mm and normal"), field + ".plane.normal");
    return constraint;
  }
  if (kind == "traction") {
    refuse_unknown_keys(node, field, {"kind", "where", "traction_kpa"});
    TractionConstraint constraint{read_region(required(node, "where", field, "where it acts"), field + ".where"), Vec3::Zero()};
    read_numbers(required(node, "traction_kpa", field, "traction_kpa"), field + ".traction_kpa",
                 {constraint.traction_kpa.data(), 3}, kAny);
    return constraint;
  }
  refuse(kind_node, field + ".kind", "'" + kind + "'", "one of fixed, displaced, support, traction");
}

void YamlReader::constraints(const FieldInfo& info, std::optional<std::vector<Constraint>>& value) {
  const YAML::Node list = take(info.name);
  if (!list.IsDefined()) return;
  if (!list.IsSequence() || list.size() == 0) {
    refuse(list, field(info.name), list.IsSequence() ? "an empty list" : "no list", "a list of constraints");
  }
  value.emplace();
  for (std::size_t i = 0; i < list.size(); ++i) {
    value->push_back(read_constraint(list[i], fmt::format("{}[{}]", field(info.name), i)));
  }
}

}  // namespace incise
