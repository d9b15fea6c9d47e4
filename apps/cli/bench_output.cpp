#include "bench_output.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace incise::cli {
namespace {

std::string two_decimals(const nlohmann::ordered_json& value) {
  return value.is_number() ? fmt::format("{:.2f}", value.get<double>()) : std::string("-");
}

}  // namespace

void print_acceptance(const nlohmann::ordered_json& result) {
  fmt::print("VIRTUAL specimens, mean |error| of the photographs, mm\n{:>6} {:>10} {:>8} {:>12}\n", "seed", "planned",
             "paper's", "mm/s");
  for (const auto& row : result.at("rows")) {
    const auto& asked = row.at("prescription");
    fmt::print("{:>6} {:>10} {:>8} {:>12}\n", row.at("seed").get<std::uint64_t>(), two_decimals(row.at("planned_mm")),
               two_decimals(row.at("paper_pass_mm")), asked.is_object() ? two_decimals(asked.at("speed_mm_s")) : "-");
  }
}

void print_factors(const nlohmann::ordered_json& result) {
  const auto moved = [&](const char* name, const nlohmann::ordered_json& parts) {
    const auto part = [&](const char* key) {
      return parts.is_object() ? two_decimals(parts.at(key)) : std::string("-");
    };
    fmt::print("{:<14} {:>6} {:>6} {:>6}", name, part("level_mm"), part("shift_mm"), part("rest_mm"));
  };
  fmt::print(
      "VIRTUAL specimens: how far each factor moves a ring, and how much it changes the mean |error|, mm\n"
      "{:<14} {:>6} {:>6} {:>6} {:>24} {:>18}\n",
      "factor", "mean", "shift", "rest", "change (95 %)", "closed with/without");
  for (const auto& factor : result.at("factors")) {
    const auto& ends = factor.at("change_95_mm");
    moved(factor.at("factor").get<std::string>().c_str(), factor.at("moved"));
    fmt::print(
        " {:>24} {:>8}/{}\n",
        fmt::format("{} ({} to {})", two_decimals(factor.at("change_mm")),
                    two_decimals(ends.is_array() ? ends[0] : ends), two_decimals(ends.is_array() ? ends[1] : ends)),
        fmt::format("{} of {}", factor.at("measured_with").dump(), factor.at("made_with").dump()),
        fmt::format("{} of {}", factor.at("measured_without").dump(), factor.at("made_without").dump()));
  }
  moved("by chance", result.at("chance"));
  fmt::print("\n");
}

}  // namespace incise::cli
