#include "options.hpp"

#include <incise/io/json_text.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace incise::cli {
namespace {

std::string shown(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return fmt::format("{:.4g}", value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  return value.dump();
}

/// "abs_error_mm.mean" stays one name; long lists are left to --json.
void print_lines(const nlohmann::ordered_json& object, const std::string& prefix) {
  constexpr std::size_t kLongList = 6;
  for (const auto& [key, value] : object.items()) {
    const std::string name = prefix.empty() ? key : prefix + "." + key;
    if (value.is_object()) {
      print_lines(value, name);
    } else if (value.is_array() && !value.empty() && value.front().is_object()) {
      for (const auto& item : value) {
        std::string line;
        for (const auto& [item_key, item_value] : item.items()) line += fmt::format("{} {}  ", item_key, shown(item_value));
        fmt::print("{:<34} {}\n", name, line);
      }
    } else if (!value.is_array() || value.size() <= kLongList) {
      fmt::print("{:<34} {}\n", name, shown(value));
    }
  }
}

}  // namespace

void print_result(const CommonOptions& options, const nlohmann::ordered_json& result) {
  if (options.json) {
    const std::string text = json_text(result);
    std::fwrite(text.data(), 1, text.size(), stdout);
  } else {
    print_lines(result, "");
  }
}

}  // namespace incise::cli
