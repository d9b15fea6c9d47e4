#include "io/json_reading.hpp"
#include "io/number_text.hpp"

#include <incise/core/error.hpp>
#include <incise/io/described_json.hpp>
#include <incise/io/json_text.hpp>
#include <incise/io/manifest.hpp>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <thread>

namespace incise {
namespace {

using io_detail::JsonValue;
using nlohmann::ordered_json;

ordered_json settings_of(const Manifest& manifest) {
  try {
    return parse_json(manifest.settings_json, "settings_json");
  } catch (const DataError& error) {
    throw InvalidArgument(fmt::format("write_manifest: {}", error.what()));
  }
}

std::uint64_t whole_number(const ordered_json& document, const JsonValue& root, const std::string& key) {
  const JsonValue place = root.at(key);
  if (!document[key].is_number_unsigned()) place.expected("an integer, 0 or more");
  return document[key].get<std::uint64_t>();
}

}  // namespace

namespace {

void write_to(const std::filesystem::path& file, const Manifest& manifest, const std::string& result_sha256 = {}) {
  INCISE_REQUIRE(std::isfinite(manifest.wall_s) && manifest.wall_s >= 0.0,
                 fmt::format("expected wall_s of 0 or more, found {}", manifest.wall_s));
  ordered_json inputs = ordered_json::array();
  for (const auto& input : manifest.inputs) inputs.push_back({{"path", input.path}, {"sha256", input.sha256}});
  ordered_json document;
  document["version"] = manifest.version;
  document["commit"] = manifest.commit;
  document["command"] = manifest.command;
  document["settings"] = settings_of(manifest);
  document["seed"] = manifest.seed;
  document["threads"] = manifest.threads;
  document["instruction_set"] = manifest.instruction_set;
  document["inputs"] = inputs;
  document["wall_s"] = manifest.wall_s;
  document["machine"] = manifest.machine;
  if (!manifest.specimen_id.empty()) document["specimen_id"] = manifest.specimen_id;
  if (!result_sha256.empty()) document["result_sha256"] = result_sha256;
  if (manifest.verdict) document["verdict"] = to_json(*manifest.verdict);
  write_json(file, document);
}

}  // namespace

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
  const JsonValue root(document, file);
  Manifest manifest;
  manifest.version = root.at("version").text();
  manifest.commit = root.at("commit").text();
  manifest.command = root.at("command").text();
  static_cast<void>(root.at("settings"));
  manifest.settings_json = document["settings"].dump();
  manifest.seed = whole_number(document, root, "seed");
  manifest.threads = static_cast<int>(whole_number(document, root, "threads"));
  manifest.instruction_set = root.at("instruction_set").text();
  for (const JsonValue& input : root.at("inputs").items()) {
    manifest.inputs.push_back({input.at("path").text(), input.at("sha256").text()});
  }
  manifest.wall_s = root.at("wall_s").number();
  manifest.machine = root.at("machine").text();
  if (const auto id = root.find("specimen_id")) manifest.specimen_id = id->text();
  if (root.find("verdict")) manifest.verdict = from_json<Verdict>(document["verdict"], file, "/verdict");
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
