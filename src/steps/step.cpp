#include <incise/core/error.hpp>
#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/steps/step.hpp>

#include <fmt/format.h>

namespace incise::steps {
namespace {

/// Returns the specimen id that the inputs state; empty if none does, or if they state different ones.
std::string id_that_all_state(const std::vector<std::filesystem::path>& inputs) {
  std::string id;
  for (const std::filesystem::path& path : inputs) {
    const std::string found = specimen_id_of(path);
    if (are_of_different_specimens(id, found)) return "";
    if (!found.empty()) id = found;
  }
  return id;
}

}  // namespace

Manifest manifest_of(const RunContext& run, std::string settings_json, const std::vector<std::filesystem::path>& inputs,
                     double wall_s) {
  Manifest manifest;
  manifest.version = version();
  manifest.commit = source_commit();
  manifest.command = run.command;
  manifest.settings_json = std::move(settings_json);
  manifest.seed = run.seed;
  manifest.threads = run.threads;
  manifest.instruction_set = to_string(active_isa());
  for (const std::filesystem::path& path : inputs) {
    if (path.empty()) continue;
    manifest.inputs.push_back({path.string(), sha256_of_input(path)});
  }
  manifest.specimen_id = id_that_all_state(inputs);
  manifest.wall_s = wall_s;
  manifest.machine = machine_description();
  return manifest;
}

void make_parent(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  const auto parent = std::filesystem::absolute(folder).parent_path();
  std::error_code error;
  std::filesystem::create_directories(parent, error);
  if (error) throw DataError(folder, "", system_reason(error), "a folder that can be made");
  require_replaceable(folder);
}

void report_reasons(const Verdict& verdict, Monitor& monitor) {
  for (const VerdictReason& reason : verdict.reasons()) {
    monitor.message(Severity::Warning,
                    fmt::format("{}: {}: {}", to_string(reason.severity), reason.id, reason.message));
  }
}

}  // namespace incise::steps
