#include "replay_files.hpp"

#include <incise/core/units.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/table_io.hpp>
#include <incise/report/replay_figure.hpp>

#include <algorithm>

namespace incise::cli {
namespace {

bool is_in_cut(const ReplaySample& sample) {
  return sample.phase == ProgramPhase::Cut || sample.phase == ProgramPhase::Overlap;
}

}  // namespace

nlohmann::ordered_json to_json(const Replay& replay, const PlayerSettings& settings) {
  nlohmann::ordered_json json;
  json["outcome"] = to_string(replay.outcome);
  if (replay.outcome != ReplayOutcome::Completed) {
    json["line"] = replay.line > 0 ? nlohmann::ordered_json(replay.line) : nlohmann::ordered_json(nullptr);
    if (!replay.reason.empty()) json["reason"] = replay.reason;
  }
  json["speed_slider_percent"] = 100.0 * settings.speed_slider;
  json["duration_s"] = replay.duration_s();
  const bool is_known = !replay.intended_mm.empty();
  json["max_deviation_mm"] =
      is_known ? nlohmann::ordered_json(replay.max_deviation_mm) : nlohmann::ordered_json(nullptr);
  json["max_deviation_at_s"] =
      is_known ? nlohmann::ordered_json(replay.max_deviation_at_s) : nlohmann::ordered_json(nullptr);
  json["mean_deviation_mm"] =
      is_known ? nlohmann::ordered_json(replay.mean_deviation_mm) : nlohmann::ordered_json(nullptr);
  json["max_cut_deviation_mm"] =
      is_known ? nlohmann::ordered_json(replay.max_cut_deviation_mm) : nlohmann::ordered_json(nullptr);
  json["allowed_deviation_mm"] = settings.max_deviation_mm;
  json["tip_speed_mm_s"] = {
      {"mean", replay.tip_speed_mm_s.mean}, {"min", replay.tip_speed_mm_s.min}, {"max", replay.tip_speed_mm_s.max}};
  json["end_zone_mm"] = settings.end_zone_mm;
  json["max_joint_speed_share"] = replay.max_joint_speed_share;
  json["min_singular_value"] = replay.min_singular_value;
  return json;
}

nlohmann::ordered_json to_json(const ProgramAudit& audit, const ProgramHeader& header) {
  nlohmann::ordered_json json;
  json["checked"] = audit.is_checked();
  json["digest_matches"] = audit.digest == ProgramDigest::Absent
                               ? nlohmann::ordered_json(nullptr)
                               : nlohmann::ordered_json(audit.digest == ProgramDigest::Matches);
  json["contradictions"] = audit.contradictions;
  json["recomputed"] = audit.recomputed;
  json["not_recomputed"] = audit.not_recomputed;
  json["moved_limits"] = audit.moved_limits;
  for (const char* key : {"verdict", "reason", "accepted", "override", "not_checked"}) {
    json[key] = nlohmann::ordered_json::array();
    for (const auto& [name, value] : header) {
      if (name == key) json[key].push_back(value);
    }
  }
  return json;
}

void write_replay(const std::filesystem::path& folder, const Replay& replay) {
  std::vector<NamedColumn> columns{{"time_s", {}},   {"tip_x_mm", {}},       {"tip_y_mm", {}},
                                   {"tip_z_mm", {}}, {"tip_speed_mm_s", {}}, {"deviation_mm", {}}};
  for (const std::string& name : ur10e().joint_names) columns.push_back({name + "_rad", {}});
  ReplayPicture picture;
  for (const ReplaySample& s : replay.samples) {
    const double row[] = {s.time_s, s.tip_mm.x(), s.tip_mm.y(), s.tip_mm.z(), s.tip_speed_mm_s, s.deviation_mm};
    for (std::size_t i = 0; i < 6; ++i) {
      columns[i].second.push_back(row[i]);
      columns[6 + i].second.push_back(s.q_rad[static_cast<int>(i)]);
    }
    if (!is_in_cut(s)) continue;
    picture.tip_mm.push_back(s.tip_mm);
    picture.time_s.push_back(s.time_s);
    picture.tip_speed_mm_s.push_back(s.tip_speed_mm_s);
    picture.deviation_mm.push_back(s.deviation_mm);
  }
  write_csv_columns(folder / "true_path.csv", columns);
  if (picture.tip_mm.size() < 2) return;
  // The straight ways down and up are seen end on.
  if (replay.intended_mm.size() > 2)
    picture.intended_mm.assign(replay.intended_mm.begin() + 1, replay.intended_mm.end() - 1);
  const std::string svg = replay_figure_svg(picture);
  write_atomically(folder / "replay.svg", svg);
}

}  // namespace incise::cli
