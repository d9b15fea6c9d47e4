#include <incise/core/problem_text.hpp>

#include <algorithm>
#include <cctype>

namespace incise {
namespace {

bool is_function_name(const std::string& word) {
  if (word.starts_with("operator")) return true;
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

}  // namespace

std::string without_function_name(const InvalidArgument& problem) {
  const std::string text = problem.what();
  const std::size_t colon = text.find(": ");
  if (colon == std::string::npos || !is_function_name(text.substr(0, colon))) return text;
  return text.substr(colon + 2);
}

std::string as_sentence(const InvalidArgument& problem) {
  std::string text = without_function_name(problem);
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace incise
