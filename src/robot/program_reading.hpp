#pragma once

#include <incise/robot/program_reading.hpp>

#include <functional>
#include <string>

namespace incise::robot_detail {

/// Refuses what was found in favour of what was expected, at a place that it knows. It throws DataError.
using Complain = std::function<void(const std::string& found, const std::string& expected)>;

/// One line of a file, for messages.
struct LinePlace {
  const std::filesystem::path& file;
  std::size_t line = 0;
  [[noreturn]] void fail(const std::string& found, const std::string& expected, const std::string& hint = "") const;
  /// Of this very line; the place has to outlive it.
  [[nodiscard]] Complain complain() const {
    return [this](const std::string& found, const std::string& expected) { fail(found, expected); };
  }
};

/// Takes in a header line `# incise.KEY: VALUE`; other comments are left alone. @returns the phase that a line `#
/// phase: NAME` names
void read_comment(const std::string& line, WrittenProgram& program);

/// Fills path, tool and lengths from the header. @throws DataError naming the file and the header's key
void read_header(WrittenProgram& program, const std::filesystem::path& file);

[[nodiscard]] ProgramPhase phase_of(const std::string& name, const Complain& fail);

/// Appends a row: later than the one before, within kLongestProgramS of the first, at angles that joints have.
void add_row(WrittenProgram& program, const TimedJoints& row, const Complain& fail);

[[nodiscard]] WrittenProgram read_urscript(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] WrittenProgram read_joint_csv(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] WrittenProgram read_program_json(std::string_view text, const std::filesystem::path& file);

}  // namespace incise::robot_detail
