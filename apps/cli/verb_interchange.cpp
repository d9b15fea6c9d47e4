#include "study_run.hpp"

#include <incise/core/error.hpp>
#include <incise/core/version.hpp>
#include <incise/interchange/interchange.hpp>
#include <incise/io/atomic_file.hpp>

#include <fmt/format.h>

#include <memory>

namespace incise::cli {
namespace {

/// The held specimen: on the case's own mesh, or on the one that its study makes of the CT.
std::shared_ptr<const TissueModel> specimen_of(const CaseFile& file, const std::filesystem::path& case_path,
                                               const CommonOptions& options, Monitor& monitor) {
  if (!file.inputs.specimen_mesh.empty()) {
    return std::make_shared<TissueModel>(tissue_of(file.settings, read_specimen_mesh(file, monitor)));
  }
  Workers workers(options.threads);
  CaseRun study(file, output_beside(case_path), {.until = Stage::Mesh}, options.context());
  return study.study(workers, monitor).model;
}

int export_case(const std::filesystem::path& case_path, const std::string& format, const CommonOptions& options) {
  Console console(options.level());
  const std::filesystem::path output = options.required_output("for_sofa");
  require_replaceable(output);
  const CaseFile file = read_case_with_inputs(case_path);
  refuse_input_as_output("-o", output, {file.file, file.inputs.specimen_mesh});
  const bool is_sofa = format == "sofa";
  const char* name = is_sofa ? "case.scn" : "case.feb";
  std::shared_ptr<const TissueModel> model;
  AtomicFolder target(output);
  try {
    model = specimen_of(file, case_path, options, console);
    const InterchangeCase specimen{
        *model, file.settings.gravity_mm_s2, file.settings.title,
        fmt::format("Written by incise {} ({}) from {}", version(), source_commit(), file.file.string())};
    (is_sofa ? write_sofa_scene : write_febio_input)(target.path() / name, specimen);
  } catch (const CaseError& error) {
    throw error.in_file(file.file.string());
  }
  const double wall_s = options.wall_s();
  RunFolder(file, target.path(), options.context()).write_manifest_to(target.path(), wall_s);
  target.commit();
  print_result(options, {{"format", format},
                         {"files", {(output / name).string()}},
                         {"vertices", model->mesh.vertices.size()},
                         {"tets", model->mesh.tets.size()},
                         {"wall_s", wall_s}});
  return kDone;
}

}  // namespace

void add_interchange(Application& application) {
  struct Arguments {
    std::filesystem::path case_path;
    std::string format;
  };
  auto [verb, a] =
      application.add_verb<Arguments>("interchange", "", "incise interchange specimen --format sofa -o for_sofa",
                                      [](const Arguments& arguments, const CommonOptions& options) {
                                        return export_case(arguments.case_path, arguments.format, options);
                                      });
  verb->add_option("case", a.case_path, "Case file, or a folder with case.yaml")->required();
  verb->add_option("--format", a.format, "sofa: case.scn; febio: case.feb")
      ->check(CLI::IsMember({"sofa", "febio"}))
      ->required();
}

}  // namespace incise::cli
