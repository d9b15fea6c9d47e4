#include "study_steps.hpp"

#include "options.hpp"

#include <incise/core/error.hpp>
#include <incise/core/version.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <set>

namespace incise::cli {
namespace {

using StepJson = nlohmann::ordered_json;

/// More than one step of an experiment writes.
constexpr std::size_t kRoomBytes = std::size_t{32} << 20U;

std::string content_of(const std::filesystem::path& path) {
  return std::filesystem::is_directory(path) ? sha256_of_folder(path) : sha256_of_input(path);
}

/// What decides the outcome of a step.
StepJson identity_of(const ExperimentStep& step) {
  StepJson json;
  // A version and a commit are not enough: what is built from changed files has the same.
  static const std::string executable = sha256_of_file("/proc/self/exe");
  json["build"] = fmt::format("{} ({}) {}", version(), source_commit(), executable);
  json["arguments"] = step.arguments;
  StepJson& inputs = json["inputs"] = StepJson::object();
  for (const std::filesystem::path& path : step.inputs) {
    inputs[path.string()] = content_of(path);
  }
  return json;
}

/// What a step left, by content. Null where one is missing.
StepJson products_of(const ExperimentStep& step) {
  StepJson json = StepJson::object();
  for (const std::filesystem::path& path : step.products) {
    if (!std::filesystem::exists(path)) return nullptr;
    json[path.string()] = content_of(path);
  }
  return json;
}

/// Of the step, what it left, and how it ended; with a sum, as what it printed is believed later on.
StepJson record_json(const StepJson& identity, const StepJson& products, const StepRecord& record) {
  StepJson json{{"identity", identity}, {"products", products}, {"status", record.status}, {"result", record.result}, {"wall_s", record.wall_s}};
  json["sha256"] = sha256_of_text(json.dump());
  return json;
}

/// The record of an earlier run, if it is of the same step and nothing that the step left has changed since.
std::optional<StepRecord> kept_record(const std::filesystem::path& file, const ExperimentStep& step, const StepJson& identity) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    const StepJson older = StepJson::parse(read_text(file));
    if (older.at("identity") != identity) return std::nullopt;
    if (const StepJson products = products_of(step); products.is_null() || older.at("products") != products) return std::nullopt;
    StepRecord record{older.at("status").get<int>(), older.at("result"), older.at("wall_s").get<double>(), true};
    if (record_json(identity, older.at("products"), record) != older) return std::nullopt;
    return record;
  } catch (const StepJson::exception&) {
    return std::nullopt;  // damaged, or of another version: the step is run again, and its record takes the place of this one
  }
}

/// Files that a recorded run of the step left here, damaged since: a verb leaves alone what it does not know as
/// incise's.
void remove_own_products(const std::filesystem::path& record, const ExperimentStep& step) {
  if (!std::filesystem::exists(record)) return;
  for (const std::filesystem::path& product : step.products) {
    if (std::filesystem::is_regular_file(std::filesystem::symlink_status(product))) std::filesystem::remove(product);
  }
}

/// A step cannot tell a reading that it cannot use from a disk that is full; the experiment has to. A step that failed has
/// given back what it wrote, so that there has to be room for all that it writes, wherever it writes.
void require_room(const ExperimentStep& step, const std::filesystem::path& folder) {
  std::set<std::filesystem::path> folders{folder};
  for (const std::filesystem::path& product : step.products) {
    if (std::filesystem::is_directory(product.parent_path())) folders.insert(product.parent_path());
  }
  const std::string probe(kRoomBytes, ' ');
  for (const std::filesystem::path& one : folders) {
    const std::filesystem::path file = one / "room";
    write_atomically(file, [&probe](std::ostream& out) { out << probe; });
    std::filesystem::remove(file);
  }
}

/// The last lines that a failed command wrote.
std::string end_of(const std::filesystem::path& log) {
  constexpr std::size_t kMostCharacters = 600;
  std::string text = read_text(log);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t line = text.rfind('\n');
  text = line == std::string::npos ? text : text.substr(line + 1);
  return text.size() > kMostCharacters ? text.substr(text.size() - kMostCharacters) : text;
}

}  // namespace

std::string refusal_of(const std::string& step, const StepRecord& record) {
  std::string why;
  for (const char* key : {"outcome", "reasons"}) {
    if (record.result.is_object() && record.result.contains(key)) why += " " + record.result.at(key).dump();
  }
  // Of a program that the verdict refused, its worst reason.
  const nlohmann::json worst = record.result.is_object() ? record.result.value("/verdict/reasons/0/id"_json_pointer, nlohmann::json()) : nlohmann::json();
  if (worst.is_string()) why += fmt::format(" ({}: {})", record.result.at("/verdict/status"_json_pointer).get<std::string>(), worst.get<std::string>());
  return fmt::format("{}: not acceptable{}", step, why);
}

StepRunner::StepRunner(std::filesystem::path folder, int threads, const Monitor& monitor)
    : folder_(std::move(folder)), log_(folder_ / "log.txt"), threads_(threads), monitor_(monitor) {
  std::error_code error;
  std::filesystem::create_directories(folder_ / "steps", error);
  if (error) throw DataError(folder_, "", error.message(), "a folder that can be made");
}

StepRecord StepRunner::run(const ExperimentStep& step) {
  lines_.push_back("incise " + shell_line(step.arguments));
  const std::filesystem::path file = folder_ / "steps" / (step.name + ".json");
  const StepJson identity = identity_of(step);
  StepRecord record;
  if (std::optional<StepRecord> kept = kept_record(file, step, identity)) return std::move(*kept);
  remove_own_products(file, step);
  std::filesystem::remove(file);
  OwnProcess process{step.arguments, folder_ / "steps" / (step.name + ".out"), log_};
  for (const std::string& word : {std::string("--json"), std::string("--quiet"), std::string("--threads"), std::to_string(threads_)})
    process.arguments.push_back(word);
  const auto start = std::chrono::steady_clock::now();
  record.status = run_process(process, monitor_);
  record.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (record.status == kBadData || record.status == kBadCase) {  // a reading or a case that cannot be used ends this specimen, not the experiment
    require_room(step, folder_);
    record.result = {{"outcome", end_of(log_)}};
    return record;
  }
  if (record.status != kDone && record.status != kNotAcceptable) {
    throw DataError(log_, step.name, fmt::format("`{}` ended with status {}: {}", lines_.back(), record.status, end_of(log_)),
                    "status 0, 2, 3 or 4");
  }
  const std::string printed = read_text(process.output);
  if (!printed.empty()) record.result = StepJson::parse(printed);
  std::filesystem::remove(process.output);
  write_json(file, record_json(identity, products_of(step), record));
  return record;
}

}  // namespace incise::cli
