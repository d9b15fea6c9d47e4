#include "options.hpp"
#include "verdict_gate.hpp"

#include <incise/io/json_file.hpp>

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

namespace incise::cli {
namespace {

std::string shown(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return fmt::format("{:.4g}", value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  return value.dump();
}

/// Prints the checks of a program as a table.
void print_checks(const nlohmann::ordered_json& checks) {
  fmt::print("{:<20} {:>12} {:>16}  {:<8} {}\n", "check", "found", "limit", "unit", "passed");
  for (const auto& check : checks) {
    const auto relation = check.at("relation").get<std::string>();
    const bool is_yes_or_no = relation.empty();
    const std::string found = is_yes_or_no ? (check.at("value") == 1.0 ? "yes" : "no") : shown(check.at("value"));
    const std::string limit = is_yes_or_no ? "yes" : fmt::format("{} {}", relation, shown(check.at("limit")));
    const char* failed = check.at("overridden").get<bool>() ? "overridden" : "NO";
    fmt::print("{:<20} {:>12} {:>16}  {:<8} {}\n", check.at("name").get<std::string>(), found, limit,
               check.at("unit").get<std::string>(), check.at("passed").get<bool>() ? "yes" : failed);
  }
}

/// Prints nested keys as one name, "abs_error_mm.mean"; long lists of numbers are left to --json.
void print_lines(const nlohmann::ordered_json& object, const std::string& prefix) {
  constexpr std::size_t kLongList = 6;
  for (const auto& [key, value] : object.items()) {
    if (key == "warnings") continue;  // shown as such, on standard error
    const std::string name = prefix.empty() ? key : prefix + "." + key;
    if (key == "verdict" && value.is_object() && value.contains("reasons")) {
      print_verdict(value);
    } else if (key == "checks" && value.is_array() && !value.empty() && value.front().contains("relation")) {
      print_checks(value);
    } else if (value.is_object()) {
      print_lines(value, name);
    } else if (value.is_array() && !value.empty() && value.front().is_object()) {
      for (const auto& item : value) {
        std::string line;
        for (const auto& [item_key, item_value] : item.items()) line += fmt::format("{} {}  ", item_key, shown(item_value));
        fmt::print("{:<34} {}\n", name, line);
      }
    } else if (!value.is_array() || value.size() <= kLongList || value.front().is_string()) {
      fmt::print("{:<34} {}\n", name, shown(value));
    }
  }
}

struct CutLine {
  const char* text;
  const char* pointer;  // into the summary of one cut
};
constexpr std::array<CutLine, 13> kCutLines{{{"outcome", "/outcome"},
                                             {"ring closed", "/closed_loop"},
                                             {"mid-line: mean |error|, mm", "/abs_error_mm/mean"},
                                             {"mid-line: greatest |error|, mm", "/abs_error_mm/max"},
                                             {"mid-line: mean signed error, mm", "/signed_error_mm/mean"},
                                             {"inner edge: mean |error|, mm", "/inner_edge/abs_error_mm/mean"},
                                             {"centroid shift, mm", "/centroid_shift_mm"},
                                             {"depth reached: least, mm", "/depth_reached_mm/min"},
                                             {"lag when cut: mean, mm", "/lag_mm/mean"},
                                             {"kerf to tumour surface: least, mm", "/deep_margin_mm/nearest"},
                                             {"greatest tool force, mN", "/peak_tool_force_mn"},
                                             {"vertex moves limited to max_step_mm", "/held_back_vertices"},
                                             {"time of the cut, s", "/wall_s"}}};

/// A simulated cut in a result: its place (a JSON pointer) and its name.
struct ShownCut {
  std::string at;
  const char* name;
};

std::string shown_at(const nlohmann::ordered_json& result, const std::string& pointer) {
  const nlohmann::ordered_json::json_pointer place(pointer);
  return result.contains(place) ? shown(result.at(place)) : "-";
}

/// Prints the main measures of cuts side by side, and which rings closed although strips of skin hide their inner edge.
void print_cuts(const nlohmann::ordered_json& result, const std::vector<ShownCut>& cuts) {
  const auto print_row = [&](const char* text, const auto& cell_of) {
    fmt::print("{:<36}", text);
    for (const ShownCut& cut : cuts) fmt::print(" {:>16}", cell_of(cut));
    fmt::print("\n");
  };
  if (cuts.size() > 1) print_row("simulated", [](const ShownCut& cut) { return std::string(cut.name); });
  for (const CutLine& line : kCutLines)
    print_row(line.text, [&](const ShownCut& cut) { return shown_at(result, cut.at + line.pointer); });
  std::string hidden;
  for (const ShownCut& cut : cuts) {
    if (shown_at(result, cut.at + "/closed_loop") != "yes") continue;
    const std::string seen = shown_at(result, cut.at + "/inner_edge/outcome");
    const bool is_measured = shown_at(result, cut.at + "/inner_edge/abs_error_mm/mean") != "-";
    if (seen != "-" && !is_measured) hidden += (hidden.empty() ? "" : " and ") + std::string(cut.name);
  }
  if (hidden.empty()) return;
  fmt::print(
      "No inner edge is seen from above {}: strips of skin still bridge the kerf. Look at the report, and try a "
      "finer mesh. Margins are those of the mid-line and of the kerf below.\n",
      hidden);
}

/// Prints how the error fell from pass to pass, against the mesh-resolution limit.
void print_passes(const nlohmann::ordered_json& result) {
  const nlohmann::ordered_json::json_pointer history("/correction/history");
  if (!result.contains(history)) return;
  const nlohmann::ordered_json& correction = result.at("correction");
  std::string line;
  for (const auto& pass : correction.at("history")) line += (line.empty() ? "" : ", ") + shown(pass.at("mean_abs_error_mm"));
  fmt::print("{:<36} {} ({}, pass {} kept)\n", "mean |error| pass by pass, mm", line, shown(correction.at("compensation_outcome")),
             shown(correction.at("best_pass")));
  fmt::print("{:<36} {}\n", "mesh-resolution limit, mm", shown(correction.at("floor_mm")));
}

/// Prints the expected error of each path over a calibration's posterior.
void print_risks(const nlohmann::ordered_json& result) {
  const auto robust = result.find("robust");
  if (robust == result.end() || !robust->is_object()) return;
  fmt::print("\n{:<36} {:>16} {:>16} {:>16}\n", "over the calibration's posterior", "as planned", "corrected", "robust");
  for (const auto& [key, text] : {std::pair{"expected_abs_error_mm", "expected mean |error|, mm"}, std::pair{"p_close_margin", "P(close margin anywhere)"},
                                  std::pair{"unmeasured_weight", "share of tissues with an open ring"}}) {
    fmt::print("{:<36}", text);
    for (const char* path : {"intended", "corrected", "robust"}) fmt::print(" {:>16}", shown(robust->at(path).at(key)));
    fmt::print("\n");
  }
  fmt::print("{:<36} {}\n", "robust path", shown(robust->at("outcome")));
}

}  // namespace

void print_cut(const nlohmann::ordered_json& result) {
  if (!result.contains("closed_loop")) return print_lines(result, "");  // it was not even stretched
  print_cuts(result, {{"", "along this path"}});
  fmt::print("\n");
  print_verdict(result.at("verdict"));
  fmt::print("all numbers: --json, or incision.json in {}\n", result.at("folder").get<std::string>());
}

void print_study(const nlohmann::ordered_json& result) {
  print_cuts(result, {{"/before", "as planned"}, {"/after", "corrected"}});
  print_passes(result);
  print_risks(result);
  fmt::print("\n");
  if (const auto verdict = result.find("verdict"); verdict != result.end() && verdict->is_object()) print_verdict(*verdict);
  for (const char* key : {"outcome", "accepted", "specimen_is", "report", "wall_s"}) {
    if (const auto value = result.find(key); value != result.end() && !value->is_structured()) fmt::print("{:<36} {}\n", key, shown(*value));
  }
  fmt::print("all numbers: --json, or incision.json in the folder of each cut\n");
}

void print_result(const CommonOptions& options, const nlohmann::ordered_json& result) {
  if (options.json) {
    const std::string text = json_text(result);
    std::fwrite(text.data(), 1, text.size(), stdout);
  } else {
    print_lines(result, "");
  }
}

}  // namespace incise::cli
