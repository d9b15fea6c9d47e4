#pragma once

#include <incise/core/error.hpp>
#include <incise/core/version.hpp>
#include <incise/io/manifest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
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
