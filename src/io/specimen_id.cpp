#include "io/number_text.hpp"

#include <incise/core/error.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/specimen_id.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace incise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestId = 64;
constexpr std::size_t kDigits = 12;          // of the digest, in an id made from the data
constexpr std::size_t kHeaderBytes = 65536;  // searched for the id at the start of a file
constexpr const char* kKey = "specimen_id";

std::string checked(const std::string& id, const fs::path& file) {
  if (id.empty() || is_specimen_id(id)) return id;
  throw DataError(file, kKey, fmt::format("'{}'", id.substr(0, kLongestId)), std::string(kSpecimenIdForm));
}

std::string id_in_json(const fs::path& file) {
  const nlohmann::ordered_json document = read_json(file);
  if (!document.is_object() || !document.contains(kKey)) return "";
  if (!document.at(kKey).is_string()) throw DataError(file, kKey, document.at(kKey).dump(), "text");
  return checked(document.at(kKey).get<std::string>(), file);
}

/// Returns the id after `mark` in the file's first lines; empty if there is none.
std::string id_in_header(const fs::path& file, std::string_view mark) {
  const std::string text = beginning_of(file, kHeaderBytes);
  const std::size_t place = text.find(mark);
  if (place == std::string::npos || place >= text.find("end_header")) return "";
  const std::size_t begin = place + mark.size();
  return checked(text.substr(begin, text.find_first_of("\r\n", begin) - begin), file);
}

/// Returns a manifest of incise; null for a manifest.json of another program, or one that cannot be read.
nlohmann::ordered_json manifest_or_nothing(const fs::path& file) {
  try {
    nlohmann::ordered_json document = read_json(file);
    if (document.is_object() && document.contains("version") && document.contains("commit") &&
        document.contains("instruction_set"))
      return document;
  } catch (const DataError&) {
  }
  return nullptr;
}

bool lists(const fs::path& manifest, const std::string& name) {
  const nlohmann::ordered_json document = manifest_or_nothing(manifest);
  if (document.is_null() || !document.contains("files") || !document.at("files").is_array()) return false;
  const auto& files = document.at("files");
  return std::any_of(files.begin(), files.end(), [&name](const auto& entry) {
    return entry.is_string() && entry.template get<std::string>() == name;
  });
}

std::string id_in_manifest(const fs::path& file) {
  if (const fs::path beside = manifest_beside(file); fs::exists(beside)) {
    const nlohmann::ordered_json document = read_json(beside);
    // The manifest belongs to another file that had this name, so nothing states this file's id.
    if (document.is_object() && document.contains("result_sha256") &&
        document.at("result_sha256") != sha256_of_file(file))
      return "";
    return id_in_json(beside);
  }
  // The file lies in a result's folder, or in a folder within it (frames/…).
  fs::path name = file.filename();
  fs::path folder = file.parent_path();
  for (int level = 0; level < 2; ++level) {
    const fs::path manifest = folder / "manifest.json";
    if (fs::exists(manifest)) return lists(manifest, name.string()) ? id_in_json(manifest) : "";
    name = folder.filename() / name;
    folder = folder.parent_path();
  }
  return "";
}

}  // namespace

bool is_own_manifest(const fs::path& file) {
  return !manifest_or_nothing(file).is_null();
}

bool is_specimen_id(std::string_view text) {
  const auto may_stand = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
           c == '-';
  };
  return !text.empty() && text.size() <= kLongestId && text.front() != '-' &&
         std::all_of(text.begin(), text.end(), may_stand);
}

std::string specimen_id_of_scan(std::string_view sha256) {
  return fmt::format("ct-{}", sha256.substr(0, kDigits));
}

std::string specimen_id_of_mesh(std::string_view sha256) {
  return fmt::format("mesh-{}", sha256.substr(0, kDigits));
}

std::string specimen_id_of(const fs::path& path) {
  if (path.empty() || !fs::exists(path)) return "";
  if (fs::is_directory(path))
    return !manifest_or_nothing(path / "manifest.json").is_null() ? id_in_json(path / "manifest.json") : "";
  if (!fs::is_regular_file(path)) return "";
  const std::string ending = io_detail::lower_case(path.extension().string());
  std::string id;
  if (ending == ".json") id = id_in_json(path);
  if (ending == ".ply") id = id_in_header(path, "comment incise.specimen_id ");
  if (ending == ".script") id = id_in_header(path, "specimen_id: ");
  return id.empty() ? id_in_manifest(path) : id;
}

bool are_of_different_specimens(std::string_view one, std::string_view other) {
  if (one.empty() || other.empty() || one == other) return false;
  const auto is_scan_and_mesh = [](std::string_view a, std::string_view b) {
    return a.starts_with("ct-") && b.starts_with("mesh-");
  };
  return !is_scan_and_mesh(one, other) && !is_scan_and_mesh(other, one);
}

void require_same_specimen(const fs::path& file, std::string_view id, std::string_view whose) {
  const std::string found = specimen_id_of(file);
  if (!are_of_different_specimens(found, id)) return;
  throw DataError(file, kKey, found, fmt::format("{} specimen, {}", whose, id),
                  "Two scans of one specimen get one specimen_id in their cases");
}

std::string common_specimen_id(std::span<const fs::path> files) {
  std::string id;
  fs::path first;
  for (const fs::path& file : files) {
    const std::string found = specimen_id_of(file);
    if (found.empty()) continue;
    require_same_specimen(file, id, fmt::format("{}'s", first.string()));
    if (id.empty()) id = found, first = file;
  }
  return id;
}

}  // namespace incise
