#include "laboratory/experiment_steps.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/io/input_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <set>

namespace incise::laboratory {

/// Writes warnings to a file; the experiment is asked whether to stop.
class ExperimentSteps::LogFile : public Monitor {
 public:
  LogFile(const std::filesystem::path& file, const Monitor& outer) : out_(file, std::ios::app), outer_(outer) {}
  void message(Severity severity, std::string_view text) override {
    if (severity == Severity::Warning) out_ << "warning: " << text << std::endl;
  }
  [[nodiscard]] bool is_cancelled() const override { return outer_.is_cancelled(); }
  void refused(const std::string& why) { out_ << why << std::endl; }

 private:
  std::ofstream out_;
  const Monitor& outer_;
};

namespace {

using Json = nlohmann::ordered_json;

/// What the cache keeps of a step.
struct KeptAnswer {
  bool is_acceptable = true;
  std::string result;                 ///< JSON text
  std::vector<std::string> products;  ///< digest of each
};
void describe(Visitor& v, KeptAnswer& k) {
  v("acceptable", k.is_acceptable, "Whether the experiment can continue with the result.");
  v("result", k.result, "Result of the step, as JSON.");
  v("products", k.products, "Digest of each file and folder that the step made.");
}

/// More than one step of an experiment writes.
constexpr std::size_t kRoomBytes = std::size_t{32} << 20U;

/// What a step left, by content. Empty where one is missing.
std::vector<std::string> products_of(const ExperimentStep& step) {
  std::vector<std::string> digests;
  for (const std::filesystem::path& path : step.products) {
    if (!std::filesystem::exists(path)) return {};
    digests.push_back(sha256_of_input(path));
  }
  return digests;
}

/// What decides the outcome of a step.
CacheKey key_of(const ExperimentStep& step) {
  CacheKey key(step.name);
  for (const std::string& word : step.arguments) key.add_text(word);
  for (const std::filesystem::path& path : step.inputs) key.add_text(path.string()).add_text(sha256_of_input(path));
  return key;
}

/// Files that this step left here before, damaged since: a step leaves alone what it does not know as incise's.
void remove_own_products(const ExperimentStep& step) {
  for (const std::filesystem::path& product : step.products) {
    if (std::filesystem::is_regular_file(std::filesystem::symlink_status(product))) std::filesystem::remove(product);
  }
}

/// A step cannot tell a reading that it cannot use from a disk that is full; the experiment has to. A step that failed
/// has given back what it wrote, so that there has to be room for all that it writes, wherever it writes.
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

/// A command as a shell would be given it.
std::string shell_line(const std::vector<std::string>& arguments) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("-_./,=:+", c) != nullptr;
  };
  std::string line;
  for (const std::string& word : arguments) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

/// The last line of why a step could not be done.
std::string end_of(std::string text) {
  constexpr std::size_t kMostCharacters = 600;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::size_t line = text.rfind('\n');
  if (line != std::string::npos) text = text.substr(line + 1);
  return text.size() > kMostCharacters ? text.substr(text.size() - kMostCharacters) : text;
}

}  // namespace

std::string refusal_of(const std::string& step, const StepAnswer& answer) {
  std::string text = step + ": not acceptable";
  const nlohmann::json& result = answer.result;
  if (!result.is_object()) return text;
  if (const auto outcome = result.find("outcome"); outcome != result.end() && outcome->is_string())
    text += ": " + outcome->get<std::string>();
  std::vector<std::string> why;
  if (const auto reasons = result.find("reasons"); reasons != result.end() && reasons->is_array()) {
    for (const nlohmann::json& reason : *reasons)
      why.push_back(reason.is_string() ? reason.get<std::string>() : reason.dump());
  }
  // Of a program that the verdict refused, its worst reason.
  if (const nlohmann::json worst = result.value("/verdict/reasons/0/id"_json_pointer, nlohmann::json());
      worst.is_string())
    why.push_back(
        fmt::format("{}: {}", result.at("/verdict/status"_json_pointer).get<std::string>(), worst.get<std::string>()));
  return why.empty() ? text : fmt::format("{} ({})", text, fmt::join(why, "; "));
}

ExperimentSteps::ExperimentSteps(std::filesystem::path folder, Workers& workers, const Monitor& monitor)
    : folder_(std::move(folder)),
      workers_(workers),
      outer_(monitor),
      cache_(std::make_unique<EntryFolder>(folder_ / "cache")) {
  make_folder(folder_);
}

StepAnswer ExperimentSteps::run(const ExperimentStep& step) {
  throw_if_cancelled(outer_, "the experiment");
  lines_.push_back("incise " + shell_line(step.arguments));
  const CacheKey key = key_of(step);
  LogFile log(folder_ / "log.txt", outer_);  // a damaged answer is reported there, and the step is run again
  const auto is_whole = [&step](const KeptAnswer& kept) {
    return Json::accept(kept.result) && kept.products.size() == step.products.size() &&
           kept.products == products_of(step);
  };
  if (const auto kept = cache_.find<KeptAnswer>(step.name, key, log, is_whole))
    return {kept->is_acceptable ? StepEnd::Done : StepEnd::NotAcceptable, Json::parse(kept->result)};
  if (cache_.holds(step.name)) remove_own_products(step);
  cache_.remove(step.name);
  const StepAnswer answer = made_now(step, log);
  ++computed_;
  if (answer.end == StepEnd::Unusable) return answer;
  const KeptAnswer kept{answer.end == StepEnd::Done, answer.result.dump(), products_of(step)};
  cache_.keep(step.name, key, kept);
  return {answer.end, Json::parse(kept.result)};
}

StepAnswer ExperimentSteps::made_now(const ExperimentStep& step, LogFile& log) {
  const auto unusable = [&](const std::string& why) {
    log.refused("incise: " + why);
    require_room(step, folder_);
    return StepAnswer{StepEnd::Unusable, {{"outcome", end_of("incise: " + why)}}};
  };
  try {
    const steps::StepResult made = step.work({{lines_.back(), 1, workers_.thread_count()}, workers_, log});
    return {made.is_acceptable ? StepEnd::Done : StepEnd::NotAcceptable, made.json};
  } catch (const CaseError& error) {  // ends this specimen, not the experiment
    return unusable(error.what());
  } catch (const DataError& error) {
    return unusable(error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return unusable(DataError(error.path1(), "", system_reason(error.code()), "a path that can be used").what());
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& error) {  // a fault of the program: the experiment ends, and says where
    log.refused(fmt::format("incise: {}: {}", step.name, error.what()));
    throw DataError(folder_ / "log.txt", step.name, error.what(), "a step that completes");
  }
}

}  // namespace incise::laboratory
