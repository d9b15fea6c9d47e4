#include "robot/program_reading.hpp"

#include <incise/core/units.hpp>

#include <fmt/format.h>

#include <cmath>
#include <sstream>

namespace incise::robot_detail {
namespace {

/// Reads one statement from left to right.
class Scanner {
 public:
  Scanner(const std::string& line, const LinePlace& place) : line_(line), place_(place) {}

  void expect(std::string_view token) {
    skip_blanks();
    if (line_.compare(at_, token.size(), token) != 0) fail(fmt::format("'{}'", token));
    at_ += token.size();
  }
  [[nodiscard]] double number() {
    skip_blanks();
    const char* begin = line_.c_str() + at_;
    char* end = nullptr;
    // strtod would also accept "nan", "inf" and hexadecimal numbers, which incise does not write.
    const bool starts_well = std::string_view("+-.0123456789").find(*begin) != std::string_view::npos && *begin != '\0';
    const double value = starts_well ? std::strtod(begin, &end) : 0.0;
    // In m, rad, m/s or s: squares of much larger numbers could overflow.
    constexpr double kLargest = 1e12;
    if (!starts_well || end == begin || !(std::abs(value) <= kLargest)) fail("a number within 1e12");
    at_ += static_cast<std::size_t>(end - begin);
    return value;
  }
  [[nodiscard]] double positive(std::string_view name) {
    const double value = number();
    if (value <= 0.0) place_.fail(fmt::format("{} = {}", name, value), fmt::format("{} above 0", name));
    return value;
  }
  /// `, NAME=` and a number above 0
  [[nodiscard]] double named(std::string_view name) {
    expect(",");
    expect(fmt::format("{}=", name));
    return positive(name);
  }
  void six(std::string_view open, Joints& values) {
    expect(open);
    for (int i = 0; i < 6; ++i) {
      if (i > 0) expect(",");
      values[i] = number();
    }
    expect("]");
  }
  void finish() {
    skip_blanks();
    if (at_ != line_.size()) fail("the end of the line");
  }

 private:
  void skip_blanks() {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t')) ++at_;
  }
  [[noreturn]] void fail(const std::string& expected) const {
    const std::string rest = line_.substr(std::min(at_, line_.size()), 40);
    place_.fail(rest.empty() ? "the end of the line" : fmt::format("'{}' at column {}", rest, at_ + 1), expected);
  }

  const std::string& line_;
  const LinePlace& place_;
  std::size_t at_ = 0;
};

ScriptCommand read_command(const std::string& word, Scanner& scan, const LinePlace& place) {
  using Kind = ScriptCommand::Kind;
  ScriptCommand command;
  command.line = place.line;
  Joints six;
  scan.expect("(");
  if (word == "movej") {
    command.kind = Kind::MoveJ;
    scan.six("[", command.q_rad);
    command.acceleration = scan.named("a");
    command.speed = scan.named("v");
  } else if (word == "servoj") {
    command.kind = Kind::ServoJ;
    scan.six("[", command.q_rad);
    for (int i = 0; i < 2; ++i) {
      scan.expect(",");
      scan.expect("0");
    }
    command.seconds = scan.named("t");
    command.lookahead_s = scan.named("lookahead_time");
    command.gain = scan.named("gain");
  } else if (word == "sleep") {
    command.kind = Kind::Sleep;
    command.seconds = scan.positive(word);
  } else if (word == "stopj") {
    command.kind = Kind::StopJ;
    command.acceleration = scan.positive(word);
  } else {
    command.kind = word == "movel" ? Kind::MoveL : Kind::MoveP;
    scan.six("p[", six);
    command.tip_mm = units::kMmPerM * six.head<3>();
    command.rotation_vector = six.tail<3>();
    command.acceleration = units::mm_from_m(scan.named("a"));
    command.speed = units::mm_from_m(scan.named("v"));
    if (word == "movep") {
      scan.expect(",");
      scan.expect("r=");
      command.blend_mm = units::mm_from_m(scan.number());
      if (command.blend_mm < 0.0) place.fail(fmt::format("r = {}", command.blend_mm), "a blend radius of 0 or more");
    }
  }
  scan.expect(")");
  scan.finish();
  return command;
}

/// Section of the file that the reader has reached.
enum class Section { Before, Inside, After, Called };

class ScriptReader {
 public:
  explicit ScriptReader(const std::filesystem::path& file) : place_{file} {}

  void take(std::string line) {
    ++place_.line;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos) return;
    line.erase(0, first);
    if (line.front() == '#') return comment(line);
    const std::string word = line.substr(0, line.find_first_of(" (\t"));
    std::string rest = line.substr(word.size());
    Scanner scan(rest, place_);
    switch (section_) {
      case Section::Before:
        return open(word, rest);
      case Section::Inside:
        return statement(word, scan);
      case Section::After:
        if (word != name_ || rest != "()") place_.fail(fmt::format("'{:.60}'", line), name_ + "()");
        section_ = Section::Called;
        return;
      case Section::Called:
        place_.fail(fmt::format("'{:.60}'", line), "nothing after the function's call");
    }
  }

  WrittenProgram finish() {
    if (section_ == Section::Before) place_.fail("no function", "def NAME():");
    if (section_ == Section::Inside) place_.fail("the end of the file", "end", "The file is cut short.");
    if (section_ == Section::After) place_.fail("the end of the file", name_ + "()", "The file is cut short.");
    if (program_.commands.size() < 2) place_.fail("a function without moves", "movej and moves along a course");
    return std::move(program_);
  }

 private:
  void comment(const std::string& line) {
    const std::string mark = "# phase: ";
    if (line.rfind(mark, 0) == 0)
      phase_ = phase_of(line.substr(mark.size()), place_.complain());
    else
      read_comment(line, program_);
  }

  void open(const std::string& word, const std::string& rest) {
    const std::size_t paren = rest.find("():");
    if (word != "def" || paren == std::string::npos || paren < 2 || paren + 3 != rest.size())
      place_.fail(fmt::format("'{:.60}'", word + rest),
                  "def NAME():", "Only programs that `incise export` wrote can be replayed.");
    name_ = rest.substr(1, paren - 1);
    section_ = Section::Inside;
  }

  void statement(const std::string& word, Scanner& scan) {
    if (word == "end") {
      scan.finish();
      section_ = Section::After;
    } else if (word == "set_tcp") {
      // One tool for the whole program: the player has only one.
      if (has_tool_) place_.fail("a second set_tcp", "one tool for the whole program");
      if (!program_.commands.empty()) place_.fail("set_tcp after a move", "set_tcp before the first move");
      has_tool_ = true;
      Joints pose;
      scan.expect("(");
      scan.six("p[", pose);
      scan.expect(")");
      scan.finish();
      program_.T_flange_tool = tool_pose(units::kMmPerM * pose.head<3>(), pose.tail<3>());
    } else if (word == "movej" || word == "movel" || word == "movep" || word == "servoj" || word == "sleep" ||
               word == "stopj") {
      add(read_command(word, scan, place_));
    } else {
      place_.fail(fmt::format("'{:.60}'", word), "set_tcp, movej, movel, movep, servoj, sleep, stopj or end",
                  "Only programs that `incise export` wrote can be replayed.");
    }
  }

  void add(ScriptCommand command) {
    if (program_.commands.empty() && command.kind != ScriptCommand::Kind::MoveJ)
      place_.fail("another first move", "movej to the start", "It determines the arm's branch.");
    if (!program_.commands.empty() && command.kind == ScriptCommand::Kind::MoveJ)
      place_.fail("another movej", "movel, movep, servoj, sleep or stopj after the way to the start");
    seconds_ += command.seconds;
    if (seconds_ > kLongestProgramS) {
      place_.fail(fmt::format("a program of {:.4g} s up to here", seconds_),
                  fmt::format("at most {} s", kLongestProgramS));
    }
    command.phase = phase_;
    program_.commands.push_back(command);
  }

  LinePlace place_;
  WrittenProgram program_;
  Section section_ = Section::Before;
  std::string name_;
  ProgramPhase phase_ = ProgramPhase::Approach;
  bool has_tool_ = false;
  double seconds_ = 0.0;  ///< total of rests and streams
};

}  // namespace

WrittenProgram read_urscript(std::string_view text, const std::filesystem::path& file) {
  ScriptReader reader(file);
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) reader.take(std::move(line));
  return reader.finish();
}

}  // namespace incise::robot_detail
