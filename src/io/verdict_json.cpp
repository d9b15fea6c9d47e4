#include "io/json_reading.hpp"

#include <incise/core/error.hpp>
#include <incise/io/verdict_json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {
namespace {

using io_detail::JsonValue;
using nlohmann::ordered_json;

ordered_json or_nothing(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json place_json(const std::optional<VerdictPlace>& at) {
  if (!at) return nullptr;
  ordered_json json;
  json["arclength_mm"] = or_nothing(at->arclength_mm);
  json["position_mm"] = nullptr;
  if (at->position_mm) json["position_mm"] = {at->position_mm->x(), at->position_mm->y(), at->position_mm->z()};
  json["text"] = at->text;
  return json;
}

/// A null and an absent key are the same: not known.
std::optional<JsonValue> known(const JsonValue& place, const ordered_json& json, const char* key) {
  if (!json.contains(key) || json.at(key).is_null()) return std::nullopt;
  return place.find(key);
}

std::optional<double> number_or_nothing(const JsonValue& place, const ordered_json& json, const char* key) {
  const std::optional<JsonValue> value = known(place, json, key);
  return value ? std::optional(value->number()) : std::nullopt;
}

VerdictStatus status_at(const JsonValue& place) {
  const std::optional<VerdictStatus> status = value_of<VerdictStatus>(place.text());
  if (!status) place.expected(choices(names_of(VerdictStatus{})));
  return *status;
}

VerdictReason reason_from(const JsonValue& place, const ordered_json& json) {
  VerdictReason reason;
  reason.id = place.at("id").text();
  const std::span<const VerdictRule> rules = verdict_rules();
  const auto rule = std::find_if(rules.begin(), rules.end(), [&](const VerdictRule& r) { return r.id == reason.id; });
  if (rule == rules.end()) place.at("id").expected("the id of a rule of the verdict");
  reason.severity = status_at(place.at("severity"));
  if (reason.severity != rule->severity) place.at("severity").expected(std::string(to_string(rule->severity)));
  reason.value = number_or_nothing(place, json, "value");
  reason.limit = number_or_nothing(place, json, "limit");
  reason.unit = place.at("unit").text();
  reason.message = place.at("message").text();
  if (const auto at = known(place, json, "at")) {
    const ordered_json& at_json = json.at("at");
    VerdictPlace where;
    where.arclength_mm = number_or_nothing(*at, at_json, "arclength_mm");
    if (const auto position = known(*at, at_json, "position_mm")) where.position_mm = position->point();
    if (const auto text = known(*at, at_json, "text")) where.text = text->text();
    reason.at = where;
  }
  return reason;
}

}  // namespace

ordered_json to_json(const Verdict& verdict) {
  ordered_json json;
  json["status"] = to_string(verdict.status());
  json["reasons"] = ordered_json::array();
  for (const VerdictReason& reason : verdict.reasons()) {
    json["reasons"].push_back({{"id", reason.id},
                               {"severity", to_string(reason.severity)},
                               {"value", or_nothing(reason.value)},
                               {"limit", or_nothing(reason.limit)},
                               {"unit", reason.unit},
                               {"at", place_json(reason.at)},
                               {"message", reason.message}});
  }
  return json;
}

Verdict verdict_from_json(const ordered_json& json, const std::filesystem::path& file) {
  const JsonValue root(json, file, "/verdict");
  const VerdictStatus status = status_at(root.at("status"));
  Verdict verdict;
  const std::vector<JsonValue> places = root.at("reasons").items();
  for (std::size_t i = 0; i < places.size(); ++i) verdict.add(reason_from(places[i], json.at("reasons").at(i)));
  if (verdict.status() != status) root.at("status").expected(fmt::format("{}, that of the worst reason", to_string(verdict.status())));
  return verdict;
}

}  // namespace incise
