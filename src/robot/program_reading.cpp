#include "robot/program_reading.hpp"

#include "robot/comment_text.hpp"
#include "robot/program_digest.hpp"
#include "robot/program_record.hpp"
#include "robot/text_form.hpp"
#include "robot/tip_curve.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <type_traits>

namespace incise {
namespace robot_detail {
namespace {

constexpr double kSameToolMm = 1e-3;         // set_tcp has fewer digits
constexpr double kLargestAngleRad = 1000.0;  // many turns: a number far beyond is no joint angle

/// Exactly `count` finite numbers, separated by blanks. @throws DataError
std::vector<double> numbers_of(const std::string& value, std::size_t count, const std::filesystem::path& file,
                               const std::string& key) {
  std::istringstream words(value);
  std::vector<double> numbers;
  std::string word;
  while (words >> word) {
    const auto number = number_of(word);
    if (!number || !std::isfinite(*number))
      throw DataError(file, "header " + key, fmt::format("'{}'", word), "a finite number");
    numbers.push_back(*number);
  }
  if (numbers.size() != count)
    throw DataError(file, "header " + key, fmt::format("{} numbers", numbers.size()), fmt::format("{}", count));
  return numbers;
}

/// One length, 0 to kLargestLengthMm. @throws DataError
double length_of(const std::string& value, const std::filesystem::path& file, const std::string& key) {
  const double length_mm = numbers_of(value, 1, file, key)[0];
  if (length_mm < 0.0 || length_mm > kLargestLengthMm)
    throw DataError(file, "header " + key, value, fmt::format("0 to {} mm", kLargestLengthMm));
  return length_mm;
}

Waypoint waypoint_of(const std::string& value, const std::filesystem::path& file) {
  const auto n = numbers_of(value, 8, file, "waypoint");
  Waypoint waypoint{Vec3(n[0], n[1], n[2]), Vec3(n[3], n[4], n[5]), n[6], n[7]};
  const bool is_sound = waypoint.position_mm.cwiseAbs().maxCoeff() <= kFarthestPlaceMm &&
                        std::abs(waypoint.axis.norm() - 1.0) <= 1e-4 && waypoint.speed_mm_s > 0.0 &&
                        waypoint.depth_mm >= 0.0 && waypoint.depth_mm <= kLargestLengthMm;
  if (!is_sound) {
    throw DataError(file, "header waypoint", value,
                    fmt::format("a place, a unit axis, a depth of 0 to {} mm and a speed above 0", kLargestLengthMm));
  }
  waypoint.axis.normalize();
  return waypoint;
}

/// Requires that a tool can follow the waypoints and that the overlap is less than once around. @throws DataError
void require_course(const ToolPath& path, double overlap_mm, const std::filesystem::path& file) {
  try {
    const TipCurve curve(path);
    if (path.is_closed && overlap_mm >= curve.length_mm()) {
      throw DataError(file, "header overlap_mm", fmt::format("{}", overlap_mm),
                      fmt::format("less than once around, {:.4g} mm", curve.length_mm()));
    }
  } catch (const InvalidArgument& error) {
    throw DataError(file, "header waypoint", error);
  }
}

}  // namespace

void LinePlace::fail(const std::string& found, const std::string& expected, const std::string& hint) const {
  throw DataError(file, fmt::format("line {}", line), found, expected, hint);
}

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' ? std::optional(number) : std::nullopt;
}

void add_row(WrittenProgram& program, const TimedJoints& row, const Complain& fail) {
  if (!(row.q_rad.cwiseAbs().maxCoeff() <= kLargestAngleRad))
    fail(fmt::format("a joint at {:.3g} rad", row.q_rad.cwiseAbs().maxCoeff()),
         fmt::format("at most {} rad", kLargestAngleRad));
  if (!program.joints.empty() && row.time_s <= program.joints.back().time_s)
    fail(fmt::format("time {} s after {} s", row.time_s, program.joints.back().time_s), "times that increase");
  const double begin_s = program.joints.empty() ? row.time_s : program.joints.front().time_s;
  if (!(row.time_s - begin_s <= kLongestProgramS))
    fail(fmt::format("a program of {:.4g} s", row.time_s - begin_s), fmt::format("at most {} s", kLongestProgramS));
  program.joints.push_back(row);
}

void read_comment(const std::string& line, WrittenProgram& program) {
  const std::string mark = kHeaderMark;
  if (line.rfind(mark, 0) != 0) return;
  const std::size_t colon = line.find(": ");
  if (colon == std::string::npos) return;
  program.header.emplace_back(line.substr(mark.size(), colon - mark.size()), line.substr(colon + 2));
}

ProgramPhase phase_of(const std::string& name, const Complain& fail) {
  if (const auto phase = value_of<ProgramPhase>(name)) return *phase;
  fail(fmt::format("phase '{:.40}'", name), choices(names_of(ProgramPhase{})));
  return ProgramPhase::Approach;  // not reached: `fail` throws
}

namespace {

/// Named numbers of the header: `# incise.KEY: NAME NUMBER`, each once.
class NamedNumbers {
 public:
  explicit NamedNumbers(const std::filesystem::path& file) : file_(file) {}
  void add(const std::string& key, const std::string& value) {
    const std::size_t blank = value.find(' ');
    const std::string name = value.substr(0, blank), place = key + " " + name;
    if (blank == std::string::npos ||
        !numbers_.emplace(place, numbers_of(value.substr(blank), 1, file_, place)[0]).second)
      throw DataError(file_, "header " + key, fmt::format("'{}'", value), "a name and its number, each name once");
  }
  /// Nothing if a name is missing or unknown.
  [[nodiscard]] std::optional<ProgramRecord> record() const {
    ProgramRecord record;
    std::size_t found = 0, expected = 0;
    describe(record, [&](const char* key, const char* name, auto& number) {
      ++expected;
      const auto at = numbers_.find(std::string(key) + " " + name);
      if (at == numbers_.end()) return;
      ++found;
      number = static_cast<std::remove_reference_t<decltype(number)>>(at->second);
    });
    return found == expected && found == numbers_.size() ? std::optional(record) : std::nullopt;
  }

 private:
  const std::filesystem::path& file_;
  std::map<std::string, double> numbers_;
};

bool truth_of(const std::string& value, const std::filesystem::path& file, const std::string& key) {
  if (value != "true" && value != "false") throw DataError(file, "header " + key, value, "true or false");
  return value == "true";
}

}  // namespace

void read_header(WrittenProgram& program, const std::filesystem::path& file) {
  ToolPath path;
  path.frame = PathFrame::Robot;
  bool has_tool = false;
  NamedNumbers named(file);
  std::optional<double> spin_deg;
  for (const auto& [key, value] : program.header) {
    if (key == "kind") {
      const auto kind = value_of<PathKind>(value);
      if (!kind) throw DataError(file, "header kind", value, choices(names_of(PathKind{})));
      path.kind = *kind;
    } else if (key == "closed") {
      path.is_closed = truth_of(value, file, key);
    } else if (key == "overlap_mm") {
      program.overlap_mm = length_of(value, file, key);
    } else if (key == "clearance_mm") {
      program.clearance_mm = length_of(value, file, key);
    } else if (key == "approach_height_mm") {
      program.approach_height_mm = length_of(value, file, key);
    } else if (key == "T_flange_tool") {
      const auto n = numbers_of(value, 16, file, key);
      const Mat4 T = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n.data());
      if (!program.commands.empty() && (T - program.T_flange_tool).norm() > kSameToolMm)
        throw DataError(file, "set_tcp", "a tool that differs from the header's",
                        "the tool of the header's T_flange_tool");
      program.T_flange_tool = T;
      has_tool = true;
    } else if (key == "waypoint") {
      path.waypoints.push_back(waypoint_of(value, file));
    } else if (key == "tumor_edge_closed") {
      path.tumor_edge.is_closed = truth_of(value, file, key);
    } else if (key == "tumor_edge") {
      const auto n = numbers_of(value, 3, file, key);
      path.tumor_edge.points.emplace_back(n[0], n[1], n[2]);
    } else if (key == "setting" || key == "limit") {
      named.add(key, value);
    } else if (key == "spin_deg") {
      spin_deg = numbers_of(value, 1, file, key)[0];
    }
  }
  const Mat3 R = program.T_flange_tool.topLeftCorner<3, 3>();
  if (!has_tool || (R * R.transpose() - Mat3::Identity()).norm() > 1e-6 || R.determinant() < 0.0) {
    throw DataError(file, "header T_flange_tool", has_tool ? "a matrix that is not rigid" : "nothing",
                    "the tool's place on the flange", "Only programs that `incise export` wrote can be replayed.");
  }
  if (path.waypoints.size() < (path.is_closed ? 3u : 2u)) return;
  require_course(path, program.overlap_mm, file);
  program.path = path;
  program.record = named.record();
  if (!program.record) return;
  program.record->settings.spin_deg = spin_deg;
  program.record->settings.overlap_mm = program.overlap_mm;
  program.record->settings.clearance_mm = program.clearance_mm;
  program.record->settings.approach_height_mm = program.approach_height_mm;
  program.record->setup.T_flange_tool = program.T_flange_tool;
}

WrittenProgram read_joint_csv(std::string_view text, const std::filesystem::path& file) {
  WrittenProgram program;
  std::istringstream lines{std::string(text)};
  LinePlace place{file};
  bool has_head = false;
  for (std::string line; std::getline(lines, line);) {
    ++place.line;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    if (line.front() == '#') {
      read_comment(line, program);
    } else if (!has_head) {
      if (line != joint_csv_columns(ur10e()))
        place.fail(fmt::format("'{:.60}'", line),
                   "the columns that `incise export` writes: time_s,shoulder_pan_joint_rad…");
      has_head = true;
    } else {
      constexpr std::size_t kColumns = 23;
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (cells.size() != kColumns) place.fail(fmt::format("{} columns", cells.size()), fmt::format("{}", kColumns));
      std::array<double, kColumns - 1> numbers{};
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto number = number_of(cells[i]);
        if (!number || !std::isfinite(*number))
          place.fail(fmt::format("'{}' in column {}", cells[i], i + 1), "a finite number");
        numbers[i] = *number;
      }
      const auto six_from = [&numbers](std::size_t first) { return Joints(Joints::Map(&numbers[first])); };
      const ProgramPhase phase = phase_of(cells.back(), place.complain());
      const Vec3 tip_mm(numbers[19], numbers[20], numbers[21]);
      add_row(program, {numbers[0], six_from(1), six_from(7), phase, place.line, six_from(13), tip_mm},
              place.complain());
    }
  }
  if (program.joints.size() < 2) place.fail(fmt::format("{} rows", program.joints.size()), "at least 2 rows of joints");
  return program;
}

}  // namespace robot_detail

WrittenProgram program_from_text(std::string_view text, const std::filesystem::path& name) {
  const std::string ending = name.extension().string();
  if (ending == ".yaml" || ending == ".yml" || ending == ".bag") {
    throw DataError(name, "", fmt::format("a {} program", ending), "URScript, .csv or .json",
                    "A ROS file has the same joints as --format joint-csv: export and replay that.");
  }
  if (const std::size_t hidden = robot_detail::first_hidden(text); hidden != std::string_view::npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(hidden), '\n');
    throw DataError(name, fmt::format("line {}", line),
                    fmt::format("byte 0x{:02X} of an invisible character", static_cast<unsigned char>(text[hidden])),
                    "what `incise export` writes", "Another reader might run the text after it.");
  }
  WrittenProgram program = ending == ".csv"    ? robot_detail::read_joint_csv(text, name)
                           : ending == ".json" ? robot_detail::read_program_json(text, name)
                                               : robot_detail::read_urscript(text, name);
  robot_detail::read_header(program, name);
  program.digest = robot_detail::digest_state(text, program.header);
  return program;
}

}  // namespace incise
