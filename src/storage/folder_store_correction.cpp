#include "product_reading.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/verdict_json.hpp>
#include <incise/io/written_json.hpp>
#include <incise/planning/eligibility.hpp>
#include <incise/storage/folder_store.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kPasses{Product::Pass1, Product::Pass2, Product::Pass3, Product::Pass4,
                             Product::Pass5, Product::Pass6, Product::Pass7};

std::optional<double> number_or_nothing(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

CompensationPass pass_from(const Json& json, const std::filesystem::path& file) {
  CompensationPass pass;
  pass.offset_mm = json.at("offset_mm").get<std::vector<double>>();
  pass.error_mm = json.at("error_mm").get<std::vector<double>>();
  pass.is_limited = json.at("is_limited").get<std::vector<std::uint8_t>>();
  pass.is_interpolated = json.at("is_interpolated").get<std::vector<std::uint8_t>>();
  pass.mean_abs_error_mm = number_or_nothing(json.at("mean_abs_error_mm"));
  pass.max_abs_error_mm = number_or_nothing(json.at("max_abs_error_mm"));
  pass.smooth_error_mm = number_or_nothing(json.at("smooth_error_mm"));
  pass.lag_mm = json.at("lag_mm");
  pass.max_move_mm = json.at("max_move_mm");
  pass.shortfall_mm = json.at("shortfall_mm");
  pass.open_layers = json.at("open_layers");
  const auto name = json.at("verdict").get<std::string>();
  const std::optional<VerdictStatus> verdict = parse_verdict_status(name);
  if (!verdict) throw DataError(file, "history.verdict", fmt::format("'{}'", name), "ok, caution or refused");
  pass.verdict = *verdict;
  pass.is_success = json.at("success");
  return pass;
}

/// The points at which each pass was measured are in errors.csv only: no stage reads them again.
ConvergedCompensation iteration_from(const Json& json, const ToolPath& path, const std::filesystem::path& file) {
  ConvergedCompensation iteration;
  iteration.path = path;
  for (const Json& pass : json.at("history")) iteration.passes.push_back(pass_from(pass, file));
  iteration.best = json.at("best_pass");
  if (iteration.best >= iteration.passes.size()) {
    throw DataError(file, "best_pass", fmt::format("{}", iteration.best),
                    fmt::format("one of {} passes", iteration.passes.size()));
  }
  const auto name = json.at("compensation_outcome").get<std::string>();
  const std::optional<CompensationOutcome> outcome = parse_compensation_outcome(name);
  if (!outcome)
    throw DataError(file, "compensation_outcome", fmt::format("'{}'", name),
                    "the name of an outcome of the compensation");
  iteration.outcome = *outcome;
  iteration.contraction = number_or_nothing(json.at("contraction"));
  return iteration;
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

std::optional<Correction> FolderStore::load_correction() {
  if (!is_current(Product::Correction)) return std::nullopt;
  return of_earlier_run(folder(Product::Correction), [&]() -> std::optional<Correction> {
    const std::filesystem::path file = folder(Product::Correction) / "compensate.json";
    const Json json = read_json(file);
    Correction correction;
    correction.method = json.at("method") == to_string(CompensationMethod::Paper) ? CompensationMethod::Paper
                                                                                  : CompensationMethod::Default;
    Compensation& moves = correction.moves;
    require_path_unchanged(folder(Product::Correction) / "path.json");
    require_unchanged(Product::Correction);
    moves.path = read_tool_path(folder(Product::Correction) / "path.json");
    moves.error_mm = json.at("error_mm").get<std::vector<double>>();
    moves.move_mm = json.at("move_mm").get<std::vector<double>>();
    moves.max_move_mm = json.at("max_move_mm");
    moves.limited_waypoints = json.at("limited_waypoints");
    moves.interpolated_waypoints = json.at("interpolated_waypoints");
    correction.floor_mm = number_or_nothing(json.at("floor_mm"));
    if (json.contains("history")) correction.iteration = iteration_from(json, moves.path, file);
    return correction;
  });
}

void FolderStore::save_correction(const Correction& correction, double wall_s) {
  save(Product::Correction, wall_s, [&](const std::filesystem::path& to) {
    write_tool_path(to / "path.json", with_specimen(correction.moves.path));
    write_contour_vtp(to / "path.vtp", entry_contour(correction.moves.path));
    write_json(to / "compensate.json", to_json(correction));
    if (!correction.iteration) return;
    write_history(to / "history.csv", *correction.iteration);
    write_point_errors(to / "errors.csv", *correction.iteration);
  });
}

bool FolderStore::adopt_cut(CutRole from) {
  const Product product = product_of(from);
  for (const Product pass : kPasses) require_replaceable(folder(pass));
  if (!is_current(Product::Corrected)) {
    if (!is_current(product)) return false;
    const std::filesystem::path source = folder(product);
    const double wall_s = of_earlier_run(source, [&] {
      require_unchanged(product);
      return read_json(source / "stage.json").at("wall_s").get<double>();
    });
    save(Product::Corrected, wall_s, [&](const std::filesystem::path& to) {
      for (const auto& entry : std::filesystem::directory_iterator(source)) {
        if (entry.path().filename() == "manifest.json" || entry.path().filename() == "stage.json") continue;
        std::filesystem::copy(entry.path(), to / entry.path().filename(), std::filesystem::copy_options::recursive);
      }
    });
  }
  remove_passes();
  return true;
}

void FolderStore::add_advice_to(Verdict& verdict, bool is_corrected) const {
  const std::filesystem::path file = root_ / "assessment" / "assess.json";
  if (!std::filesystem::exists(file)) return;
  const Json json = read_json(file);
  const auto [advice, why] = from_written_json(file, [&json] {
    const bool has_reason = json.contains("reasons") && !json.at("reasons").empty();
    return std::pair(json.value("advice", std::string()),
                     has_reason ? ": " + json.at("reasons").front().get<std::string>() : std::string());
  });
  if (advice == to_string(Advice::Compensate) || (!is_corrected && advice == to_string(Advice::CutAsPlanned))) return;
  verdict.add("eligibility", {}, fmt::format("assess advises {}{}", advice.empty() ? "nothing" : advice, why));
}

void FolderStore::save_verdicts(const std::optional<Verdict>& of_planned, const std::optional<Verdict>& of_corrected) {
  const auto note = [this](Product product, const std::optional<Verdict>& verdict) {
    const std::filesystem::path file = folder(product) / "path.json";
    if (!verdict || !is_current(product)) return;
    Verdict whole = *verdict;
    add_advice_to(whole, product == Product::Correction);
    if (to_json(read_path_verdict(file)) == to_json(whole)) return;
    write_tool_path(file, read_tool_path(file), whole);
  };
  note(Product::Plan, of_planned);
  note(Product::Correction, of_corrected);
}

void FolderStore::remove_passes() {
  for (const Product pass : kPasses) require_replaceable(folder(pass));
  for (const Product pass : kPasses) remove_replaceable(folder(pass));
}

}  // namespace incise
