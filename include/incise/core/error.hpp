#pragma once

#include <incise/core/problem.hpp>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace incise {

/// Base of every exception that this library throws on purpose.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A caller broke a precondition of a function: a mistake in code. The message says what was expected and found.
class InvalidArgument : public Error {
 public:
  explicit InvalidArgument(std::string text) : Error(text), text_(std::move(text)) {}
  InvalidArgument(std::string_view function, std::string text);
  /// Returns what was expected and found, without the function's name: for the person whose file or case is at fault.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Returns the same with its first letter capitalised: for the hint of another error.
  [[nodiscard]] std::string as_hint() const;

 private:
  std::string text_;
};

/// The command line or a case file requests something that cannot be done (exit status 2 of the command).
/// The message reads "<where>: <field>: found <found>, expected <expected>. <hint>".
class CaseError : public Error {
 public:
  CaseError(std::string where, Problem problem);
  CaseError(std::string where, std::string field, std::string found, std::string expected, std::string hint = "");
  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] const std::string& field() const { return problem_.path; }
  /// Returns the same error with the case file named, for throwers that did not know it. `file` replaces the place
  /// "case" and precedes any other place; an error that names `file` already stays unchanged.
  [[nodiscard]] CaseError in_file(const std::string& file) const;

 private:
  std::string where_;
  Problem problem_;
};

/// A data file is missing, damaged or unsuitable, or an output cannot be written (exit status 3 of the command).
/// The message reads "<path>: <place>: found <found>, expected <expected>. <hint>"; `place` is a line, byte or field.
class DataError : public Error {
 public:
  DataError(const std::filesystem::path& path, const Problem& problem);
  DataError(const std::filesystem::path& path, std::string place, std::string found, std::string expected,
            std::string hint = "");
  /// The contents of the file break a precondition. @param place  in the file; may be empty
  DataError(const std::filesystem::path& path, const std::string& place, const InvalidArgument& broken);
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The user stopped a computation (Ctrl-C) that had no partial result to return (exit status 130).
class Cancelled : public Error {
 public:
  using Error::Error;
};

namespace core_detail {
[[noreturn]] void throw_invalid_argument(const char* function, const std::string& message);
[[noreturn]] void stop_on_broken_invariant(const char* file, int line, const char* condition);
}  // namespace core_detail

}  // namespace incise

/// Checks a precondition; throws InvalidArgument with a message that says what was expected and found.
#define INCISE_REQUIRE(condition, message)                                  \
  do {                                                                      \
    if (!(condition)) ::incise::core_detail::throw_invalid_argument(__func__, (message)); \
  } while (false)

/// Checks an internal invariant; stops the program in debug builds, costs nothing in release builds.
#ifdef NDEBUG
#define INCISE_ASSERT(condition) static_cast<void>(0)
#else
#define INCISE_ASSERT(condition)                                                                      \
  do {                                                                                                \
    if (!(condition)) ::incise::core_detail::stop_on_broken_invariant(__FILE__, __LINE__, #condition); \
  } while (false)
#endif
