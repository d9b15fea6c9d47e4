#include "replay_files.hpp"

#include <incise/core/described_json.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/report/replay_figure.hpp>

namespace incise::cli {
namespace {

bool is_in_cut(const ReplaySample& sample) {
  return sample.phase == ProgramPhase::Cut || sample.phase == ProgramPhase::Overlap;
}

}  // namespace

nlohmann::ordered_json audit_json(const ProgramAudit& audit, const ProgramHeader& header) {
  nlohmann::ordered_json json = to_json(audit);
  for (const char* key : {"verdict", "reason", "accepted", "override", "not_checked"}) {
    json[key] = nlohmann::ordered_json::array();
    for (const auto& [name, value] : header) {
      if (name == key) json[key].push_back(value);
    }
  }
  return json;
}

void write_replay_figure(const std::filesystem::path& folder, const Replay& replay) {
  ReplayPicture picture;
  for (const ReplaySample& s : replay.samples) {
    if (!is_in_cut(s)) continue;
    picture.tip_mm.push_back(s.tip_mm);
    picture.time_s.push_back(s.time_s);
    picture.tip_speed_mm_s.push_back(s.tip_speed_mm_s);
    picture.deviation_mm.push_back(s.deviation_mm);
  }
  if (picture.tip_mm.size() < 2) return;
  // The straight ways down and up are seen end on.
  if (replay.intended_mm.size() > 2)
    picture.intended_mm.assign(replay.intended_mm.begin() + 1, replay.intended_mm.end() - 1);
  write_atomically(folder / "replay.svg", replay_figure_svg(picture));
}

}  // namespace incise::cli
