#include <incise/core/error.hpp>
#include <incise/core/sha256.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/folder_lock.hpp>
#include <incise/storage/case_edit.hpp>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace incise {
namespace {

void emit(YAML::Emitter& out, const YAML::Node& node) {
  if (node.IsMap()) {
    out << YAML::BeginMap;
    for (const auto& entry : node) {
      out << YAML::Key << entry.first.Scalar() << YAML::Value;
      emit(out, entry.second);
    }
    out << YAML::EndMap;
  } else if (node.IsSequence()) {
    out << YAML::Flow << YAML::BeginSeq;
    for (const auto& item : node) emit(out, item);
    out << YAML::EndSeq;
  } else if (node.IsScalar()) {
    if (node.Tag() == "!") out << YAML::DoubleQuoted;  // it was quoted
    out << node.Scalar();
  } else {
    out << YAML::Null;
  }
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Returns the comments and blank lines at the start of the text.
std::string leading_comments(const std::string& text) {
  std::size_t end = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  while (end < text.size() && (text[end] == '#' || text[end] == '\n')) {
    const std::size_t line_end = text.find('\n', end);
    end = line_end == std::string::npos ? text.size() : line_end + 1;
  }
  return text.substr(0, end);
}

bool has_inner_comments(const std::string& text) {
  const std::string body = text.substr(leading_comments(text).size());
  for (std::size_t at = body.find('#'); at != std::string::npos; at = body.find('#', at + 1)) {
    if (at == 0 || body[at - 1] == ' ' || body[at - 1] == '\n' || body[at - 1] == '\t') return true;
  }
  return false;
}

std::filesystem::path free_name_beside(const std::filesystem::path& file) {
  std::filesystem::path name = file.string() + ".orig";
  for (int k = 2; std::filesystem::exists(std::filesystem::symlink_status(name)); ++k)
    name = fmt::format("{}.orig.{}", file.string(), k);
  return name;
}

void set(YAML::Node node, std::string_view key, const nlohmann::ordered_json& value, const std::string& whole_key) {
  if (node.IsDefined() && !node.IsMap() && !node.IsNull())
    throw CaseError("case", whole_key, "a key within a value", "a field of the case");
  const std::size_t dot = key.find('.');
  const std::string name(key.substr(0, dot));
  if (dot != std::string_view::npos) {
    if (!node[name].IsDefined() && value.is_null()) return;
    set(node[name], key.substr(dot + 1), value, whole_key);
    if (node[name].IsMap() && node[name].size() == 0) node.remove(name);
  } else if (value.is_null()) {
    node.remove(name);
  } else {
    node[name] = YAML::Load(value.dump());
  }
}

}  // namespace

StaleRevision::StaleRevision(const std::filesystem::path& file)
    : CaseError(file.string(), "revision", "a file that was changed in the meantime", "the file as it was shown",
                "Look at the case again") {}

std::string case_revision(const std::filesystem::path& file) {
  return sha256_of_text(read_text(file));
}

std::string changed_case(const std::string& text, const CaseChanges& changes) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw DataError("case", fmt::format("line {}", error.mark.line + 1), error.msg, "YAML or JSON");
  }
  for (const auto& [key, value] : changes) set(root, key, value, key);
  YAML::Emitter out;
  emit(out, root);
  return leading_comments(text) + out.c_str() + "\n";
}

CaseFile change_case(const std::filesystem::path& file, const std::string& revision, const CaseChanges& changes) {
  const FolderLock nobody_else(std::filesystem::absolute(file).parent_path());
  CaseFile before = read_case(file);  // also checks size and nesting
  const std::string old = read_text(file);
  if (sha256_of_text(old) != revision) throw StaleRevision(file);
  const std::string text = changed_case(old, changes);
  if (text == old) return before;
  CaseFile changed = parse_case(text, file);
  const auto permissions = std::filesystem::status(file).permissions();
  const auto write = [&](const std::filesystem::path& to, const std::string& content) {
    write_atomically(to, content);
    std::filesystem::permissions(to, permissions);
  };
  if (has_inner_comments(old)) write(free_name_beside(file), old);
  write(file, text);
  return changed;
}

}  // namespace incise
