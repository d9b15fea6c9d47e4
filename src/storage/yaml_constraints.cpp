#include "yaml_reader.hpp"

#include <fmt/format.h>

#include <cmath>

namespace incise {

YAML::Node YamlReader::required(const YAML::Node& map, const char* key, const std::string& field, const char* expected) const {
  const YAML::Node node = map[key];
  if (!node.IsDefined()) refuse(map, field, fmt::format("no `{}`", key), expected);
  return node;
}

Region YamlReader::read_region(const YAML::Node& node, const std::string& field) const {
  require_map(node, field);
  if (node.size() == 0) refuse(node, field, "an empty group", "box_mm, sphere, end, plane, point_array or cell_array");
  refuse_unknown_keys(node, field, {"box_mm", "sphere", "end", "plane", "point_array", "cell_array"});
  if (node.size() != 1) {
    refuse(node, field, fmt::format("{} regions", node.size()), "one of box_mm, sphere, end, plane, point_array, cell_array");
  }
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
  if (const YAML::Node plane = node["plane"]; plane.IsDefined()) return read_plane_region(plane, field + ".plane");
  if (const YAML::Node cells = node["cell_array"]; cells.IsDefined()) {
    const auto [name, value] = read_name_and_value(cells, field + ".cell_array");
    return CellArrayRegion{name, value};
  }
  const auto [name, value] = read_name_and_value(node["point_array"], field + ".point_array");
  return PointArrayRegion{name, value};
}

PlaneRegion YamlReader::read_plane_region(const YAML::Node& node, const std::string& field) const {
  require_map(node, field);
  refuse_unknown_keys(node, field, {"point_mm", "normal", "within_mm"});
  PlaneRegion region;
  read_numbers(required(node, "point_mm", field, "point_mm and normal"), field + ".point_mm", {region.point_mm.data(), 3}, kAny);
  region.normal = read_direction(required(node, "normal", field, "point_mm and normal"), field + ".normal");
  if (const YAML::Node within = node["within_mm"]; within.IsDefined()) {
    region.within_mm = read_number(within, field + ".within_mm", kNotNegative);
  }
  return region;
}

std::pair<std::string, double> YamlReader::read_name_and_value(const YAML::Node& node, const std::string& field) const {
  const std::string text = node.IsScalar() ? node.Scalar() : std::string();
  const std::size_t equals = text.find('=');
  double value = 0.0;
  if (equals == std::string::npos || equals == 0 || !YAML::convert<double>::decode(YAML::Node(text.substr(equals + 1)), value) ||
      !std::isfinite(value)) {
    refuse(node, field, "'" + text + "'", "NAME=VALUE, such as clamp=1");
  }
  return {text.substr(0, equals), value};
}

SupportConstraint YamlReader::read_support(const YAML::Node& node, const std::string& field) const {
  refuse_unknown_keys(node, field, {"kind", "plane", "surface"});
  SupportConstraint constraint;
  if (const YAML::Node surface = node["surface"]; surface.IsDefined()) {
    if (node["plane"].IsDefined()) refuse(node, field, "a plane and a surface", "only one of plane and surface");
    if (!surface.IsScalar() || surface.Scalar().empty()) {
      refuse(surface, field + ".surface", "no name", "a file with triangles: .stl, .ply, .obj or .vtp");
    }
    constraint.holder = std::make_shared<HolderSurface>(HolderSurface{surface.Scalar(), {}});  // read_case fills it
    return constraint;
  }
  const YAML::Node plane = required(node, "plane", field, "plane: {point_mm, normal}, or surface: FILE");
  require_map(plane, field + ".plane");
  refuse_unknown_keys(plane, field + ".plane", {"point_mm", "normal"});
  read_numbers(required(plane, "point_mm", field + ".plane", "point_mm and normal"), field + ".plane.point_mm",
               {constraint.point_mm.data(), 3}, kAny);
  constraint.normal = read_direction(required(plane, "normal", field + ".plane", "point_mm and normal"), field + ".plane.normal");
  return constraint;
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
  if (kind == "support") return read_support(node, field);
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
