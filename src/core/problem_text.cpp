#include <incise/core/problem_text.hpp>

#include <algorithm>
#include <cctype>

namespace incise {
namespace {

bool is_function_name(const std::string& word) {
  if (word.starts_with("operator")) return true;
  return !word.empty() &&
         std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
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

Complaint complaint_of(const std::string& sentence, const std::string& otherwise) {
  const std::string expected = "expected ", found = "found ", middle = ", " + expected, end = ", " + found;
  Complaint complaint;
  std::string rest = sentence;
  const std::size_t colon = std::min(sentence.find(": " + expected), sentence.find(": " + found));
  if (colon != std::string::npos && !sentence.starts_with(expected) && !sentence.starts_with(found)) {
    complaint.field = sentence.substr(0, colon);
    rest = sentence.substr(colon + 2);
  }
  if (rest.starts_with(expected)) {
    const std::size_t at = rest.rfind(end);
    complaint.expected = rest.substr(expected.size(), at == std::string::npos ? at : at - expected.size());
    complaint.found = at == std::string::npos ? "another value" : rest.substr(at + end.size());
  } else if (const std::size_t at = rest.find(middle); rest.starts_with(found) && at != std::string::npos) {
    complaint.found = rest.substr(found.size(), at - found.size());
    complaint.expected = rest.substr(at + middle.size());
  } else {
    complaint.found = rest;
    complaint.expected = otherwise;
  }
  return complaint;
}

DataError fault_of_file(const std::filesystem::path& file, const std::string& place, const InvalidArgument& problem,
                        const std::string& otherwise, const std::string& hint) {
  const Complaint complaint = complaint_of(without_function_name(problem), otherwise);
  return {file, complaint.field.empty() ? place : complaint.field, complaint.found, complaint.expected, hint};
}

}  // namespace incise
