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

#include <map>
#include <string>
#include <string_view>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kVerdicts = "verdicts";  // the cache's slot
constexpr const char* kPlan = "plan";
constexpr const char* kCorrection = "correction";

/// The verdict on the cut along a product's path. If a case is changed and changed back, a run finds it again.
struct KeptVerdict {
  std::string path;  // text of path_json
  Verdict verdict;
};
void describe(Visitor& v, KeptVerdict& k) {
  v("path", k.path, "The path that was cut, as text of its file.");
  v("verdict", k.verdict, "Verdict on the cut.");
}

bool is_of_a_cut(const Verdict& verdict) {
  return !verdict.has("not_simulated");
}

/// Returns a verdict with the refusals of another one added.
Verdict with_refusals_of(const Verdict& other, Verdict verdict) {
  for (const VerdictReason& reason : other.reasons()) {
    if (reason.severity == VerdictStatus::Refused && !verdict.has(reason.id)) verdict.add(reason);
  }
  return verdict;
}

/// Writes one row per pass and waypoint.
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

/// Writes one row per pass and measured point.
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
  Monitor quiet;
  const CacheKey key = key_of_case();
  auto kept = cache_.find<std::map<std::string, KeptVerdict>>(kVerdicts, key, quiet)
                  .value_or(std::map<std::string, KeptVerdict>());
  bool is_new = false;
  const auto note = [&](const char* product, const std::optional<Verdict>& verdict) {
    const std::filesystem::path file = folder(product) / "path.json";
    if (!std::filesystem::exists(file)) return;
    const std::string path = path_json(read_tool_path(file));
    if (verdict && is_of_a_cut(*verdict)) {
      kept[product] = {path, *verdict};
      is_new = true;
    }
    Verdict whole = read_path_verdict(file);
    const auto known = kept.find(product);
    if (known != kept.end() && known->second.path == path) whole = known->second.verdict;
    if (verdict && !is_of_a_cut(*verdict))
      whole = is_of_a_cut(whole) ? with_refusals_of(*verdict, whole) : with_refusals_of(whole, *verdict);
    if (is_of_a_cut(whole) && !whole.has("eligibility"))
      whole.add(advice_against(product == std::string_view(kCorrection)));
    if (to_json(read_path_verdict(file)) != to_json(whole)) write_tool_path(file, read_tool_path(file), whole);
  };
  note(kPlan, of_planned);
  note(kCorrection, of_corrected);
  if (is_new) cache_.keep(kVerdicts, key, kept);
}

}  // namespace incise
