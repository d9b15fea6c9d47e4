#include "io/number_text.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <thread>

namespace incise {
namespace {

using nlohmann::ordered_json;

void write_to(const std::filesystem::path& file, const Manifest& manifest, const std::string& result_sha256 = {}) {
  INCISE_REQUIRE(std::isfinite(manifest.wall_s) && manifest.wall_s >= 0.0,
                 fmt::format("expected wall_s of 0 or more, found {}", manifest.wall_s));
  ordered_json document = to_json(manifest);
  try {
    document["settings"] = parse_json(manifest.settings_json, "settings_json");
  } catch (const DataError& error) {
    throw InvalidArgument(fmt::format("write_manifest: {}", error.what()));
  }
  if (!result_sha256.empty()) document["result_sha256"] = result_sha256;
  write_json(file, document);
}

}  // namespace

void describe(Visitor& v, Manifest& m) {
  v("version", m.version, "Version of incise.");
  v("commit", m.commit, "Commit of the sources.");
  v("command", m.command, "The command line.");
  v.derived("settings", std::optional<std::string>(), "Settings in full, defaults included: a JSON object.");
  v.bulk("settings_json", m.settings_json, "Settings as JSON text.");
  v("seed", m.seed, "Seed of all that is random.");
  v("threads", m.threads, "Number of threads.", kNotNegative);
  v("instruction_set", m.instruction_set, "Instruction set of the vectorised kernels.");
  v("inputs", m.inputs, "Files and folders from which the result was made.");
  v({"wall_s", "Wall time of the work.", "s"}, m.wall_s, kNotNegative);
  v("machine", m.machine, "Processor, cores and compiler.");
  const Field specimen{.name = "specimen_id", .meaning = "Specimen of the folder's files.", .is_omitted = true};
  if (v.optional(specimen, !m.specimen_id.empty())) v(specimen, m.specimen_id);
  v({.name = "verdict", .meaning = "Verdict of the run that filled the folder.", .is_omitted = true}, m.verdict);
}

void write_manifest(const std::filesystem::path& folder, const Manifest& manifest) {
  write_to(folder / "manifest.json", manifest);
}

std::filesystem::path manifest_beside(const std::filesystem::path& file) {
  std::filesystem::path beside = file;
  return beside += ".manifest.json";
}

void write_manifest_beside(const std::filesystem::path& file, const Manifest& manifest) {
  write_to(manifest_beside(file), manifest, sha256_of_file(file));
}

Manifest read_manifest(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "manifest.json";
  const ordered_json document = read_json(file);
  auto manifest = from_json<Manifest>(document, file);
  const auto settings = document.find("settings");
  if (settings == document.end()) throw DataError(file, "/settings", "no such key", "an object");
  manifest.settings_json = settings->dump();
  return manifest;
}

std::string machine_description() {
  std::string processor = "unknown processor";
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      processor = io_detail::trimmed(std::string_view(line).substr(colon + 1));
      break;
    }
  }
#if defined(__clang__)
  const std::string compiler = fmt::format("clang++ {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  const std::string compiler = fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
  return fmt::format("{}, {} logical cores, {}", processor, std::thread::hardware_concurrency(), compiler);
}

}  // namespace incise
