#include "yaml_reader.hpp"

#include <incise/core/error.hpp>
#include <incise/io/nearest_name.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

std::string shown(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "nothing";
  if (node.IsMap()) return "a group";
  if (node.IsSequence()) return fmt::format("a list of {}", node.size());
  constexpr std::size_t kShown = 60;
  const std::string text = node.Scalar();
  return text.size() <= kShown ? fmt::format("'{}'", text) : fmt::format("'{}…'", text.substr(0, kShown));
}

}  // namespace

std::optional<Vec3> anatomical_direction(const std::string& word) {
  if (word == "left") return Vec3::UnitX();
  if (word == "right") return -Vec3::UnitX();
  if (word == "posterior") return Vec3::UnitY();
  if (word == "anterior") return -Vec3::UnitY();
  if (word == "superior") return Vec3::UnitZ();
  if (word == "inferior") return -Vec3::UnitZ();
  return std::nullopt;
}

YamlReader::YamlReader(const YAML::Node& root, std::string name) : name_(std::move(name)) {
  require_map(root, "");
  levels_.push_back({root, "", {}});
}

std::string YamlReader::field(const char* name) const {
  const std::string& group = levels_.back().name;
  return group.empty() ? name : fmt::format("{}.{}", group, name);
}

void YamlReader::refuse(const YAML::Node& node, const std::string& field, const std::string& found,
                        const std::string& expected, const std::string& hint) const {
  const YAML::Mark mark = node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
  const std::string where = mark.is_null() ? name_ : fmt::format("{} line {}", name_, mark.line + 1);
  throw CaseError(where, field, found, expected, hint);
}

void YamlReader::require_map(const YAML::Node& node, const std::string& field) const {
  if (!node.IsMap()) refuse(node, field, shown(node), "a group of `key: value` lines");
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) refuse(entry.first, field, "a key that is not a word", "plain keys");
    if (!seen.insert(entry.first.Scalar()).second) {
      refuse(entry.first, field, fmt::format("the key '{}' twice", entry.first.Scalar()), "each key once");
    }
  }
}

void YamlReader::refuse_unknown_keys(const YAML::Node& node, const std::string& field,
                                     const std::vector<std::string>& known) const {
  for (const auto& entry : node) {
    const std::string& key = entry.first.Scalar();
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string place = field.empty() ? key : fmt::format("{}.{}", field, key);
    refuse(entry.first, place, "an unknown key", fmt::format("one of {}", fmt::join(known, ", ")),
           fmt::format("Did you mean '{}'?", nearest_name(key, known)));
  }
}

YAML::Node YamlReader::take(const char* name) {
  Level& level = levels_.back();
  level.known.emplace_back(name);
  if (!level.node.IsDefined() || !level.node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  const YAML::Node& map = level.node;  // const: looking up must not insert
  return map[name];
}

void YamlReader::begin_group(const FieldInfo& info) {
  const YAML::Node node = take(info.name);
  const std::string name = field(info.name);
  if (node.IsDefined()) require_map(node, name);
  levels_.push_back({node, name, {}});
}

void YamlReader::end_group() {
  const Level& level = levels_.back();
  if (level.node.IsDefined() && level.node.IsMap()) refuse_unknown_keys(level.node, level.name, level.known);
  levels_.pop_back();
}

void YamlReader::finish() { refuse_unknown_keys(levels_.front().node, "", levels_.front().known); }

double YamlReader::read_number(const YAML::Node& node, const std::string& field, const Range& range) const {
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) refuse(node, field, shown(node), describe(range));
  if (!contains(range, value)) refuse(node, field, node.Scalar(), describe(range));
  return value;
}

void YamlReader::read_numbers(const YAML::Node& node, const std::string& field, std::span<double> values,
                              const Range& range) const {
  // Nested lists (a box as two corners, a matrix as four rows) are read in order.
  std::vector<YAML::Node> flat;
  if (!node.IsSequence()) refuse(node, field, shown(node), fmt::format("a list of {} numbers", values.size()));
  for (const auto& item : node) {
    if (item.IsSequence()) {
      for (const auto& inner : item) flat.push_back(inner);
    } else {
      flat.push_back(item);
    }
  }
  if (flat.size() != values.size()) {
    refuse(node, field, fmt::format("{} numbers", flat.size()), fmt::format("{} numbers", values.size()));
  }
  for (std::size_t i = 0; i < flat.size(); ++i) values[i] = read_number(flat[i], fmt::format("{}[{}]", field, i), range);
}

void YamlReader::number(const FieldInfo& info, double& value, const Range& range) {
  const YAML::Node node = take(info.name);
  if (node.IsDefined()) value = read_number(node, field(info.name), range);
}

void YamlReader::optional_number(const FieldInfo& info, std::optional<double>& value, const Range& range) {
  const YAML::Node node = take(info.name);
  if (node.IsDefined()) value = read_number(node, field(info.name), range);
}

void YamlReader::integer(const FieldInfo& info, int& value, const Range& range) {
  const YAML::Node node = take(info.name);
  if (!node.IsDefined()) return;
  const double number = read_number(node, field(info.name), range);
  if (number != std::floor(number) || std::abs(number) > 1e9) refuse(node, field(info.name), node.Scalar(), "a whole number");
  value = static_cast<int>(number);
}

void YamlReader::flag(const FieldInfo& info, bool& value) {
  const YAML::Node node = take(info.name);
  if (!node.IsDefined()) return;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) refuse(node, field(info.name), shown(node), "true or false");
}

void YamlReader::text(const FieldInfo& info, std::string& value) {
  const YAML::Node node = take(info.name);
  if (!node.IsDefined()) return;
  if (!node.IsScalar()) refuse(node, field(info.name), shown(node), "a text");
  value = node.Scalar();
}

void YamlReader::path(const FieldInfo& info, std::filesystem::path& value) {
  std::string name = value.string();
  text(info, name);
  value = name;
}

void YamlReader::choice(const FieldInfo& info, std::size_t& value, Names names) {
  const YAML::Node node = take(info.name);
  if (!node.IsDefined()) return;
  const auto found = std::find_if(names.begin(), names.end(),
                                  [&](std::string_view name) { return node.IsScalar() && node.Scalar() == name; });
  if (found == names.end()) {
    const std::vector<std::string> valid(names.begin(), names.end());
    const std::string hint =
        node.IsScalar() ? fmt::format("Did you mean '{}'?", nearest_name(node.Scalar(), valid)) : std::string();
    refuse(node, field(info.name), shown(node), fmt::format("one of {}", fmt::join(valid, ", ")), hint);
  }
  value = static_cast<std::size_t>(found - names.begin());
}

void YamlReader::numbers(const FieldInfo& info, std::span<double> values, bool& is_given, const Range& range) {
  const YAML::Node node = take(info.name);
  if (!node.IsDefined()) return;
  read_numbers(node, field(info.name), values, range);
  is_given = true;
}

void YamlReader::table(const FieldInfo& info, std::span<const Column> columns, std::vector<Row>& rows) {
  const YAML::Node list = take(info.name);
  if (!list.IsDefined()) return;
  if (!list.IsSequence()) refuse(list, field(info.name), shown(list), "a list of groups");
  std::vector<std::string> known;
  for (const Column& column : columns) known.emplace_back(column.info.name);
  rows.clear();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const YAML::Node entry = list[i];
    const std::string place = fmt::format("{}[{}]", field(info.name), i);
    require_map(entry, place);
    refuse_unknown_keys(entry, place, known);
    Row row;
    for (const Column& column : columns) {
      const YAML::Node value = entry[column.info.name];
      const std::string cell = fmt::format("{}.{}", place, column.info.name);
      if (!value.IsDefined()) {
        if (column.is_required) refuse(entry, place, fmt::format("no `{}`", column.info.name), column.info.meaning);
        row.emplace_back();
        continue;
      }
      const double number = read_number(value, cell, column.range);
      if (column.is_whole && number != std::floor(number)) refuse(value, cell, value.Scalar(), "a whole number");
      row.emplace_back(number);
    }
    rows.push_back(std::move(row));
  }
}

Vec3 YamlReader::read_direction(const YAML::Node& node, const std::string& field) const {
  if (node.IsScalar()) {
    if (const auto named = anatomical_direction(node.Scalar())) return *named;
    refuse(node, field, shown(node), "a vector, or one of anterior, posterior, left, right, superior, inferior");
  }
  Vec3 vector = Vec3::Zero();
  read_numbers(node, field, {vector.data(), 3}, kAny);
  if (vector.norm() < 1e-9) refuse(node, field, "a vector of length 0", "a direction");
  return vector.normalized();
}

void YamlReader::direction(const FieldInfo& info, Vec3& value) {
  const YAML::Node node = take(info.name);
  if (node.IsDefined()) value = read_direction(node, field(info.name));
}

}  // namespace incise
