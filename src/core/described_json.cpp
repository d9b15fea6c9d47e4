#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/core/nearest_name.hpp>
#include <incise/core/utf8.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShownCharacters = 60;

/// Returns the value as text for a message, at most 60 characters.
std::string shown(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > kShownCharacters) text = std::string(utf8_prefix(text, kShownCharacters - 3)) + "...";
  return text;
}

}  // namespace

Json& JsonWriter::put(const Field& field, Json value) {
  if (open_.empty()) return root_ = std::move(value);
  Json& open = *open_.back();
  if (open.is_object()) return open[std::string(field.name)] = std::move(value);
  open.push_back(std::move(value));
  return open.back();
}

void JsonWriter::begin(const Field& field) {
  open_.push_back(&put(field, Json::object()));
}

std::size_t JsonWriter::begin_list(const Field& field, std::size_t size, std::size_t) {
  open_.push_back(&put(field, Json::array()));
  return size;
}

bool JsonWriter::optional(const Field& field, bool is_there) {
  if (!is_there && !field.is_omitted) put(field, nullptr);
  return is_there;
}

void JsonWriter::number(const Field& field, double& value, const Range&) {
  put(field, value);
}
void JsonWriter::integer(const Field& field, std::int64_t& value, const Range& range) {
  const bool is_large = as_number(value, range) != static_cast<double>(value);
  put(field, is_large ? Json(static_cast<std::uint64_t>(value)) : Json(value));
}
void JsonWriter::flag(const Field& field, bool& value) {
  put(field, value);
}
void JsonWriter::text(const Field& field, std::string& value) {
  put(field, value);
}
void JsonWriter::choice(const Field& field, std::size_t& value, Names names) {
  put(field, value < names.size() ? names[value] : "unknown");
}

void JsonWriter::block(const Field& field, const Block& block) {
  const bool is_listed = !open_.empty() && open_.back()->is_array();  // its groups are the items
  const bool is_group = !is_listed && block.count == block.columns;
  Json& list = is_listed ? *open_.back() : put(field, Json::array());
  with_numbers(block, [&](const auto* numbers) {
    for (std::size_t i = 0; i < block.count; i += block.columns) {
      Json group = Json::array();
      for (std::size_t k = 0; k < block.columns; ++k) group.push_back(numbers[i + k]);
      if (is_group) {
        list = std::move(group);
      } else {
        list.push_back(block.columns == 1 ? std::move(group[0]) : std::move(group));
      }
    }
  });
}

void JsonWriter::refuse(const Field& field, const std::string& found, const std::string& expected) const {
  core_detail::throw_invalid_argument("to_json", fmt::format("{}: found {}, expected {}", field.name, found, expected));
}

const Json* JsonReader::find(const Field& field) {
  if (waiting_ != nullptr) return std::exchange(waiting_, nullptr);
  if (open_.empty()) return root_;
  Open& open = open_.back();
  if (open.json->is_array()) return open.next < open.json->size() ? &(*open.json)[open.next++] : nullptr;
  note(field);
  const auto found = open.json->find(field.name);
  return found == open.json->end() ? nullptr : &*found;
}

const Json& JsonReader::take(const Field& field, bool (Json::*is_kind)() const noexcept, std::string_view kind) {
  const Json* value = find(field);
  if (value == nullptr) refuse(field, "no such key", std::string(kind));
  if (!(value->*is_kind)()) refuse(field, shown(*value), std::string(kind));
  return *value;
}

void JsonReader::note(const Field& field) {
  if (is_strict_ && !open_.empty()) open_.back().known.emplace_back(field.name);
}

void JsonReader::begin(const Field& field) {
  const std::size_t item = open_.empty() ? 0 : open_.back().next;
  const Json& json = take(field, &Json::is_object, "an object");
  open_.push_back({&json, field.name.empty() ? std::to_string(item) : std::string(field.name), 0, {}});
}

void JsonReader::end() {
  const Open& open = open_.back();
  for (auto item = open.json->begin(); is_strict_ && item != open.json->end(); ++item) {
    if (std::find(open.known.begin(), open.known.end(), item.key()) != open.known.end()) continue;
    const std::string meant = did_you_mean(item.key(), open.known);
    refuse({}, fmt::format("unknown key '{}'", item.key()),
           fmt::format("one of: {}{}{}", fmt::join(open.known, ", "), meant.empty() ? "" : ". ", meant));
  }
  open_.pop_back();
}

std::size_t JsonReader::begin_list(const Field& field, std::size_t, std::size_t) {
  const std::size_t item = open_.empty() ? 0 : open_.back().next;
  const Json& json = take(field, &Json::is_array, "a list");
  open_.push_back({&json, field.name.empty() ? std::to_string(item) : std::string(field.name), 0, {}});
  return json.size();
}

bool JsonReader::optional(const Field& field, bool) {
  const Json* value = find(field);
  if (value == nullptr) return false;
  if (value->is_null()) {
    // Writers leave such a field out, so a person wrote this null, and its meaning is unclear.
    if (field.is_omitted) refuse(field, "null", "a value, or no such key");
    return false;
  }
  waiting_ = value;
  return true;
}

void JsonReader::number(const Field& field, double& value, const Range& range) {
  const Json& json = take(field, &Json::is_number, describe(range));
  value = json.get<double>();
  if (!contains(range, value)) refuse(field, shown(json), describe(range));
}

void JsonReader::integer(const Field& field, std::int64_t& value, const Range& range) {
  const Json& json = take(field, &Json::is_number_integer, "a whole number");
  const bool is_large = json.is_number_unsigned() && json.get<std::uint64_t>() > std::uint64_t{INT64_MAX};
  if ((is_large && range.most < 9.3e18) || !contains(range, json.get<double>()))
    refuse(field, shown(json), describe(range));
  value = is_large ? static_cast<std::int64_t>(json.get<std::uint64_t>()) : json.get<std::int64_t>();
}

void JsonReader::flag(const Field& field, bool& value) {
  value = take(field, &Json::is_boolean, "true or false").get<bool>();
}

void JsonReader::text(const Field& field, std::string& value) {
  value = take(field, &Json::is_string, "text").get<std::string>();
}

void JsonReader::choice(const Field& field, std::size_t& value, Names names) {
  const Json& json = take(field, &Json::is_string, choices(names));
  const auto found = std::find(names.begin(), names.end(), json.get_ref<const std::string&>());
  if (found == names.end()) refuse(field, shown(json), choices(names));
  value = static_cast<std::size_t>(found - names.begin());
}

void JsonReader::block(const Field& field, const Block& block) {
  const bool is_listed =
      field.name.empty() && !open_.empty() && open_.back().json->is_array() && open_.back().next == 0;
  const Json& list = is_listed ? *open_.back().json : take(field, &Json::is_array, "a list of numbers");
  const bool is_group = !is_listed && block.count == block.columns;
  const std::size_t groups = is_group ? 1 : block.count / block.columns;
  if (!is_group && list.size() != groups)
    refuse(field, fmt::format("{} items", list.size()),
           block.columns > 1 ? fmt::format("{} rows of {} numbers", groups, block.columns)
                             : fmt::format("{} numbers", groups));
  const auto refuse_item = [&](std::size_t group, std::optional<std::size_t> column, const Json& found,
                               const std::string& expected) {
    std::string place(field.name);
    if (!is_group) place += fmt::format("{}{}", place.empty() ? "" : "/", group);
    if (column) place += fmt::format("/{}", *column);
    refuse(Field{place}, shown(found), expected);
  };
  with_numbers(block, [&](auto* numbers) {
    using Number = std::remove_pointer_t<decltype(numbers)>;
    for (std::size_t i = 0; i < groups; ++i) {
      const Json& group = is_group ? list : list[i];
      const bool is_number = !is_group && block.columns == 1;
      if (!is_number && (!group.is_array() || group.size() != block.columns))
        refuse_item(i, std::nullopt, group, fmt::format("a list of {} numbers", block.columns));
      for (std::size_t k = 0; k < block.columns; ++k) {
        const Json& item = is_number ? group : group[k];
        const double value = item.is_number() ? item.get<double>() : std::nan("");
        const bool is_whole = std::is_floating_point_v<Number> || item.is_number_integer();
        const bool fits = is_whole && value >= static_cast<double>(std::numeric_limits<Number>::lowest()) &&
                          value <= static_cast<double>(std::numeric_limits<Number>::max());
        if (!fits || !contains(block.range, value))
          refuse_item(i, is_number ? std::nullopt : std::optional(k), item, describe(block.range));
        numbers[i * block.columns + k] = static_cast<Number>(value);
      }
    }
  });
}

void JsonReader::refuse(const Field& field, const std::string& found, const std::string& expected) const {
  std::string pointer = pointer_;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (i > 0) pointer += "/" + open_[i].key;  // the first one is the root
  }
  if (!field.name.empty()) {
    pointer += fmt::format("/{}", field.name);
  } else if (!open_.empty() && open_.back().json->is_array() && open_.back().next > 0) {
    pointer += fmt::format("/{}", open_.back().next - 1);
  }
  throw DataError(file_, pointer.empty() ? "/" : pointer, found, expected, hint_);
}

}  // namespace incise
