#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/written_json.hpp>
#include <incise/planning/eligibility.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/storage/run_folder.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kVerdicts = "verdicts";  // the cache's slot

/// The verdict of the cut along a product's path. A case that is changed and changed back finds it again.
struct KeptVerdict {
  std::string product;
  std::string path;  // as path_json
  Verdict verdict;
};
void describe(Visitor& v, KeptVerdict& k) {
  v("product", k.product, "Whose path it is.");
  v("path", k.path, "The path that was cut, as its file has it.");
  v("verdict", k.verdict, "On the cut.");
}

bool is_of_a_cut(const Verdict& verdict) {
  return !verdict.has("not_simulated");
}

/// One line per pass and waypoint.
void write_history(const std::filesystem::path& file, const ConvergedCompensation& iteration) {
  write_atomically(file, [&](std::ostream& out) {
    out << "pass,waypoint,offset_mm,error_mm,limited,interpolated\n";
    for (std::size_t k = 0; k < iteration.passes.size(); ++k) {
      const CompensationPass& pass = iteration.passes[k];
      for (std::size_t i = 0; i < pass.offset_mm.size(); ++i) {
        const bool is_measured = !pass.error_mm.empty();
        out << fmt::format("{},{},{},{},{},{}\n", k, i, pass.offset_mm[i],
                           is_measured ? fmt::format("{}", pass.error_mm[i]) : "", pass.is_limited[i],
                           is_measured ? pass.is_interpolated[i] : 1);
      }
    }
  });
}

/// One line per pass and measured point.
void write_point_errors(const std::filesystem::path& file, const ConvergedCompensation& iteration) {
  write_atomically(file, [&](std::ostream& out) {
    out << "pass,along_mm,signed_error_mm\n";
    for (std::size_t k = 0; k < iteration.passes.size(); ++k) {
      const CompensationPass& pass = iteration.passes[k];
      for (std::size_t i = 0; i < pass.along_mm.size(); ++i) {
        out << fmt::format("{},{},{}\n", k, pass.along_mm[i], pass.point_error_mm[i]);
      }
    }
  });
}

}  // namespace

void RunFolder::correction(const ProductNote& note, const Correction& correction) {
  write(note, [&](const std::filesystem::path& to) {
    write_tool_path(to / "path.json", with_specimen(correction.moves.path));
    write_contour_vtp(to / "path.vtp", entry_contour(correction.moves.path));
    write_json(to / "compensate.json", to_json(correction));
    if (!correction.iteration) return;
    write_history(to / "history.csv", *correction.iteration);
    write_point_errors(to / "errors.csv", *correction.iteration);
  });
}

Verdict RunFolder::advice_against(bool is_corrected) const {
  Verdict verdict;
  const std::filesystem::path file = root_ / "assessment" / "assess.json";
  if (!std::filesystem::exists(file)) return verdict;
  const Json json = read_json(file);
  const auto [advice, why] = from_written_json(file, [&json] {
    const bool has_reason = json.contains("reasons") && !json.at("reasons").empty();
    return std::pair(json.value("advice", std::string()),
                     has_reason ? ": " + json.at("reasons").front().get<std::string>() : std::string());
  });
  if (advice == to_string(Advice::Compensate) || (!is_corrected && advice == to_string(Advice::CutAsPlanned)))
    return verdict;
  verdict.add("eligibility", {}, fmt::format("assess advises {}{}", advice.empty() ? "nothing" : advice, why));
  return verdict;
}

void RunFolder::verdicts(const std::optional<Verdict>& of_planned, const std::optional<Verdict>& of_corrected) {
  const auto note = [this](const char* product, const std::optional<Verdict>& verdict, bool is_corrected) {
    const std::filesystem::path file = folder(product) / "path.json";
    if (!verdict || !std::filesystem::exists(file)) return;
    Verdict whole = *verdict;
    whole.add(advice_against(is_corrected));
    const Verdict stated = read_path_verdict(file);
    if (is_of_a_cut(stated) && !is_of_a_cut(whole)) return;
    if (to_json(stated) != to_json(whole)) write_tool_path(file, read_tool_path(file), whole);
  };
  if (!of_planned && !of_corrected) return restore_verdicts();
  note("plan", of_planned, false);
  note("correction", of_corrected, true);
  keep_verdicts();
}

void RunFolder::keep_verdicts() {
  std::vector<KeptVerdict> kept;
  for (const char* product : {"plan", "correction"}) {
    const std::filesystem::path file = folder(product) / "path.json";
    if (!std::filesystem::exists(file)) continue;
    const Verdict verdict = read_path_verdict(file);
    if (is_of_a_cut(verdict)) kept.push_back({product, path_json(read_tool_path(file)), verdict});
  }
  if (!kept.empty()) cache_.keep(kVerdicts, key_of_case(), kept);
}

void RunFolder::restore_verdicts() {
  Monitor quiet;
  const auto kept = cache_.find<std::vector<KeptVerdict>>(kVerdicts, key_of_case(), quiet);
  if (!kept) return;
  for (const KeptVerdict& known : *kept) {
    const std::filesystem::path file = folder(known.product) / "path.json";
    if (!std::filesystem::exists(file) || is_of_a_cut(read_path_verdict(file))) continue;
    const ToolPath path = read_tool_path(file);
    if (path_json(path) == known.path) write_tool_path(file, path, known.verdict);
  }
}

}  // namespace incise
