#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/storage/case_run.hpp>
#include <incise/storage/own_files.hpp>
#include <incise/storage/run_files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>

namespace incise {
namespace {

/// Locks the output folder; refuses one that holds files from elsewhere under incise's names. Returns `file`, which
/// lets the constructor lock before it makes the RunFolder.
CaseFile with_folder_locked(CaseFile file, const std::filesystem::path& output, std::optional<FolderLock>& lock) {
  require_own_files(output);
  lock.emplace(output);
  return file;
}

/// Writes into study.json which case the products are of, for `incise report`.
void note_case(const std::filesystem::path& file, const std::filesystem::path& output) {
  const auto relative = std::filesystem::absolute(file).lexically_proximate(std::filesystem::absolute(output));
  const std::filesystem::path record = output / "study.json";
  if (std::filesystem::exists(record)) {
    const nlohmann::ordered_json older = read_json(record);
    if (older.is_object() && older.contains("case_file") && older.at("case_file") == relative.string()) return;
  }
  write_json(record, {{"case_file", relative.string()}});
}

}  // namespace

CaseFile read_case_with_inputs(const std::filesystem::path& file_or_folder) {
  CaseFile file = read_case(file_or_folder);
  require_input_files(file);
  return file;
}

std::filesystem::path output_beside(const std::filesystem::path& file_or_folder) {
  return (std::filesystem::is_directory(file_or_folder) ? file_or_folder : file_or_folder.parent_path()) / "out";
}

CaseRun::CaseRun(CaseFile file, const std::filesystem::path& output, const RunOptions& options,
                 const RunContext& context)
    : is_new_folder(!std::filesystem::exists(output)),
      folder(with_folder_locked(std::move(file), output, lock_), output, context),
      options_(options) {
  note_case(folder.case_file().file, output);
}

template <class Work>
auto CaseRun::guarded(Monitor& monitor, const Work& work) -> decltype(work()) {
  const CaseFile& file = folder.case_file();
  try {
    if (options_.until >= Stage::Plan || file.inputs.specimen_mesh.empty()) require_plan_inputs(file);
    if (options_.until >= Stage::Verify) require_place_for_arm(file.settings);
    folder.remove_what_is_out_of_date(options_.until, monitor);
    return work();
  } catch (const CaseError& error) {
    remove_if_nothing_was_made();
    throw error.in_file(file.file.string());
  } catch (const CutInterrupted& error) {
    throw StagesKept(error.what(),
                     fmt::format("its checkpoint {} is kept", folder.cache().place_of(error.slot()).string()));
  } catch (const Cancelled& error) {
    remove_if_nothing_was_made();
    if (folder.has_products()) throw StagesKept(error.what());
    throw;
  } catch (...) {
    remove_if_nothing_was_made();
    throw;
  }
}

Study CaseRun::study(Workers& workers, Monitor& monitor) {
  return guarded(monitor, [&] {
    return run_study(folder.case_file().settings, folder, folder.cache(), options_, workers, monitor, folder);
  });
}

Run CaseRun::run(std::span<const std::string> accepted, Workers& workers, Monitor& monitor) {
  return guarded(monitor, [&] {
    try {
      return incise::run(folder.case_file().settings, folder, folder.cache(), options_, accepted, workers, monitor,
                         folder);
    } catch (const Cancelled&) {
      throw;
    } catch (...) {  // an earlier program does not belong to a run that failed
      remove_replaceable(folder.root() / "program");
      throw;
    }
  });
}

void CaseRun::remove_if_nothing_was_made() const {
  std::error_code ignored;
  if (!is_new_folder) return;
  for (const auto& entry : std::filesystem::directory_iterator(folder.root(), ignored)) {
    if (entry.path().filename() != "study.json") return;
  }
  std::filesystem::remove(folder.root() / "study.json", ignored);
  std::filesystem::remove(folder.root(), ignored);
}

Run run_case(const std::filesystem::path& case_path, const std::filesystem::path& output,
             std::span<const std::string> accepted) {
  const auto start = std::chrono::steady_clock::now();
  Workers all(0);
  Monitor quiet;
  CaseRun of(read_case_with_inputs(case_path), output, {}, {"incise::run_case", 1, all.thread_count()});
  Run run = of.run(accepted, all, quiet);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  (void)write_run(of.folder, run, wall.count());
  return run;
}

}  // namespace incise
