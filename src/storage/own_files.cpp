#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/specimen_id.hpp>
#include <incise/storage/own_files.hpp>

#include <nlohmann/json.hpp>

namespace incise {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_foreign(const fs::path& file, const char* found) {
  throw DataError(file, "", found, "a free name, or what an earlier run wrote",
                  "Move that file, or choose another place for the output");
}

void require_no_link(const fs::path& file) {
  if (fs::is_symlink(file)) refuse_foreign(file, "a link");
}

bool is_own_record(const fs::path& file) {
  if (!fs::exists(file)) return false;
  const nlohmann::ordered_json json = read_json(file);
  return json.is_object() && json.contains("case_file");
}

bool is_own_page(const fs::path& file) {
  return fs::exists(file) && read_text(file).find("name=\"generator\" content=\"incise\"") != std::string::npos;
}

}  // namespace

void require_own_files(const fs::path& output) {
  if (fs::weakly_canonical(output) == output.root_path())
    throw CaseError("command line", "-o", output.string(), "a folder other than the root of the file system");
  require_no_link(output.has_filename() ? output : output.parent_path());  // "a/" hides that a is a link
  for (const char* name : {"study.json", "manifest.json"}) require_no_link(output / name);
  const fs::path record = output / "study.json", manifest = output / "manifest.json";
  if (fs::exists(manifest) && !is_own_manifest(manifest)) refuse_foreign(manifest, "a file of another origin");
  if (fs::exists(record) && !is_own_record(record)) refuse_foreign(record, "a file of another origin");
  require_own_page(output / "report.html");
}

void require_own_page(const fs::path& page) {
  const fs::path figures = page.parent_path() / "figures";
  for (const fs::path& file : {page, figures}) require_no_link(file);
  if (fs::exists(page) && !is_own_page(page)) refuse_foreign(page, "a file of another origin");
  if (fs::exists(figures) && !is_own_page(page) && !is_own_record(page.parent_path() / "study.json"))
    refuse_foreign(figures, "a folder of another origin");
}

void require_own_manifest_beside(const fs::path& result) {
  const fs::path manifest = manifest_beside(result);
  require_no_link(manifest);
  if (fs::exists(manifest) && !is_own_manifest(manifest)) refuse_foreign(manifest, "a file of another origin");
}

void require_own_program(const fs::path& program) {
  require_no_link(program);
  if (!fs::is_regular_file(program)) return;
  const std::string text = read_text(program);  // a ROS bag is binary, but its header is text
  const bool is_own =
      text.find("# incise.made_by: ") != std::string::npos || text.find("\"incise.program/1\"") != std::string::npos;
  if (!is_own) refuse_foreign(program, "a file of another origin");
}

}  // namespace incise
