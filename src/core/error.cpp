#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <cctype>
#include <cstdio>
#include <cstdlib>

namespace incise {

InvalidArgument::InvalidArgument(std::string_view function, std::string text)
    : Error(fmt::format("{}: {}", function, text)), text_(std::move(text)) {}

std::string InvalidArgument::as_hint() const {
  std::string hint = text_;
  if (!hint.empty()) hint[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(hint[0])));
  return hint;
}

CaseError::CaseError(std::string where, Problem problem)
    : Error(fmt::format("{}: {}", where, sentence(problem))), where_(std::move(where)), problem_(std::move(problem)) {}

CaseError::CaseError(std::string where, std::string field, std::string found, std::string expected, std::string hint)
    : CaseError(std::move(where), Problem{std::move(field), std::move(found), std::move(expected), std::move(hint)}) {}

CaseError CaseError::in_file(const std::string& file) const {
  if (where_.starts_with(file)) return *this;
  return {where_ == "case" ? file : fmt::format("{}: {}", file, where_), problem_};
}

DataError::DataError(const std::filesystem::path& path, const Problem& problem)
    : Error(fmt::format("{}: {}", path.string(), sentence(problem))), path_(path) {}

DataError::DataError(const std::filesystem::path& path, std::string place, std::string found, std::string expected,
                     std::string hint)
    : DataError(path, Problem{std::move(place), std::move(found), std::move(expected), std::move(hint)}) {}

DataError::DataError(const std::filesystem::path& path, const std::string& place, const InvalidArgument& broken)
    : Error(fmt::format("{}: {}{}{}", path.string(), place, place.empty() ? "" : ": ", broken.text())), path_(path) {}

namespace core_detail {

void throw_invalid_argument(const char* function, const std::string& message) {
  throw InvalidArgument(function, message);
}

void stop_on_broken_invariant(const char* file, int line, const char* condition) {
  fmt::print(stderr, "{}:{}: broken invariant: {}\n", file, line, condition);
  std::abort();
}

}  // namespace core_detail
}  // namespace incise
