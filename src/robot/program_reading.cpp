#include "robot/program_reading.hpp"

#include "robot/text_form.hpp"
#include "robot/tip_curve.hpp"

#include <incise/core/problem_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <sstream>

namespace incise {
namespace robot_detail {
namespace {

constexpr double kSameToolMm = 1e-3;  // set_tcp holds fewer digits

/// Exactly `count` finite numbers, separated by blanks. @throws DataError
std::vector<double> numbers_of(const std::string& value, std::size_t count, const std::filesystem::path& file,
                               const std::string& key) {
  std::istringstream words(value);
  std::vector<double> numbers;
  std::string word;
  while (words >> word) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (end == word.c_str() || *end != '\0' || !std::isfinite(number))
      throw DataError(file, "header " + key, fmt::format("'{}'", word), "a finite number");
    numbers.push_back(number);
  }
  if (numbers.size() != count)
    throw DataError(file, "header " + key, fmt::format("{} numbers", numbers.size()), fmt::format("{}", count));
  return numbers;
}

/// One length of 0 to what a program may have. @throws DataError
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

/// A tool can follow the waypoints, and the overlap is less than once around. @throws DataError
void require_course(const ToolPath& path, double overlap_mm, const std::filesystem::path& file) {
  try {
    const TipCurve curve(path);
    if (path.is_closed && overlap_mm >= curve.length_mm()) {
      throw DataError(file, "header overlap_mm", fmt::format("{}", overlap_mm),
                      fmt::format("less than once around, {:.4g} mm", curve.length_mm()));
    }
  } catch (const InvalidArgument& error) {
    throw fault_of_file(file, "header waypoint", error, "waypoints that a tool can follow");
  }
}

}  // namespace

void LinePlace::fail(const std::string& found, const std::string& expected, const std::string& hint) const {
  throw DataError(file, fmt::format("line {}", line), found, expected, hint);
}

void read_comment(const std::string& line, WrittenProgram& program) {
  const std::string mark = kHeaderMark;
  if (line.rfind(mark, 0) != 0) return;
  const std::size_t colon = line.find(": ");
  if (colon == std::string::npos) return;
  program.header.emplace_back(line.substr(mark.size(), colon - mark.size()), line.substr(colon + 2));
}

ProgramPhase phase_of(const std::string& name, const LinePlace& place) {
  constexpr std::array kAll{ProgramPhase::Approach, ProgramPhase::Plunge, ProgramPhase::Cut,    ProgramPhase::Overlap,
                            ProgramPhase::Dwell,    ProgramPhase::Exit,   ProgramPhase::Retreat};
  for (const ProgramPhase phase : kAll) {
    if (name == to_string(phase)) return phase;
  }
  place.fail(fmt::format("phase '{}'", name), "approach, plunge, cut, overlap, dwell, exit or retreat");
}

void read_header(WrittenProgram& program, const std::filesystem::path& file) {
  ToolPath path;
  path.frame = PathFrame::Robot;
  bool has_tool = false;
  for (const auto& [key, value] : program.header) {
    if (key == "kind") {
      if (value != "incise" && value != "mark") throw DataError(file, "header kind", value, "incise or mark");
      path.kind = value == "mark" ? PathKind::Mark : PathKind::Incise;
    } else if (key == "closed") {
      if (value != "true" && value != "false") throw DataError(file, "header closed", value, "true or false");
      path.is_closed = value == "true";
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
        throw DataError(file, "set_tcp", "another tool than in the header", "the tool of the header's T_flange_tool");
      program.T_flange_tool = T;
      has_tool = true;
    } else if (key == "waypoint") {
      path.waypoints.push_back(waypoint_of(value, file));
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
}

WrittenProgram read_joint_csv(std::string_view text, const std::filesystem::path& file) {
  WrittenProgram program;
  std::istringstream lines{std::string(text)};
  LinePlace place{file};
  std::string expected_head = "time_s";
  for (const char* unit : {"_rad", "_rad_s", "_rad_s2"}) {
    for (const std::string& name : ur10e().joint_names) expected_head += "," + name + unit;
  }
  expected_head += ",tip_x_mm,tip_y_mm,tip_z_mm,phase";
  bool has_head = false;
  for (std::string line; std::getline(lines, line);) {
    ++place.line;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    if (line.front() == '#') {
      read_comment(line, program);
    } else if (!has_head) {
      if (line != expected_head)
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
        char* end = nullptr;
        numbers[i] = std::strtod(cells[i].c_str(), &end);
        if (end == cells[i].c_str() || *end != '\0' || !std::isfinite(numbers[i]))
          place.fail(fmt::format("'{}' in column {}", cells[i], i + 1), "a finite number");
      }
      TimedJoints joints{numbers[0], Joints::Zero(), Joints::Zero(), phase_of(cells.back(), place), place.line};
      for (int i = 0; i < 6; ++i) {
        joints.q_rad[i] = numbers[static_cast<std::size_t>(1 + i)];
        joints.speed_rad_s[i] = numbers[static_cast<std::size_t>(7 + i)];
      }
      if (!program.joints.empty() && joints.time_s <= program.joints.back().time_s)
        place.fail(fmt::format("time {} s after {} s", joints.time_s, program.joints.back().time_s),
                   "times that increase");
      program.joints.push_back(joints);
    }
  }
  if (program.joints.size() < 2) place.fail(fmt::format("{} rows", program.joints.size()), "at least 2 rows of joints");
  return program;
}

WrittenProgram read_program_json(std::string_view text, const std::filesystem::path& file) {
  WrittenProgram program;
  try {
    const auto document = nlohmann::ordered_json::parse(text);
    if (document.at("schema") != "incise.program/1")
      throw DataError(file, "schema", document.at("schema").dump(), "\"incise.program/1\"");
    for (const auto& item : document.at("header"))
      program.header.emplace_back(item.at(0).get<std::string>(), item.at(1).get<std::string>());
    std::vector<std::pair<double, ProgramPhase>> phases;
    const LinePlace place{file};
    for (const auto& pose : document.at("poses"))
      phases.emplace_back(pose.at("time_s").get<double>(), phase_of(pose.at("phase").get<std::string>(), place));
    std::size_t next = 0;
    for (const auto& row : document.at("motion").at("samples")) {
      TimedJoints joints{.time_s = row.at(0).get<double>()};
      for (int i = 0; i < 6; ++i) {
        joints.q_rad[i] = row.at(static_cast<std::size_t>(1 + i)).get<double>();
        joints.speed_rad_s[i] = row.at(static_cast<std::size_t>(7 + i)).get<double>();
      }
      while (next + 1 < phases.size() && phases[next].first <= joints.time_s) ++next;
      joints.phase = phases.at(next).second;
      if (!program.joints.empty() && joints.time_s <= program.joints.back().time_s)
        throw DataError(file, fmt::format("/motion/samples/{}", program.joints.size()), "a time that does not increase",
                        "times that increase");
      program.joints.push_back(joints);
    }
  } catch (const nlohmann::json::parse_error& error) {
    throw DataError(file, fmt::format("byte {}", error.byte), "text that is not JSON",
                    "a program that `incise export --format json` wrote");
  } catch (const nlohmann::json::exception& error) {
    throw DataError(file, "JSON", error.what(), "a program that `incise export --format json` wrote");
  }
  if (program.joints.size() < 2)
    throw DataError(file, "/motion/samples", fmt::format("{} samples", program.joints.size()), "at least 2");
  return program;
}

}  // namespace robot_detail

WrittenProgram program_from_text(std::string_view text, const std::filesystem::path& name) {
  const std::string ending = name.extension().string();
  if (ending == ".yaml" || ending == ".yml" || ending == ".bag") {
    throw DataError(name, "", fmt::format("a {} program", ending), "URScript, .csv or .json",
                    "What ROS runs holds the joints of --format joint-csv: export and replay these.");
  }
  WrittenProgram program = ending == ".csv"    ? robot_detail::read_joint_csv(text, name)
                           : ending == ".json" ? robot_detail::read_program_json(text, name)
                                               : robot_detail::read_urscript(text, name);
  robot_detail::read_header(program, name);
  return program;
}

}  // namespace incise
