#include "field_writers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace incise {
namespace {

nlohmann::ordered_json number_schema(const Range& range, const char* type) {
  nlohmann::ordered_json schema{{"type", type}};
  if (std::isfinite(range.least)) schema[range.is_least_open ? "exclusiveMinimum" : "minimum"] = range.least;
  if (std::isfinite(range.most)) schema[range.is_most_open ? "exclusiveMaximum" : "maximum"] = range.most;
  return schema;
}

nlohmann::ordered_json vector_schema() {
  return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
}

nlohmann::ordered_json direction_schema() {
  return {{"oneOf",
           {vector_schema(), {{"enum", {"anterior", "posterior", "left", "right", "superior", "inferior"}}}}}};
}

nlohmann::ordered_json region_schema() {
  const nlohmann::ordered_json positive{{"type", "number"}, {"exclusiveMinimum", 0}};
  nlohmann::ordered_json properties;
  properties["box_mm"] = {{"type", "array"}, {"items", vector_schema()}, {"minItems", 2}, {"maxItems", 2},
                          {"description", "low and high corner, rest positions, LPS"}};
  properties["sphere"] = {{"type", "object"}, {"properties", {{"center_mm", vector_schema()}, {"radius_mm", positive}}},
                          {"required", {"center_mm", "radius_mm"}}, {"additionalProperties", false}};
  properties["end"] = {{"type", "object"}, {"properties", {{"direction", direction_schema()}, {"within_mm", positive}}},
                       {"required", {"direction", "within_mm"}}, {"additionalProperties", false},
                       {"description", "vertices at most within_mm from the body's extreme point along direction"}};
  properties["plane"] = {{"type", "object"},
                         {"properties", {{"point_mm", vector_schema()}, {"normal", direction_schema()},
                                         {"within_mm", {{"type", "number"}, {"minimum", 0}}}}},
                         {"required", {"point_mm", "normal"}}, {"additionalProperties", false},
                         {"description", "vertices on the plane or on its normal's side; with within_mm: at most that far from "
                                         "the plane, on either side"}};
  properties["cell_array"] = {{"type", "string"}, {"description", "NAME=VALUE of a cell array of the mesh: the corners of those tets"}};
  properties["point_array"] = {{"type", "string"}, {"description", "NAME=VALUE of a point array of the mesh"}};
  return {{"type", "object"}, {"properties", properties}, {"minProperties", 1}, {"maxProperties", 1},
          {"additionalProperties", false}};
}

nlohmann::ordered_json constraint_schema(const char* kind, nlohmann::ordered_json properties, std::vector<std::string> required) {
  nlohmann::ordered_json all{{"kind", {{"const", kind}}}};
  all.update(properties);
  required.insert(required.begin(), "kind");
  return {{"type", "object"}, {"properties", all}, {"required", required}, {"additionalProperties", false}};
}

}  // namespace

SchemaWriter::SchemaWriter() { levels_.emplace_back(nlohmann::ordered_json::object()); }

void SchemaWriter::add(const FieldInfo& info, nlohmann::ordered_json schema) {
  schema["description"] = info.meaning;
  if (*info.unit != '\0') schema["x-unit"] = info.unit;
  levels_.back()[info.name] = std::move(schema);
}

void SchemaWriter::begin_group(const FieldInfo& info) {
  groups_.push_back(info);
  levels_.emplace_back(nlohmann::ordered_json::object());
}

void SchemaWriter::end_group() {
  nlohmann::ordered_json properties = std::move(levels_.back());
  levels_.pop_back();
  add(groups_.back(), {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}});
  groups_.pop_back();
}

void SchemaWriter::number(const FieldInfo& info, double& value, const Range& range) {
  nlohmann::ordered_json schema = number_schema(range, "number");
  schema["default"] = value;
  add(info, std::move(schema));
}

void SchemaWriter::optional_number(const FieldInfo& info, std::optional<double>& value, const Range& range) {
  nlohmann::ordered_json schema = number_schema(range, "number");
  if (value) schema["default"] = *value;
  add(info, std::move(schema));
}

void SchemaWriter::integer(const FieldInfo& info, int& value, const Range& range) {
  nlohmann::ordered_json schema = number_schema(range, "integer");
  schema["default"] = value;
  add(info, std::move(schema));
}

void SchemaWriter::flag(const FieldInfo& info, bool& value) { add(info, {{"type", "boolean"}, {"default", value}}); }

void SchemaWriter::table(const FieldInfo& info, std::span<const Column> columns, std::vector<Row>&) {
  nlohmann::ordered_json properties = nlohmann::ordered_json::object();
  std::vector<std::string> required;
  for (const Column& column : columns) {
    nlohmann::ordered_json schema = number_schema(column.range, column.is_whole ? "integer" : "number");
    schema["description"] = column.info.meaning;
    if (*column.info.unit != '\0') schema["x-unit"] = column.info.unit;
    properties[column.info.name] = std::move(schema);
    if (column.is_required) required.emplace_back(column.info.name);
  }
  add(info, {{"type", "array"},
             {"items", {{"type", "object"}, {"properties", std::move(properties)}, {"required", required},
                        {"additionalProperties", false}}}});
}

void SchemaWriter::text(const FieldInfo& info, std::string& value) { add(info, {{"type", "string"}, {"default", value}}); }

void SchemaWriter::path(const FieldInfo& info, std::filesystem::path&) { add(info, {{"type", "string"}}); }

void SchemaWriter::choice(const FieldInfo& info, std::size_t& value, Names names) {
  add(info, {{"enum", std::vector<std::string>(names.begin(), names.end())}, {"default", names[value]}});
}

void SchemaWriter::numbers(const FieldInfo& info, std::span<double> values, bool& is_given, const Range& range) {
  const nlohmann::ordered_json item = number_schema(range, "number");
  nlohmann::ordered_json schema{{"type", "array"}};
  if (values.size() == 6 || values.size() == 16) {  // a box as two corners, a transform as four rows
    const std::size_t row = values.size() == 6 ? 3 : 4;
    schema["items"] = {{"type", "array"}, {"items", item}, {"minItems", row}, {"maxItems", row}};
    schema["minItems"] = schema["maxItems"] = values.size() / row;
  } else {
    schema["items"] = item;
    schema["minItems"] = schema["maxItems"] = values.size();
  }
  if (is_given) schema["default"] = std::vector<double>(values.begin(), values.end());
  add(info, std::move(schema));
}

void SchemaWriter::direction(const FieldInfo& info, Vec3& value) {
  nlohmann::ordered_json schema = direction_schema();
  schema["default"] = {value.x(), value.y(), value.z()};
  add(info, std::move(schema));
}

void SchemaWriter::constraints(const FieldInfo& info, std::optional<std::vector<Constraint>>&) {
  nlohmann::ordered_json kinds = nlohmann::ordered_json::array();
  kinds.push_back(constraint_schema("fixed", {{"where", region_schema()}, {"axes", {{"type", "string"}, {"pattern", "^[xyz]+$"},
                                    {"default", "xyz"}}}}, {"where"}));
  kinds.push_back(constraint_schema("displaced", {{"where", region_schema()}, {"displacement_mm", vector_schema()}},
                                    {"where", "displacement_mm"}));
  nlohmann::ordered_json holder = constraint_schema(
      "support", {{"surface", {{"type", "string"}, {"description", "triangles of a holder, normals towards the tissue (mm, LPS)"}}}},
      {"surface"});
  kinds.push_back(std::move(holder));
  kinds.push_back(constraint_schema("support",
                                    {{"plane", {{"type", "object"}, {"properties", {{"point_mm", vector_schema()},
                                     {"normal", direction_schema()}}}, {"required", {"point_mm", "normal"}},
                                     {"additionalProperties", false}}}}, {"plane"}));
  kinds.push_back(constraint_schema("traction", {{"where", region_schema()}, {"traction_kpa", vector_schema()}},
                                    {"where", "traction_kpa"}));
  add(info, {{"type", "array"}, {"minItems", 1}, {"items", {{"oneOf", kinds}}}});
}

void SettingLister::add(const FieldInfo& info, std::string value) {
  lines_.push_back({fmt::format("{}", fmt::join(groups_, ".")), info.name, std::move(value), info.unit, info.meaning, false});
}

void SettingLister::begin_group(const FieldInfo& info) {
  lines_.push_back({fmt::format("{}", fmt::join(groups_, ".")), info.name, "", info.unit, info.meaning, true});
  groups_.emplace_back(info.name);
}

void SettingLister::end_group() { groups_.pop_back(); }

void SettingLister::number(const FieldInfo& info, double& value, const Range&) { add(info, fmt::format("{}", value)); }

void SettingLister::optional_number(const FieldInfo& info, std::optional<double>& value, const Range&) {
  add(info, value ? fmt::format("{}", *value) : std::string());
}

void SettingLister::integer(const FieldInfo& info, int& value, const Range&) { add(info, fmt::format("{}", value)); }

void SettingLister::flag(const FieldInfo& info, bool& value) { add(info, value ? "true" : "false"); }

void SettingLister::table(const FieldInfo& info, std::span<const Column> columns, std::vector<Row>& rows) {
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (row[c]) cells.push_back(fmt::format("{}: {}", columns[c].info.name, *row[c]));
    }
    lines.push_back(fmt::format("{{{}}}", fmt::join(cells, ", ")));
  }
  add(info, rows.empty() ? std::string() : fmt::format("[{}]", fmt::join(lines, ", ")));
}

void SettingLister::text(const FieldInfo& info, std::string& value) { add(info, value); }

void SettingLister::path(const FieldInfo& info, std::filesystem::path& value) { add(info, value.generic_string()); }

void SettingLister::choice(const FieldInfo& info, std::size_t& value, Names names) {
  add(info, std::string(names[value]));
}

void SettingLister::numbers(const FieldInfo& info, std::span<double> values, bool& is_given, const Range&) {
  add(info, is_given ? fmt::format("[{}]", fmt::join(values, ", ")) : std::string());
}

void SettingLister::direction(const FieldInfo& info, Vec3& value) {
  add(info, fmt::format("[{}, {}, {}]", value.x(), value.y(), value.z()));
}

namespace {

std::string shown(const Region& region) {
  struct Show {
    std::string operator()(const BoxRegion& r) const {
      const Vec3& a = r.box_mm.min();
      const Vec3& b = r.box_mm.max();
      return fmt::format("{{box_mm: [[{}, {}, {}], [{}, {}, {}]]}}", a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    }
    std::string operator()(const SphereRegion& r) const {
      return fmt::format("{{sphere: {{center_mm: [{}, {}, {}], radius_mm: {}}}}}", r.center_mm.x(), r.center_mm.y(),
                         r.center_mm.z(), r.radius_mm);
    }
    std::string operator()(const EndRegion& r) const {
      return fmt::format("{{end: {{direction: [{}, {}, {}], within_mm: {}}}}}", r.direction.x(), r.direction.y(),
                         r.direction.z(), r.within_mm);
    }
    std::string operator()(const PlaneRegion& r) const {
      return fmt::format("{{plane: {{point_mm: [{}, {}, {}], normal: [{}, {}, {}]{}}}}}", r.point_mm.x(), r.point_mm.y(),
                         r.point_mm.z(), r.normal.x(), r.normal.y(), r.normal.z(),
                         r.within_mm ? fmt::format(", within_mm: {}", *r.within_mm) : std::string());
    }
    std::string operator()(const PointArrayRegion& r) const { return fmt::format("{{point_array: {}={}}}", r.name, r.value); }
    std::string operator()(const CellArrayRegion& r) const { return fmt::format("{{cell_array: {}={}}}", r.name, r.value); }
  };
  return std::visit(Show{}, region);
}

std::string shown(const Constraint& constraint) {
  struct Show {
    std::string operator()(const FixedConstraint& c) const {
      return fmt::format("{{kind: fixed, where: {}, axes: {}{}{}}}", shown(c.where), c.axes[0] ? "x" : "", c.axes[1] ? "y" : "",
                         c.axes[2] ? "z" : "");
    }
    std::string operator()(const DisplacedConstraint& c) const {
      return fmt::format("{{kind: displaced, where: {}, displacement_mm: [{}, {}, {}]}}", shown(c.where), c.displacement_mm.x(),
                         c.displacement_mm.y(), c.displacement_mm.z());
    }
    std::string operator()(const SupportConstraint& c) const {
      if (c.holder) return fmt::format("{{kind: support, surface: \"{}\"}}", c.holder->name);
      return fmt::format("{{kind: support, plane: {{point_mm: [{}, {}, {}], normal: [{}, {}, {}]}}}}", c.point_mm.x(),
                         c.point_mm.y(), c.point_mm.z(), c.normal.x(), c.normal.y(), c.normal.z());
    }
    std::string operator()(const TractionConstraint& c) const {
      return fmt::format("{{kind: traction, where: {}, traction_kpa: [{}, {}, {}]}}", shown(c.where), c.traction_kpa.x(),
                         c.traction_kpa.y(), c.traction_kpa.z());
    }
  };
  return std::visit(Show{}, constraint);
}

}  // namespace

void SettingLister::constraints(const FieldInfo& info, std::optional<std::vector<Constraint>>& value) {
  std::vector<std::string> lines;
  if (value) {
    for (const Constraint& constraint : *value) lines.push_back(shown(constraint));
  }
  add(info, value ? fmt::format("[{}]", fmt::join(lines, ", ")) : std::string());
}

}  // namespace incise
