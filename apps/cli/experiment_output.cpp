#include "experiment_output.hpp"

#include <fmt/format.h>

#include <string>

namespace incise::cli {
namespace {

/// Returns " (-0.10 to +0.32)", or nothing for a null.
std::string interval_text(const nlohmann::ordered_json& ends) {
  if (!ends.is_array()) return "";
  return fmt::format(" ({:+.2f} to {:+.2f})", ends[0].get<double>(), ends[1].get<double>());
}

void print_area(const char* name, const nlohmann::ordered_json& area) {
  if (!area.is_object()) return;
  fmt::print("{:<34} {:.2f} ({:.2f} to {:.2f}); {} of {} were worse\n", name, area.at("area").get<double>(),
             area.at("low").get<double>(), area.at("high").get<double>(), area.at("worse").get<std::size_t>(),
             area.at("worse").get<std::size_t>() + area.at("not_worse").get<std::size_t>());
}

/// Every path, and how it compares with the best one without a simulated cut. @param of  heading of the first column.
void print_paths(const char* of, const nlohmann::ordered_json& result) {
  const nlohmann::ordered_json& best = result.at("best_without_simulation");
  fmt::print("{:<34} {:>8} {:>9} {:>6} {:>7} {:>8} {:>10}  {}\n", of, "mean, mm", "specimens", "worse", "harmed",
             "not cut", "margin<2.2", "difference from the best path without simulation, mm (95 %)");
  for (const auto& [name, path] : result.at("rivals").items()) {
    std::string against = best == name ? "best" : "";
    if (path.at("difference_mm").is_number()) against = fmt::format("{:+.2f}", path.at("difference_mm").get<double>());
    if (path.at("difference_mm").is_number() && path.at("compared") != path.at("pairs"))
      against += fmt::format(" of {}", path.at("compared").get<std::size_t>());
    against += interval_text(path.at("confidence_mm"));
    const std::string mean =
        path.at("mean_mm").is_number() ? fmt::format("{:.2f}", path.at("mean_mm").get<double>()) : "-";
    const auto count = [&path = path](const char* key) { return path.at(key).template get<std::size_t>(); };
    fmt::print("{:<34} {:>8} {:>9} {:>6} {:>7} {:>8} {:>10}  {}\n", name, mean, count("pairs"), count("worse"),
               count("harmed"), count("uncut"), fmt::format("{} of {}", count("close_margins"), count("closed")),
               against);
  }
  if (best.is_null())
    fmt::print(
        "no specimen has a closed ring along two paths without a simulated cut: no benefit of simulation can be "
        "claimed\n");
}

/// Prints the errors by number of photographs, without and with simulation. @param curve  empty: prints nothing.
void print_learning(const nlohmann::ordered_json& curve) {
  if (curve.empty()) return;
  fmt::print("{:<34} {:>10} {:>10} {:>9}  {}\n", "photographs", "without", "with", "specimens",
             "difference, mm (95 %)");
  for (const auto& point : curve) {
    const auto& pair = point.at("pair");
    if (!pair.at("difference_mm").is_number()) continue;
    fmt::print("{:<34} {:>10.2f} {:>10.2f} {:>9}  {:+.2f}{}\n",
               point.at("photographs").is_null() ? std::string("all") : point.at("photographs").dump(),
               pair.at("first_mm").get<double>(), pair.at("second_mm").get<double>(),
               pair.at("compared").get<std::size_t>(), pair.at("difference_mm").get<double>(),
               interval_text(pair.at("confidence_mm")));
  }
}

/// Prints how the advice compares with the outcomes. @param advice  null: prints nothing.
void print_advice(const nlohmann::ordered_json& advice) {
  if (!advice.is_object()) return;
  print_area("advice: area under the curve", advice.at("auc"));
  print_area("  for outside specimens only", advice.at("auc_outside_alone"));
  print_area("the same without the pull", advice.at("auc_without_pull"));
  for (const auto& interval : advice.at("intervals"))
    fmt::print("{:<34} {:.2f} ({:.2f} to {:.2f}), {} cuts\n",
               fmt::format("{:.0f} % interval, {}: covers", 100.0 * interval.at("level").get<double>(),
                           interval.at("of").get<std::string>()),
               interval.at("share").get<double>(), interval.at("low").get<double>(), interval.at("high").get<double>(),
               interval.at("cuts").get<std::size_t>());
}

void print_gain(const char* name, const nlohmann::ordered_json& summary) {
  if (summary.at("pairs").get<std::size_t>() == 0) {
    fmt::print("{:<34} no specimen was cut twice\n", name);
    return;
  }
  const auto worse = summary.at("worse").get<std::size_t>();
  const auto opened = summary.at("opened").get<std::size_t>();
  std::string said = worse == 0 ? "none worse" : fmt::format("{} worse", worse);
  if (worse > opened) said += fmt::format(", by at most {:.2f} mm", summary.at("most_worse_mm").get<double>());
  if (opened > 0) said += fmt::format(", {} of them with an open ring", opened);
  fmt::print("{:<34} {:.2f} -> {:.2f} mm ({:.0f} % less); cut twice: {}, {}\n", name,
             summary.at("mean_before_mm").get<double>(), summary.at("mean_after_mm").get<double>(),
             summary.at("gain_percent").get<double>(), summary.at("pairs").get<std::size_t>(), said);
}

}  // namespace

void print_experiment(const nlohmann::ordered_json& result) {
  fmt::print("VIRTUAL specimens, mean |error| of the photographs\n");
  print_gain("as planned -> corrected", result);
  if (result.at("uncorrected").get<std::size_t>() > 0 && result.at("pairs").get<std::size_t>() > 0) {
    fmt::print("{:<34} {:.0f} % less; {} cut only as planned\n", "  of all that were cut",
               result.at("gain_percent_of_all").get<double>(), result.at("uncorrected").get<std::size_t>());
  }
  print_paths("path", result);
  if (result.contains("unlike") && result.at("unlike").at("rivals").at("as_planned").at("pairs").get<std::size_t>() > 0)
    print_paths("specimens unlike the calibration's", result.at("unlike"));
  if (result.contains("known_physics") && result.at("known_physics").at("mean_after_mm").is_number()) {
    fmt::print("{:<34} {:.2f} mm ({} specimens, from the truth)\n", "physics known",
               result.at("known_physics").at("mean_after_mm").get<double>(),
               result.at("known_physics").at("specimens").get<std::size_t>());
  }
  print_learning(result.at("learning"));
  print_advice(result.at("advice"));
  for (const auto& one : result.at("left_out_of_calibration")) {
    fmt::print("{} (calibrate): left out of the fit: {}\n", one.at("name").get<std::string>(),
               one.at("reason").get<std::string>());
  }
  for (const auto& row : result.at("table_2")) {
    if (row.at("ended_at").is_null()) continue;
    fmt::print("{} ({}), {}: ended at {}\n", row.at("specimen").get<std::string>(), row.at("role").get<std::string>(),
               row.at("cut").get<std::string>(), row.at("ended_at").get<std::string>());
  }
  fmt::print("report: {}\n", result.at("report").get<std::string>());
}

void print_pooled(const nlohmann::ordered_json& result) {
  fmt::print("VIRTUAL specimens of {} series, mean |error| of the photographs\n", result.at("series").size());
  print_paths("path", result);
  print_paths("specimens unlike the calibration's", result.at("unlike"));
  print_paths("specimens like the calibration's", result.at("like"));
  const auto& robust = result.at("robust_against_default");
  if (robust.at("difference_mm").is_number()) {
    fmt::print("{:<34} {:+.2f} mm{} on {} specimens; close margins of {}: {} by default, {} robust\n",
               "robust, difference from default", robust.at("difference_mm").get<double>(),
               interval_text(robust.at("confidence_mm")), robust.at("compared").get<std::size_t>(),
               robust.at("closed").get<std::size_t>(), robust.at("close_margins_first").get<std::size_t>(),
               robust.at("close_margins_second").get<std::size_t>());
  }
  print_learning(result.at("learning"));
  if (const auto& advice = result.at("advice"); advice.is_object() && advice.at("intervals_by") == "specimens")
    fmt::print("advice (its intervals treat specimens as independent, but those of one series are not)\n");
  print_advice(result.at("advice"));
}

}  // namespace incise::cli
