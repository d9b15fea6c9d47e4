#pragma once

#include <incise/core/error.hpp>

#include <string>

namespace incise {

/// What a broken precondition says without the name of the function that found it, for passing it on to a person whose
/// file or case broke it.
[[nodiscard]] std::string without_function_name(const InvalidArgument& problem);

/// As above, as a sentence of its own: for the hint of another error.
[[nodiscard]] std::string as_sentence(const InvalidArgument& problem);

/// What a sentence complains about, taken apart, so that an error that passes it on does not say "found" twice.
struct Complaint {
  std::string field;  ///< empty: none was named
  std::string found;
  std::string expected;
};

/// @param sentence  "[field: ]expected A[, found B]", "[field: ]found B, expected A", as broken preconditions and
///                  validate() have it; any other sentence is what was found
/// @param otherwise  what was expected, where the sentence does not say it
[[nodiscard]] Complaint complaint_of(const std::string& sentence, const std::string& otherwise);

/// A broken precondition as the fault of a file.
[[nodiscard]] DataError fault_of_file(const std::filesystem::path& file, const std::string& place,
                                      const InvalidArgument& problem, const std::string& otherwise,
                                      const std::string& hint = "");

}  // namespace incise
