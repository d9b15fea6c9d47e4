#pragma once

#include <incise/core/error.hpp>
#include <incise/core/version.hpp>
#include <incise/io/manifest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace incise::bench {

/// What a cost is worth nothing without: machine, compiler, flags and commit, as the first line of a CSV file.
inline std::string origin_line(const std::string& note = "") {
  return fmt::format("# {}; g++ {}, {}; {} {}{}{}\n", machine_description(), __VERSION__, BUILD_FLAGS, version(),
                     source_commit(), note.empty() ? "" : "; ", note);
}

/// Prints a line at once, so that a run that is stopped has told what it knew, and keeps it for the file.
inline void tell(const std::string& line, std::string& table) {
  fmt::print("{}", line);
  std::fflush(stdout);
  table += line;
}

/// An empty name: none was asked for. @throws DataError
inline void write_text(const std::string& file_name, const std::string& text) {
  if (file_name.empty()) return;
  std::ofstream file(file_name);
  file << text;
  if (!file.flush()) throw DataError(file_name, "", "a file that cannot be written", "room and permission for it");
}

/// Numbers above 0 with commas between them. @throws InvalidArgument
inline std::vector<double> numbers_in(std::string_view option, const char* text) {
  std::vector<double> found;
  const char* at = text;
  do {
    char* end = nullptr;
    found.push_back(std::strtod(at, &end));
    INCISE_REQUIRE(end != at && found.back() > 0.0 && std::isfinite(found.back()) && (*end == ',' || *end == '\0'),
                   fmt::format("expected {} numbers above 0 with commas between them, found {}", option, text));
    at = *end == ',' ? end + 1 : nullptr;
  } while (at != nullptr);
  return found;
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

/// The exit status of `run`; 3 and 2 for what it throws about files and about all else.
template <typename Run>
int reporting_errors(const char* program, const Run& run) {
  try {
    return run();
  } catch (const DataError& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return 2;
  }
}

}  // namespace incise::bench
