#include "field_writers.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

Json number_schema(const Range& range, const char* type) {
  Json schema{{"type", type}};
  if (std::isfinite(range.least)) schema[range.is_least_open ? "exclusiveMinimum" : "minimum"] = range.least;
  if (std::isfinite(range.most)) schema[range.is_most_open ? "exclusiveMaximum" : "maximum"] = range.most;
  return schema;
}

Json list_schema(const Json& item, std::size_t size) {
  return {{"type", "array"}, {"items", item}, {"minItems", size}, {"maxItems", size}};
}

/// The numbers of a block. Files of settings hold doubles and whole numbers.
std::vector<double> numbers_of(const Block& block) {
  if (block.kind == Block::Kind::Int32) {
    const std::span whole(static_cast<const std::int32_t*>(block.data), block.count);
    return {whole.begin(), whole.end()};
  }
  INCISE_REQUIRE(block.kind == Block::Kind::Double, "expected numbers of double precision in a file of settings");
  const std::span numbers(static_cast<const double*>(block.data), block.count);
  return {numbers.begin(), numbers.end()};
}

/// Whether a block is lists in a list: a box as two corners, a transform as four rows.
bool has_rows(const Block& block) {
  return block.columns > 1 && block.columns < block.count;
}

}  // namespace

void SchemaWriter::add(const Field& field, Json schema) {
  Level& level = levels_.back();
  const bool is_required = !std::exchange(is_there_, std::nullopt) && level.is_of_item;
  if (!field.meaning.empty()) schema["description"] = field.meaning;
  if (!field.unit.empty()) schema["x-unit"] = field.unit;
  if (field.name.empty()) {
    level.items.push_back(std::move(schema));
    return;
  }
  const std::string name(field.name);
  if (is_required && std::find(level.keys.begin(), level.keys.end(), name) == level.keys.end())
    level.required.push_back(name);
  level.properties[name] = std::move(schema);
}

template <class Value>
void SchemaWriter::add_with_default(const Field& field, Json schema, const Value& value) {
  if (is_there_.value_or(!levels_.back().is_of_item)) schema["default"] = value;
  add(field, std::move(schema));
}

SchemaWriter::Level& SchemaWriter::open(const Field& field) {
  Level inner;
  inner.field = field;
  inner.is_optional = is_there_.has_value();
  inner.is_of_item = levels_.back().is_of_item || inner.is_optional;
  is_there_.reset();
  return levels_.emplace_back(std::move(inner));
}

SchemaWriter::Level SchemaWriter::close() {
  Level level = std::move(levels_.back());
  levels_.pop_back();
  if (level.is_optional) is_there_ = false;
  return level;
}

void SchemaWriter::begin(const Field& field) {
  open(field);
}

void SchemaWriter::end() {
  Level level = close();
  const auto group = [](const Json& properties, const std::vector<std::string>& required) {
    Json schema{{"type", "object"}, {"properties", properties}};
    if (!required.empty()) schema["required"] = required;
    return schema;
  };
  std::vector<Json> forms;
  if (level.keys.empty()) {
    forms.push_back(group(level.properties, level.required));
  } else if (level.properties.size() == level.keys.size()) {
    forms.push_back(group(level.properties, {}));
    forms.back()["minProperties"] = 1;
    forms.back()["maxProperties"] = 1;
    level.field.meaning = {};  // the keys say it
  } else {                     // a form for each of the keys
    for (const std::string& key : level.keys) {
      Json properties = level.properties;
      for (const std::string& other : level.keys)
        if (other != key) properties.erase(other);
      std::vector<std::string> required = level.required;
      required.push_back(key);
      forms.push_back(group(properties, required));
    }
  }
  for (Json& form : forms) {
    form["additionalProperties"] = false;
    add(level.field, std::move(form));
  }
}

std::size_t SchemaWriter::begin_list(const Field& field, std::size_t, std::size_t) {
  open(field).is_of_item = true;
  return kEveryKind;
}

void SchemaWriter::end_list() {
  Level list = close();
  Json schema{{"type", "array"}};
  if (list.is_optional) schema["minItems"] = 1;
  schema["items"] = list.items.size() == 1 ? std::move(list.items.front()) : Json{{"oneOf", std::move(list.items)}};
  add(list.field, std::move(schema));
}

bool SchemaWriter::optional(const Field&, bool is_there) {
  is_there_ = is_there;
  return true;
}

void SchemaWriter::number(const Field& field, double& value, const Range& range) {
  add_with_default(field, number_schema(range, "number"), value);
}

void SchemaWriter::integer(const Field& field, std::int64_t& value, const Range& range) {
  add_with_default(field, number_schema(range, "integer"), value);
}

void SchemaWriter::flag(const Field& field, bool& value) {
  add_with_default(field, {{"type", "boolean"}}, value);
}

void SchemaWriter::text(const Field& field, std::string& value) {
  Json schema{{"type", "string"}};
  if (!field.pattern.empty()) schema["pattern"] = field.pattern;
  add_with_default(field, std::move(schema), value);
}

void SchemaWriter::choice(const Field& field, std::size_t& value, Names names) {
  if (levels_.back().is_of_item) {  // tells the items of a list apart
    add({field.name}, {{"const", names[value]}});
  } else {
    add_with_default(field, {{"enum", std::vector<std::string>(names.begin(), names.end())}}, names[value]);
  }
}

void SchemaWriter::block(const Field& field, const Block& block) {
  const Json item = number_schema(block.range, block.kind == Block::Kind::Int32 ? "integer" : "number");
  if (field.name.empty()) return add(field, block.columns > 1 ? list_schema(item, block.columns) : item);  // of a list
  Json schema = list_schema(item, block.count);
  if (has_rows(block)) schema = list_schema(list_schema(item, block.columns), block.count / block.columns);
  if (block.is_direction) {
    schema = {{"oneOf", {schema, {{"enum", {"anterior", "posterior", "left", "right", "superior", "inferior"}}}}}};
  }
  add_with_default(field, std::move(schema), numbers_of(block));
}

std::size_t SchemaWriter::key(std::size_t& place, std::span<const Field> keys) {
  for (const Field& key : keys) levels_.back().keys.emplace_back(key.name);
  place = kEveryKind;
  return 1;
}

void SettingLister::add(const Field& field, std::string value, bool is_group) {
  if (depth_ == 0) {
    lines_.push_back({fmt::format("{}", fmt::join(groups_, ".")), std::string(field.name), std::move(value),
                      std::string(field.unit), std::string(field.meaning), is_group});
    return;
  }
  if (list_.back() != '[' && list_.back() != '{') list_ += ", ";
  if (!field.name.empty()) list_ += fmt::format("{}: ", field.name);
  list_ += value;
}

void SettingLister::open(const Field& field, char bracket) {
  add(field, std::string(1, bracket));
  ++depth_;
}

void SettingLister::close(char bracket) {
  list_ += bracket;
  --depth_;
}

void SettingLister::begin(const Field& field) {
  if (depth_ > 0) return open(field, '{');
  add(field, "", true);
  groups_.emplace_back(field.name);
}

void SettingLister::end() {
  if (depth_ > 0) return close('}');
  groups_.pop_back();
}

std::size_t SettingLister::begin_list(const Field& field, std::size_t size, std::size_t) {
  if (depth_ == 0) {  // its line is filled in by end_list
    add(field, "");
    list_ = "[";
    ++depth_;
  } else {
    open(field, '[');
  }
  return size;
}

void SettingLister::end_list() {
  close(']');
  if (depth_ == 0 && list_ != "[]") lines_.back().value = std::move(list_);
}

bool SettingLister::optional(const Field& field, bool is_there) {
  if (!is_there && depth_ == 0) add(field, "");
  return is_there;
}

void SettingLister::number(const Field& field, double& value, const Range&) {
  add(field, fmt::format("{}", value));
}

void SettingLister::integer(const Field& field, std::int64_t& value, const Range&) {
  add(field, fmt::format("{}", value));
}

void SettingLister::flag(const Field& field, bool& value) {
  add(field, value ? "true" : "false");
}

void SettingLister::text(const Field& field, std::string& value) {
  // In a list only a word, or NAME=VALUE, goes without quotes.
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  const std::size_t end = value.find_first_not_of(kPlain);
  const bool is_plain = depth_ == 0 || end == std::string::npos || value[end] == '=';
  add(field, is_plain ? value : fmt::format("\"{}\"", value));
}

void SettingLister::choice(const Field& field, std::size_t& value, Names names) {
  add(field, std::string(names[value]));
}

void SettingLister::block(const Field& field, const Block& block) {
  std::vector<double> numbers = numbers_of(block);
  for (double& number : numbers) number += 0.0;                        // -0 becomes 0
  const bool is_of_list = field.name.empty() && list_.ends_with('[');  // whose brackets stand already
  if (block.columns == 1 && is_of_list) {
    for (const double number : numbers) add(field, fmt::format("{}", number));
    return;
  }
  if (!is_of_list && (depth_ == 0 || !has_rows(block)))
    return add(field, fmt::format("[{}]", fmt::join(numbers, ", ")));
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < block.count; i += block.columns)
    rows.push_back(fmt::format("[{}]", fmt::join(std::span(numbers).subspan(i, block.columns), ", ")));
  if (!is_of_list) return add(field, fmt::format("[{}]", fmt::join(rows, ", ")));
  for (const std::string& row : rows) add(field, row);
}

}  // namespace incise
