#pragma once

#include <incise/evaluation/statistics.hpp>

#include <nlohmann/json.hpp>

#include <optional>

namespace incise {

/// What was not measured is null.
template <class Value>
nlohmann::ordered_json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

[[nodiscard]] inline nlohmann::ordered_json summary_json(const std::optional<Summary>& summary) {
  if (!summary) return nullptr;
  return {{"mean", summary->mean}, {"sd", summary->sd}, {"min", summary->min}, {"max", summary->max}};
}

}  // namespace incise
