#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

namespace incise {
namespace {

constexpr std::size_t kLongestFound = 1000;

/// Fit to be shown: what a file holds may be long, and not text.
std::string shown(const std::string& found) {
  std::string text;
  for (const char c : found.substr(0, kLongestFound)) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7F) {
      text += fmt::format("\\x{:02x}", byte);
    } else {
      text += c;
    }
  }
  if (found.size() > kLongestFound) text += fmt::format("... ({} characters)", found.size());
  return text;
}

std::string compose(const std::string& where, const std::string& place, const std::string& found,
                    const std::string& expected, const std::string& hint) {
  std::string text = where;
  if (!place.empty()) text += fmt::format(": {}", place);
  text += fmt::format(": found {}, expected {}", shown(found), expected);
  if (!hint.empty()) text += fmt::format(". {}", hint);
  return text;
}

}  // namespace

CaseError::CaseError(std::string where, std::string field, std::string found, std::string expected, std::string hint)
    : Error(compose(where, field, found, expected, hint)), field_(std::move(field)) {}

std::size_t CaseError::end_of_place() const {
  // The message is "<where>: <field>: found …"; what stands before the field, or before "found" where there is none, is the place.
  return std::string_view(what()).find(field_.empty() ? ": found " : fmt::format(": {}: found ", field_));
}

std::string CaseError::without_place() const {
  return std::string(what()).substr(end_of_place() + 2);
}

CaseError CaseError::in_file(const std::string& file) const {
  const std::string text = what();
  const std::size_t end = end_of_place();
  const std::string where = text.substr(0, end);
  if (where.starts_with(file)) return *this;
  CaseError named = *this;
  static_cast<Error&>(named) = Error((where == "case" ? file : fmt::format("{}: {}", file, where)) + text.substr(end));
  return named;
}

DataError::DataError(const std::filesystem::path& path, std::string place, std::string found, std::string expected,
                     std::string hint)
    : Error(compose(path.string(), place, found, expected, hint)), path_(path) {}

namespace core_detail {

void throw_invalid_argument(const char* function, const std::string& message) {
  throw InvalidArgument(fmt::format("{}: {}", function, message));
}

void stop_on_broken_invariant(const char* file, int line, const char* condition) {
  fmt::print(stderr, "{}:{}: broken invariant: {}\n", file, line, condition);
  std::abort();
}

}  // namespace core_detail
}  // namespace incise
