#include "calibration_output.hpp"
#include "kept_output.hpp"
#include "option_checks.hpp"
#include "options.hpp"
#include "registration_trust.hpp"
#include "study_run.hpp"

#include <incise/core/error.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/storage/calibration_file.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/registration_json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <set>

namespace incise::cli {
namespace {

struct CalibrateArguments {
  std::vector<std::filesystem::path> cases;
  std::vector<std::filesystem::path> observed;
  std::vector<double> forces_n;
  std::vector<std::filesystem::path> registrations;
  std::string method = "fit";
  CalibrationRequest request;
};

/// One entry for each case, or none where that is allowed.
void require_one_each(const char* option, std::size_t found, std::size_t cases, const char* what) {
  if (found == cases) return;
  throw CaseError("command line", option, fmt::format("{} for {} {}", found, cases, cases == 1 ? "case" : "cases"),
                  fmt::format("one {} for each case, in the same order", what));
}

/// @throws DataError for one that found no transform, or does not say how well it fits.
RegistrationQuality registration_of(const std::filesystem::path& file, Monitor& monitor) {
  const RegistrationRecord record = read_registration(file);
  if (!record.T_target_source) throw DataError(file, "T_target_source", "null", "a registration that was found");
  if (!record.rmse_mm || !(*record.rmse_mm > 0.0)) {
    throw DataError(file, "rmse_mm", record.rmse_mm ? fmt::format("{}", *record.rmse_mm) : "no number",
                    "how far the surfaces lie apart, above 0, as `incise register` writes it");
  }
  tell(verdict_of(record, file), monitor);
  return {*record.rmse_mm, record.scale};
}

/// Names tell specimens apart in the table: files of one name get their number.
void make_names_differ(std::vector<CalibrationSubject>& subjects) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    std::string& name = subjects[i].photographed.name;
    if (!seen.insert(name).second) name = fmt::format("{} ({})", name, i + 1);
  }
}

/// Everything that can be looked at before anything is written or computed.
std::vector<CaseFile> read_inputs(const CalibrateArguments& arguments, std::vector<CalibrationSubject>& subjects,
                                  Monitor& monitor) {
  require_one_each("--observed", arguments.observed.size(), arguments.cases.size(), "evaluation");
  if (!arguments.forces_n.empty()) {
    require_one_each("--stretch-force-n", arguments.forces_n.size(), arguments.cases.size(), "force");
  }
  if (!arguments.registrations.empty()) {
    require_one_each("--registration", arguments.registrations.size(), arguments.cases.size(), "registration");
  }
  std::vector<CaseFile> files;
  for (std::size_t i = 0; i < arguments.cases.size(); ++i) {
    files.push_back(read_case_with_inputs(arguments.cases[i]));
    require_plan_inputs(files.back());
    CalibrationSubject subject;
    subject.photographed = read_photographed_cut(arguments.observed[i]);
    if (!arguments.forces_n.empty()) subject.photographed.stretch_force_n = arguments.forces_n[i];
    if (!arguments.registrations.empty()) subject.registration = registration_of(arguments.registrations[i], monitor);
    subject.photograph_file = arguments.observed[i].string();
    subject.case_file = files.back().file.string();
    subject.settings = files.back().settings;
    subjects.push_back(std::move(subject));
  }
  make_names_differ(subjects);
  return files;
}

/// A value that is given twice would be one row of the grid twice.
void require_different_values(const char* option, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto twice = std::adjacent_find(values.begin(), values.end());
  if (twice != values.end())
    throw CaseError("command line", option, fmt::format("{} twice", *twice), "every value once");
}

int calibrate_cases(CalibrateArguments arguments, const CommonOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Console console(options.level());
  arguments.request.method = value_named<CalibrationMethod>(arguments.method);
  require_valid(validate(arguments.request));
  require_different_values("--speeds-mm-s", arguments.request.speeds_mm_s);
  require_different_values("--dullnesses", arguments.request.dullnesses);
  require_different_values("--drag-lengths-mm", arguments.request.drag_lengths_mm);
  require_different_values("--second-drag-lengths-mm", arguments.request.second_drag_lengths_mm);
  const std::filesystem::path output = options.required_output("calibration");
  std::vector<CalibrationSubject> subjects;
  const std::vector<CaseFile> files = read_inputs(arguments, subjects, console);
  OlderOutput older(output / "calibration.json", console);
  std::vector<std::unique_ptr<RunFolder>> folders;
  std::vector<std::string> specimen_ids;
  Workers workers(options.threads);
  return with_parts_kept(output, [&] {
    for (std::size_t i = 0; i < files.size(); ++i) {
      const std::filesystem::path folder = output / "specimens" / std::to_string(i + 1);
      folders.push_back(std::make_unique<RunFolder>(files[i], folder, options.context()));
      subjects[i].inputs = folders.back().get();
      subjects[i].cache = &folders.back()->cache();
      subjects[i].sink = folders.back().get();
      specimen_ids.push_back(folders.back()->specimen_id());
      require_same_specimen(arguments.observed[i], specimen_ids.back(), "its case's");
      if (!arguments.registrations.empty())
        require_same_specimen(arguments.registrations[i], specimen_ids.back(), "its case's");
    }
    Cache runs(std::make_unique<EntryFolder>(output / "cache"));
    const Calibration calibration = calibrate(subjects, arguments.request, runs, workers, console);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    std::vector<std::filesystem::path> inputs = arguments.observed;
    inputs.insert(inputs.end(), arguments.registrations.begin(), arguments.registrations.end());
    for (const CaseFile& file : files) inputs.push_back(file.file);
    write_calibration(output, calibration, files, specimen_ids, inputs, options, wall.count());
    older.replaced();
    print_calibration(options, calibration, output, wall.count());
    return is_usable(calibration) ? kDone : kNotAcceptable;
  });
}

}  // namespace

void add_calibrate(Application& application) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* verb = application.add_verb(
      "calibrate",
      "Find the simulated speed and dullness with which cuts come out as the photographed ones. fit: the signed error "
      "round the "
      "ring, few simulations, a posterior, and what the data can tell apart. paper: 25 pairs, scored as in the paper. "
      "Interrupted, it keeps every finished simulation, and the same command goes on",
      "incise calibrate s1 s2 --observed s1/cut.json s2/cut.json -o calibration",
      [arguments](const CommonOptions& options) { return calibrate_cases(*arguments, options); });
  verb->add_option("case", arguments->cases,
                   "Case files, or folders with case.yaml: how each specimen was held, and its path")
      ->required();
  verb->add_option("--observed", arguments->observed,
                   "Files of `incise evaluate PHOTO -o`, one for each case in the same order; up in the picture is "
                   "+y of the case (seen along -z)")
      ->required();
  verb->add_option("--method", arguments->method, "fit or paper")->check(CLI::IsMember({"fit", "paper"}));
  verb->add_option("--stretch-force-n", arguments->forces_n,
                   "Measured pull of each specimen at its stretch: makes its stiffness known to 5 %")
      ->check(above_zero("--stretch-force-n"));
  verb->add_option("--registration", arguments->registrations,
                   "Files of `incise register`, one for each case: kept, so that `incise assess` can tell how a "
                   "further specimen compares");
  verb->add_option("--speeds-mm-s", arguments->request.speeds_mm_s, "Of the paper's grid")
      ->check(above_zero("--speeds-mm-s"));
  verb->add_option("--dullnesses", arguments->request.dullnesses, "Of the paper's grid")
      ->check(above_zero("--dullnesses"));
  verb->add_option("--drag-lengths-mm", arguments->request.drag_lengths_mm, "Speed x dwell of the fit's simulations")
      ->check(above_zero("--drag-lengths-mm"));
  verb->add_option("--second-drag-lengths-mm", arguments->request.second_drag_lengths_mm,
                   "Those of them that are also simulated with the second stiffness")
      ->check(above_zero("--second-drag-lengths-mm"));
}

}  // namespace incise::cli
