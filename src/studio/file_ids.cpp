#include <incise/core/error.hpp>
#include <incise/core/sha256.hpp>
#include <incise/studio/file_ids.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>

namespace incise::studio {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kMostEntries = 5000;

bool ends_with_any(const std::string& name, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return name.ends_with(ending); });
}

std::string kind_by_name(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (name.ends_with(".seg.nrrd")) return "labels";
  if (ends_with_any(name, {".nrrd", ".nhdr", ".nii", ".nii.gz", ".mha", ".mhd"})) return "scan";
  if (ends_with_any(name, {".vtu", ".msh", ".ele"})) return "mesh";
  if (ends_with_any(name, {".mrk.json", ".csv"})) return "contour";
  if (ends_with_any(name, {".stl", ".ply", ".vtp", ".obj"})) return "surface";
  if (ends_with_any(name, {".png", ".jpg", ".jpeg", ".tif", ".tiff"})) return "picture";
  if (ends_with_any(name, {".yaml", ".yml"})) return "case";
  return "other";
}

/// Whether a folder may be a scan: its first file is a DICOM file or a PNG picture.
bool looks_like_slices(const fs::path& folder) {
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (!entry->is_regular_file(failed)) continue;
    std::array<char, 132> start{};
    std::ifstream(entry->path(), std::ios::binary).read(start.data(), start.size());
    return std::string_view(start.data() + 128, 4) == "DICM" || std::string_view(start.data() + 1, 3) == "PNG";
  }
  return false;
}

std::string kind_of(const fs::path& path, bool is_folder) {
  if (!is_folder) return kind_by_name(path.filename().string());
  std::error_code failed;
  if (fs::is_regular_file(path / "case.yaml", failed)) return "case";
  return looks_like_slices(path) ? "scan" : "folder";
}

std::optional<fs::path> canonical_of(const fs::path& path) {
  std::error_code failed;
  fs::path canonical = fs::canonical(path, failed);
  return failed ? std::nullopt : std::optional(canonical);
}

/// Returns the name as valid JSON text: bytes that are not UTF-8 would end the answer.
std::string shown(const fs::path& name) {
  return Json::parse(Json(name.string()).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

}  // namespace

FileIds::FileIds(const std::vector<fs::path>& roots, std::string salt) : salt_(std::move(salt)) {
  INCISE_REQUIRE(!roots.empty(), "expected a root");
  for (const fs::path& root : roots) {
    const std::optional<fs::path> canonical = canonical_of(root);
    if (!canonical || !fs::is_directory(*canonical)) throw DataError(root, "", "no such folder", "a folder to work in");
    roots_.push_back(*canonical);
  }
}

bool FileIds::is_within(const fs::path& canonical) const {
  return std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& root) {
    return std::mismatch(root.begin(), root.end(), canonical.begin(), canonical.end()).first == root.end();
  });
}

std::string FileIds::note(const fs::path& canonical) {
  std::string id = sha256_of_text(salt_ + canonical.string()).substr(0, 32);
  paths_[id] = canonical;
  return id;
}

std::string FileIds::id_of(const fs::path& path) {
  const std::optional<fs::path> canonical = canonical_of(path);
  if (!canonical) throw DataError(path, "", "no such file or folder", "one that exists");
  if (!is_within(*canonical))
    throw DataError(path, "", "a place outside the folders of the studio", "a place in one of them",
                    "Start the studio with --root FOLDER to add a folder");
  return note(*canonical);
}

fs::path FileIds::path_of(const std::string& id, const std::string& field) const {
  const auto found = paths_.find(id);
  if (found == paths_.end()) throw CaseError("request", field, "an unknown file", "a file of the studio's list");
  const std::optional<fs::path> now = canonical_of(found->second);
  if (!now) throw DataError(found->second, "", "no such file or folder any more", "one that exists");
  if (*now != found->second || !is_within(*now))
    throw DataError(found->second, "", "a link that now leads elsewhere", "the file or folder that was listed");
  return *now;
}

Json FileIds::list(const std::string& id) {
  const fs::path folder = id.empty() ? roots_.front() : path_of(id, "folder");
  if (!fs::is_directory(folder)) throw CaseError("request", "folder", "a file", "a folder");
  std::error_code failed;
  fs::directory_iterator entries(folder, failed);
  if (failed) throw DataError(folder, "", system_reason(failed), "a folder that can be read");

  std::vector<std::pair<bool, fs::path>> found;  // whether it is no folder, and its name
  for (; !failed && entries != fs::directory_iterator(); entries.increment(failed)) {
    const fs::path name = entries->path().filename();
    std::error_code ignored;
    if (!name.string().starts_with('.')) found.emplace_back(!entries->is_directory(ignored), name);
  }
  std::sort(found.begin(), found.end());
  Json listed = Json::array();
  std::size_t left_out = 0;
  for (const auto& [is_file, name] : found) {
    const std::optional<fs::path> canonical = canonical_of(folder / name);
    if (!canonical || !is_within(*canonical)) continue;
    if (listed.size() == kMostEntries) {
      ++left_out;
      continue;
    }
    std::error_code ignored;
    const auto bytes = is_file ? fs::file_size(*canonical, ignored) : 0;
    listed.push_back({{"id", note(*canonical)},
                      {"name", shown(name)},
                      {"kind", kind_of(*canonical, !is_file)},
                      {"bytes", ignored ? 0 : bytes}});
  }
  Json roots = Json::array();
  for (const fs::path& root : roots_) roots.push_back({{"id", note(root)}, {"name", shown(root)}});
  const bool is_root = std::find(roots_.begin(), roots_.end(), folder) != roots_.end();
  const fs::path parent = folder.parent_path();
  Json answer{{"folder", {{"id", note(folder)}, {"name", shown(folder)}}}, {"roots", std::move(roots)}};
  answer["up"] = !is_root && is_within(parent) ? Json(note(parent)) : Json(nullptr);
  answer["entries"] = std::move(listed);
  answer["left_out"] = left_out;
  return answer;
}

}  // namespace incise::studio
