#include "storage/json_values.hpp"
#include "storage/kept_record.hpp"

#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/io/manifest.hpp>
#include <incise/storage/bench_files.hpp>
#include <incise/storage/power_file.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

namespace incise {
namespace {

constexpr const char* kCutSchema = "incise.power_cut/1";

nlohmann::ordered_json kept_cut_json(const PowerCut& cut) {
  nlohmann::ordered_json json;
  json["virtual"] = true;
  json["power_w"] = cut.power_w;
  json["speed_mm_s"] = cut.speed_mm_s;
  json["outcome"] = to_string(cut.outcome);
  json["problem"] = cut.problem;
  json["bulge_mm"] = or_null(cut.bulge_mm);
  json["thermal_width_mm"] = or_null(cut.thermal_width_mm);
  json["mean_abs_error_mm"] = or_null(cut.mean_abs_error_mm);
  return json;
}

std::optional<double> measure_in(const JsonPlace& file, const char* key, bool is_needed) {
  const std::optional<double> value = file.number_or_null(key);
  if ((is_needed && !value) || (value && *value < 0.0))
    file.refuse(key, value ? fmt::format("{}", *value) : "null", "a number of at least 0");
  return value;
}

PowerCut cut_from(const JsonPlace& file) {
  PowerCut cut;
  cut.outcome = read_outcome(file.object, "outcome", file.path);
  cut.problem = file.text("problem");
  const bool is_closed = cut.outcome == Outcome::Success;
  cut.bulge_mm = measure_in(file, "bulge_mm", is_closed);
  cut.thermal_width_mm = measure_in(file, "thermal_width_mm", is_closed);
  cut.mean_abs_error_mm = measure_in(file, "mean_abs_error_mm", is_closed);
  return cut;
}

}  // namespace

PowerCutFolder::PowerCutFolder(std::filesystem::path folder, const BenchResolution& resolution)
    : folder_(std::move(folder)), resolution_(resolution) {}

std::string PowerCutFolder::key_of(const PowerSubject& subject, double power_w, double speed_mm_s) const {
  return sha256_of_text(fmt::format("{} {} {} {} fine={} coarse={} way={} power={} speed={} {}", kCutSchema, version(),
                                    source_commit(), to_string(active_isa()), resolution_.fine_mm,
                                    resolution_.coarse_mm, resolution_.way_mm, power_w, speed_mm_s,
                                    to_json(subject.specimen).dump()));
}

std::filesystem::path PowerCutFolder::file_of(const PowerSubject& subject, double power_w, double speed_mm_s) const {
  return KeptRecord(folder_, kCutSchema, key_of(subject, power_w, speed_mm_s)).file();
}

std::optional<PowerCut> PowerCutFolder::load(const PowerSubject& subject, double power_w, double speed_mm_s,
                                             Monitor& monitor) {
  std::optional<PowerCut> cut = KeptRecord(folder_, kCutSchema, key_of(subject, power_w, speed_mm_s))
                                    .load(monitor, "The cut is made anew", cut_from);
  if (!cut) return std::nullopt;
  cut->specimen = subject.name;
  cut->power_w = power_w;
  cut->speed_mm_s = speed_mm_s;
  return cut;
}

void PowerCutFolder::save(const PowerSubject& subject, const PowerCut& cut) {
  KeptRecord(folder_, kCutSchema, key_of(subject, cut.power_w, cut.speed_mm_s)).save(kept_cut_json(cut));
}

}  // namespace incise
