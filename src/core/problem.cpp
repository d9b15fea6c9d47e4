#include <incise/core/error.hpp>
#include <incise/core/problem.hpp>
#include <incise/core/utf8.hpp>

#include <fmt/format.h>

#include <cctype>

namespace incise {
namespace {

constexpr std::size_t kLongestFound = 1000;

/// Returns `found` in a form that can be shown: the contents of a file may be long, and not text.
std::string shown(const std::string& found) {
  std::string text;
  const bool is_text = !first_not_utf8(found);
  for (const char c : utf8_prefix(found, kLongestFound)) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7F || (byte > 0x7F && !is_text)) {
      text += fmt::format("\\x{:02x}", byte);
    } else {
      text += c;
    }
  }
  if (found.size() > kLongestFound) text += fmt::format("... ({} characters)", found.size());
  return text;
}

}  // namespace

std::string sentence(const Problem& problem) {
  std::string text = problem.path.empty() ? "" : problem.path + ": ";
  text += fmt::format("found {}, expected {}", shown(problem.found), problem.expected);
  if (!problem.hint.empty()) text += ". " + problem.hint;
  return text;
}

std::vector<std::string> sentences(std::span<const Problem> problems) {
  std::vector<std::string> all;
  for (const Problem& problem : problems) all.push_back(sentence(problem));
  return all;
}

std::string within_sentence(std::string text) {
  const auto is_upper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
  if (text.size() < 2 || is_upper(text[1])) return text;
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string system_reason(const std::error_code& error) {
  return within_sentence(error.message());
}

std::string system_reason(int number) {
  return system_reason(std::error_code(number, std::generic_category()));
}

void require_none(std::span<const Problem> problems, const char* function) {
  if (!problems.empty()) throw InvalidArgument(function, fmt::format("{}", fmt::join(sentences(problems), "; ")));
}

}  // namespace incise
