#include "paths_table.hpp"

#include <fmt/format.h>

#include <string>

namespace incise::cli {
namespace {

void print_area(const char* name, const nlohmann::ordered_json& area) {
  if (!area.is_object()) return;
  fmt::print("{:<34} {:.2f} ({:.2f} to {:.2f}); {} of {} were worse\n", name, area.at("area").get<double>(),
             area.at("low").get<double>(), area.at("high").get<double>(), area.at("worse").get<std::size_t>(),
             area.at("worse").get<std::size_t>() + area.at("not_worse").get<std::size_t>());
}

}  // namespace

void print_paths(const char* of, const nlohmann::ordered_json& result) {
  const nlohmann::ordered_json& best = result.at("best_without_simulation");
  fmt::print("{:<34} {:>8} {:>9} {:>6} {:>7} {:>8} {:>10}  {}\n", of, "mean, mm", "specimens", "worse", "harmed",
             "not cut", "margin<2.2", "difference from the best path without simulation, mm (95 %)");
  for (const auto& [name, path] : result.at("rivals").items()) {
    std::string against = best == name ? "best" : "";
    if (path.at("difference_mm").is_number()) against = fmt::format("{:+.2f}", path.at("difference_mm").get<double>());
    if (path.at("difference_mm").is_number() && path.at("compared") != path.at("pairs"))
      against += fmt::format(" of {}", path.at("compared").get<std::size_t>());
    if (path.at("confidence_mm").is_array())
      against += fmt::format(" ({:+.2f} to {:+.2f})", path.at("confidence_mm")[0].get<double>(),
                             path.at("confidence_mm")[1].get<double>());
    const std::string mean =
        path.at("mean_mm").is_number() ? fmt::format("{:.2f}", path.at("mean_mm").get<double>()) : "-";
    const auto count = [&path = path](const char* key) { return path.at(key).template get<std::size_t>(); };
    fmt::print("{:<34} {:>8} {:>9} {:>6} {:>7} {:>8} {:>10}  {}\n", name, mean, count("pairs"), count("worse"),
               count("harmed"), count("uncut"), fmt::format("{} of {}", count("close_margins"), count("closed")),
               against);
  }
  if (best.is_null())
    fmt::print(
        "no specimen was closed along two paths without a simulated cut: no benefit of simulation can be claimed\n");
}

void print_learning(const nlohmann::ordered_json& curve) {
  if (curve.empty()) return;
  fmt::print("{:<34} {:>10} {:>10} {:>9}  {}\n", "photographs", "without", "with", "specimens",
             "difference, mm (95 %)");
  for (const auto& point : curve) {
    const auto& pair = point.at("pair");
    if (!pair.at("difference_mm").is_number()) continue;
    std::string difference = fmt::format("{:+.2f}", pair.at("difference_mm").get<double>());
    if (const auto& ends = pair.at("confidence_mm"); ends.is_array())
      difference += fmt::format(" ({:+.2f} to {:+.2f})", ends[0].get<double>(), ends[1].get<double>());
    fmt::print("{:<34} {:>10.2f} {:>10.2f} {:>9}  {}\n",
               point.at("photographs").is_null() ? std::string("all") : point.at("photographs").dump(),
               pair.at("first_mm").get<double>(), pair.at("second_mm").get<double>(),
               pair.at("compared").get<std::size_t>(), difference);
  }
}

void print_advice(const nlohmann::ordered_json& advice) {
  if (!advice.is_object()) return;
  print_area("advice: area under the curve", advice.at("auc"));
  print_area("  of those outside alone", advice.at("auc_outside_alone"));
  print_area("the same without the pull", advice.at("auc_without_pull"));
  for (const auto& interval : advice.at("intervals"))
    fmt::print("{:<34} {:.2f} ({:.2f} to {:.2f}), {} cuts\n",
               fmt::format("{:.0f} % interval, {}: holds", 100.0 * interval.at("level").get<double>(),
                           interval.at("of").get<std::string>()),
               interval.at("share").get<double>(), interval.at("low").get<double>(), interval.at("high").get<double>(),
               interval.at("cuts").get<std::size_t>());
}

}  // namespace incise::cli
