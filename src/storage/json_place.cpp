#include "storage/json_place.hpp"

namespace incise {
namespace {

std::string shortened_dump(const nlohmann::ordered_json& value) {
  return value.dump().substr(0, 40);
}

}  // namespace

void JsonPlace::refuse(const std::string& key, const std::string& found, const std::string& expected) const {
  throw DataError(path, prefix + key, found, expected, hint);
}

const nlohmann::ordered_json& JsonPlace::at(const std::string& key, const char* expected) const {
  const auto found = object.find(key);
  if (found == object.end()) refuse(key, "no such key", expected);
  return *found;
}

double JsonPlace::number(const std::string& key) const {
  const nlohmann::ordered_json& value = at(key, "a number");
  if (!value.is_number()) refuse(key, shortened_dump(value), "a number");
  return value.get<double>();
}

double JsonPlace::number_between(const std::string& key, double low, double high) const {
  const double value = number(key);
  if (!(value >= low && value <= high))
    refuse(key, fmt::format("{}", value), fmt::format("a number from {} to {}", low, high));
  return value;
}

std::string JsonPlace::text(const std::string& key) const {
  const nlohmann::ordered_json& value = at(key, "text");
  if (!value.is_string()) refuse(key, shortened_dump(value), "text");
  return value.get<std::string>();
}

bool JsonPlace::flag(const std::string& key) const {
  const nlohmann::ordered_json& value = at(key, "true or false");
  if (!value.is_boolean()) refuse(key, shortened_dump(value), "true or false");
  return value.get<bool>();
}

std::optional<double> JsonPlace::number_or_null(const std::string& key) const {
  return at(key, "a number or null").is_null() ? std::nullopt : std::optional(number(key));
}

std::optional<bool> JsonPlace::flag_or_null(const std::string& key) const {
  const nlohmann::ordered_json& value = at(key, "true, false or null");
  if (value.is_null()) return std::nullopt;
  if (!value.is_boolean()) refuse(key, shortened_dump(value), "true, false or null");
  return value.get<bool>();
}

std::vector<double> JsonPlace::numbers(const std::string& key) const {
  const nlohmann::ordered_json& list = at(key, "a list of numbers");
  if (!list.is_array()) refuse(key, shortened_dump(list), "a list of numbers");
  std::vector<double> values;
  for (const nlohmann::ordered_json& item : list) {
    if (!item.is_number()) refuse(fmt::format("{}[{}]", key, values.size()), shortened_dump(item), "a number");
    values.push_back(item.get<double>());
  }
  return values;
}

JsonPlace JsonPlace::inside(const std::string& key) const {
  const nlohmann::ordered_json& value = at(key, "an object");
  if (!value.is_object()) refuse(key, value.is_null() ? "null" : "no object", "an object");
  return {path, value, prefix + key + ".", hint};
}

std::vector<JsonPlace> JsonPlace::objects(const std::string& key) const {
  const nlohmann::ordered_json& list = at(key, "a list of objects");
  if (!list.is_array()) refuse(key, shortened_dump(list), "a list of objects");
  std::vector<JsonPlace> places;
  for (const nlohmann::ordered_json& item : list) {
    const std::string name = fmt::format("{}[{}]", key, places.size());
    if (!item.is_object()) refuse(name, shortened_dump(item), "an object");
    places.push_back({path, item, prefix + name + ".", hint});
  }
  return places;
}

}  // namespace incise
