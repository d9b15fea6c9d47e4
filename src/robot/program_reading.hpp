#pragma once

#include <incise/robot/program_reading.hpp>

#include <functional>
#include <string>

namespace incise::robot_detail {

/// Throws DataError with what was found and expected; it knows the place in the file.
using Complain = std::function<void(const std::string& found, const std::string& expected)>;

/// One line of a file, for messages.
struct LinePlace {
  const std::filesystem::path& file;
  std::size_t line = 0;
  [[noreturn]] void fail(const std::string& found, const std::string& expected, const std::string& hint = "") const;
  /// Returns a Complain for this line. The LinePlace must outlive it.
  [[nodiscard]] Complain complain() const {
    return [this](const std::string& found, const std::string& expected) { fail(found, expected); };
  }
};

/// Returns the number that the whole text is; nothing for another text.
[[nodiscard]] std::optional<double> number_of(const std::string& text);

/// Adds a line `# incise.KEY: VALUE` to the program's header; ignores other comments.
void read_comment(const std::string& line, WrittenProgram& program);

/// Fills path, record, tool and lengths from the header. @throws DataError naming the file and the header's key
void read_header(WrittenProgram& program, const std::filesystem::path& file);

[[nodiscard]] ProgramPhase phase_of(const std::string& name, const Complain& fail);

/// Appends a row. It must be later than the last row, within kLongestProgramS of the first, and have possible angles.
void add_row(WrittenProgram& program, const TimedJoints& row, const Complain& fail);

[[nodiscard]] WrittenProgram read_urscript(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] WrittenProgram read_joint_csv(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] WrittenProgram read_program_json(std::string_view text, const std::filesystem::path& file);

}  // namespace incise::robot_detail
