#include "yaml_reader.hpp"

#include <incise/core/direction.hpp>
#include <incise/core/error.hpp>
#include <incise/core/nearest_name.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

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

/// Returns the unit vector of an anatomical direction in LPS; nothing for any other word.
std::optional<Eigen::Vector3d> anatomical_direction(const std::string& word) {
  using Eigen::Vector3d;
  if (word == "left") return Vector3d::UnitX();
  if (word == "right") return -Vector3d::UnitX();
  if (word == "posterior") return Vector3d::UnitY();
  if (word == "anterior") return -Vector3d::UnitY();
  if (word == "superior") return Vector3d::UnitZ();
  if (word == "inferior") return -Vector3d::UnitZ();
  return std::nullopt;
}

}  // namespace

YamlReader::YamlReader(const YAML::Node& root, std::string name) : name_(std::move(name)) {
  require_map(root, "");
  levels_.push_back({.node = root});
}

std::string YamlReader::path_of(std::string_view name) const {
  const Level& level = levels_.back();
  if (level.is_list) return fmt::format("{}[{}]", level.name, level.next - 1);
  if (name.empty()) return level.name;
  return level.name.empty() ? std::string(name) : fmt::format("{}.{}", level.name, name);
}

void YamlReader::refuse(const Field& field, const std::string& found, const std::string& expected) const {
  const Level& level = levels_.back();
  if (field.name.empty() && level.node.IsDefined()) refuse_unknown_keys(level);  // may be why
  const YAML::Node node = find(field.name);
  refuse(node.IsDefined() ? node : level.node, path_of(field.name), found, expected);
}

void YamlReader::refuse(const YAML::Node& node, const std::string& path, const std::string& found,
                        const std::string& expected, const std::string& hint) const {
  const YAML::Mark mark = node.IsDefined() ? node.Mark() : YAML::Mark::null_mark();
  const std::string where = mark.is_null() ? name_ : fmt::format("{} line {}", name_, mark.line + 1);
  throw CaseError(where, path, found, expected, hint);
}

void YamlReader::require_map(const YAML::Node& node, const std::string& path) const {
  if (!node.IsMap()) refuse(node, path, shown(node), "a group of `key: value` lines");
  std::set<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) refuse(entry.first, path, "a key that is not a word", "plain keys");
    if (!seen.insert(entry.first.Scalar()).second) {
      refuse(entry.first, path, fmt::format("the key '{}' twice", entry.first.Scalar()), "each key once");
    }
  }
}

void YamlReader::refuse_unknown_keys(const Level& level) const {
  for (const auto& entry : level.node) {
    const std::string& key = entry.first.Scalar();
    if (std::find(level.known.begin(), level.known.end(), key) != level.known.end()) continue;
    const std::string path = level.name.empty() ? key : fmt::format("{}.{}", level.name, key);
    refuse(entry.first, path, "an unknown key", fmt::format("one of {}", fmt::join(level.known, ", ")),
           did_you_mean(key, level.known));
  }
}

/// Returns the node of a field; with an empty name, the node of the level itself.
YAML::Node YamlReader::find(std::string_view name) const {
  const YAML::Node& node = levels_.back().node;  // const: looking up must not insert
  if (name.empty()) return node;
  if (!node.IsDefined() || !node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  return node[std::string(name)];
}

/// Returns the node of the visited field and marks its key as known; in a list, returns the next item.
YAML::Node YamlReader::take(const Field& field) {
  Level& level = levels_.back();
  const bool is_optional = std::exchange(is_optional_, false);
  if (level.is_list) return level.node[level.next++];
  const bool is_required = level.is_of_item && !is_optional;
  if (std::find(level.known.begin(), level.known.end(), field.name) == level.known.end())
    level.known.emplace_back(field.name);
  YAML::Node node = find(field.name);
  if (is_required && field.meaning.empty()) level.required.emplace_back(field.name);
  if (is_required && level.node.IsDefined() && !node.IsDefined() && !level.missing) level.missing = field;
  return node;
}

void YamlReader::begin(const Field& field) {
  const bool is_of_item = levels_.back().is_of_item || is_optional_;
  Level inner{.node = take(field), .name = path_of(field.name), .is_of_item = is_of_item};
  if (inner.node.IsDefined()) require_map(inner.node, inner.name);
  levels_.push_back(std::move(inner));
}

void YamlReader::end() {
  const Level level = std::move(levels_.back());
  levels_.pop_back();
  if (!level.node.IsDefined()) return;
  refuse_unknown_keys(level);
  if (!level.missing) return;
  const std::string_view meaning = level.missing->meaning;
  refuse(level.node, level.name, fmt::format("no `{}`", level.missing->name),
         meaning.empty() ? fmt::format("{}", fmt::join(level.required, " and ")) : std::string(meaning));
}

std::size_t YamlReader::begin_list(const Field& field, std::size_t, std::size_t) {
  const bool is_optional = is_optional_;
  Level list{.node = take(field), .name = path_of(field.name), .is_list = true, .is_of_item = true};
  const bool is_there = list.node.IsDefined();
  if (is_there && is_optional && (!list.node.IsSequence() || list.node.size() == 0)) {
    refuse(list.node, list.name, list.node.IsSequence() ? "an empty list" : "no list",
           fmt::format("a list of {}", field.name));
  }
  if (is_there && !list.node.IsSequence()) refuse(list.node, list.name, shown(list.node), "a list of groups");
  levels_.push_back(std::move(list));
  return is_there ? levels_.back().node.size() : kUnchanged;
}

void YamlReader::end_list() {
  levels_.pop_back();
}

bool YamlReader::optional(const Field& field, bool is_there) {
  is_optional_ = true;
  const bool is_given = take(field).IsDefined() || is_there;
  is_optional_ = is_given;
  return is_given;
}

double YamlReader::read_number(const YAML::Node& node, const std::string& path, const Range& range) const {
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) refuse(node, path, shown(node), describe(range));
  if (!contains(range, value)) refuse(node, path, node.Scalar(), describe(range));
  return value;
}

void YamlReader::read_numbers(const YAML::Node& node, const std::string& path, const Block& block) const {
  // Nested lists (a box as two corners, a matrix as four rows) are read in order.
  std::vector<YAML::Node> flat;
  if (!node.IsSequence()) refuse(node, path, shown(node), fmt::format("a list of {} numbers", block.count));
  for (const auto& item : node) {
    if (item.IsSequence()) {
      for (const auto& inner : item) flat.push_back(inner);
    } else {
      flat.push_back(item);
    }
  }
  if (flat.size() != block.count) {
    refuse(node, path, fmt::format("{} numbers", flat.size()), fmt::format("{} numbers", block.count));
  }
  for (std::size_t i = 0; i < flat.size(); ++i)
    static_cast<double*>(block.data)[i] = read_number(flat[i], fmt::format("{}[{}]", path, i), block.range);
}

void YamlReader::number(const Field& field, double& value, const Range& range) {
  const YAML::Node node = take(field);
  if (node.IsDefined()) value = read_number(node, path_of(field.name), range);
}

void YamlReader::integer(const Field& field, std::int64_t& value, const Range& range) {
  const YAML::Node node = take(field);
  if (!node.IsDefined()) return;
  const double number = read_number(node, path_of(field.name), range);
  if (number != std::floor(number)) refuse(node, path_of(field.name), node.Scalar(), "a whole number");
  value = static_cast<std::int64_t>(number);
}

void YamlReader::flag(const Field& field, bool& value) {
  const YAML::Node node = take(field);
  if (!node.IsDefined()) return;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) {
    refuse(node, path_of(field.name), shown(node), "true or false");
  }
}

void YamlReader::text(const Field& field, std::string& value) {
  const YAML::Node node = take(field);
  if (!node.IsDefined()) return;
  if (!node.IsScalar()) refuse(node, path_of(field.name), shown(node), "a text");
  value = node.Scalar();
}

void YamlReader::choice(const Field& field, std::size_t& value, Names names) {
  const YAML::Node node = take(field);
  const Level& level = levels_.back();
  if (!node.IsDefined() && level.missing && level.missing->name == field.name) {  // what else is known depends on it
    refuse(level.node, level.name, fmt::format("no `{}`", field.name),
           fmt::format("{}: {}", field.name, choices(names)));
  }
  if (!node.IsDefined()) return;
  const auto found = std::find_if(names.begin(), names.end(),
                                  [&](std::string_view name) { return node.IsScalar() && node.Scalar() == name; });
  if (found == names.end()) {
    const std::vector<std::string> valid(names.begin(), names.end());
    const std::string hint = node.IsScalar() ? did_you_mean(node.Scalar(), valid) : std::string();
    refuse(node, path_of(field.name), shown(node), fmt::format("one of {}", fmt::join(valid, ", ")), hint);
  }
  value = static_cast<std::size_t>(found - names.begin());
}

void YamlReader::block(const Field& field, const Block& block) {
  if (block.kind == Block::Kind::Int32) return whole_numbers(field, block);
  INCISE_REQUIRE(block.kind == Block::Kind::Double, "expected numbers of double precision in a file of settings");
  const Level& level = levels_.back();
  const YAML::Node node = level.is_list ? level.node : take(field);
  if (!node.IsDefined()) return;
  const std::string path = level.is_list ? level.name : path_of(field.name);
  auto* const values = static_cast<double*>(block.data);
  if (block.is_direction && node.IsScalar()) {
    const std::optional<Eigen::Vector3d> named = anatomical_direction(node.Scalar());
    if (!named)
      refuse(node, path, shown(node), "a vector, or one of anterior, posterior, left, right, superior, inferior");
    std::copy_n(named->data(), 3, values);
    return;
  }
  read_numbers(node, path, block);
  if (!block.is_direction) return;
  Eigen::Map<Eigen::Vector3d> direction(values);
  if (!is_direction(std::span<const double, 3>(values, 3))) refuse(node, path, shown(node), kDirectionText);
  direction.normalize();
}

void YamlReader::whole_numbers(const Field& field, const Block& block) {
  const Level& level = levels_.back();
  const std::string path = level.is_list ? level.name : path_of(field.name);
  auto* const values = static_cast<std::int32_t*>(block.data);
  std::vector<double> numbers(values, values + block.count);
  Block same = block;
  same.kind = Block::Kind::Double;
  same.data = numbers.data();
  this->block(field, same);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != std::floor(numbers[i]))
      refuse(level.node, fmt::format("{}[{}]", path, i), fmt::format("{}", numbers[i]), "a whole number");
    values[i] = static_cast<std::int32_t>(numbers[i]);
  }
}

std::size_t YamlReader::key(std::size_t& place, std::span<const Field> keys) {
  Level& level = levels_.back();
  for (const Field& key : keys) level.known.emplace_back(key.name);
  if (!level.node.IsDefined()) {
    place = kUnchanged;
    return 1;
  }
  std::size_t found = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (find(keys[i].name).IsDefined() && found++ == 0) place = i;
  }
  return found;
}

}  // namespace incise
