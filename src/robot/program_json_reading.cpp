#include "robot/program_reading.hpp"
#include "robot/program_record.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <set>

namespace incise::robot_detail {
namespace {

using ProgramJson = nlohmann::ordered_json;

/// A JSON program with the place in it, for messages. Whatever is asked for and not there is a DataError.
class ProgramPlace {
 public:
  ProgramPlace(const std::filesystem::path& file, const ProgramJson& value, std::string at)
      : file_(file), value_(value), at_(std::move(at)) {}

  [[nodiscard]] ProgramPlace at(const char* key) const {
    if (!value_.is_object()) fail("no object");
    const auto found = value_.find(key);
    if (found == value_.end()) ProgramPlace(file_, value_, at_ + "/" + key).fail("nothing");
    return {file_, *found, at_ + "/" + key};
  }
  [[nodiscard]] std::vector<ProgramPlace> items(std::size_t least) const {
    require_list(least);
    std::vector<ProgramPlace> all;
    for (std::size_t i = 0; i < value_.size(); ++i) all.emplace_back(file_, value_[i], fmt::format("{}/{}", at_, i));
    return all;
  }
  [[nodiscard]] std::vector<double> numbers(std::size_t least) const {
    require_list(least);
    std::vector<double> all;
    for (std::size_t i = 0; i < value_.size(); ++i) {
      if (!value_[i].is_number()) items(least)[i].fail(items(least)[i].shown(), "a number");
      all.push_back(value_[i].get<double>());
    }
    return all;
  }
  [[nodiscard]] double number() const {
    if (!value_.is_number()) fail(shown(), "a number");
    return value_.get<double>();
  }
  [[nodiscard]] bool is_null() const { return value_.is_null(); }
  [[nodiscard]] bool truth() const {
    if (!value_.is_boolean()) fail(shown(), "true or false");
    return value_.get<bool>();
  }
  [[nodiscard]] std::string text() const {
    if (!value_.is_string()) fail(shown(), "a text");
    return value_.get<std::string>();
  }
  [[nodiscard]] Complain complain() const {
    return [this](const std::string& found, const std::string& expected) { fail(found, expected); };
  }
  [[noreturn]] void fail(const std::string& found,
                         const std::string& expected = "what `incise export --format json` wrote") const {
    throw DataError(file_, at_, found, expected);
  }

 private:
  void require_list(std::size_t least) const {
    if (value_.is_array() && value_.size() >= least) return;
    fail(value_.is_array() ? fmt::format("{} entries", value_.size()) : "no list",
         fmt::format("a list of {} or more", least));
  }
  [[nodiscard]] std::string shown() const { return fmt::format("{:.60}", value_.dump()); }

  const std::filesystem::path& file_;
  const ProgramJson& value_;
  std::string at_;
};

ProgramJson parsed_program(std::string_view text, const std::filesystem::path& file) {
  constexpr const char* kExpected = "a program that `incise export --format json` wrote";
  try {
    static constexpr int kDeepest = 16;  // a program's values are less deep; whatever walks through them calls itself once a level
    std::vector<std::set<std::string>> keys;  // of the objects that are open; the library would keep the last of two
    const auto watch = [&](int depth, ProgramJson::parse_event_t event, ProgramJson& parsed) {
      if (depth > kDeepest)
        throw DataError(file, "JSON", fmt::format("values nested more than {} deep", kDeepest), kExpected);
      if (event == ProgramJson::parse_event_t::object_start) keys.emplace_back();
      if (event == ProgramJson::parse_event_t::object_end) keys.pop_back();
      if (event == ProgramJson::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
        throw DataError(file, "JSON", fmt::format("the key '{:.60}' twice in one object", parsed.get<std::string>()),
                        kExpected);
      return true;
    };
    return ProgramJson::parse(text, watch);
  } catch (const nlohmann::json::parse_error& error) {
    throw DataError(file, fmt::format("byte {}", error.byte), "text that is not JSON", kExpected);
  } catch (const nlohmann::json::out_of_range&) {
    throw DataError(file, "JSON", "a number beyond 1.8e308", kExpected);
  }
}

/// A check of the list, in the words of the header.
std::string check_of(const ProgramPlace& place) {
  // JSON has no infinity: it is written as null.
  const auto number = [&place](const char* key) {
    const ProgramPlace at = place.at(key);
    return at.is_null() ? std::numeric_limits<double>::infinity() : at.number();
  };
  return held_against_its_limit({.name = place.at("name").text(),
                                 .passed = place.at("passed").truth(),
                                 .value = number("value"),
                                 .limit = number("limit"),
                                 .relation = place.at("relation").text(),
                                 .unit = place.at("unit").text(),
                                 .pose = {},
                                 .text = {}});
}

}  // namespace

WrittenProgram read_program_json(std::string_view text, const std::filesystem::path& file) {
  WrittenProgram program;
  const ProgramJson document = parsed_program(text, file);
  const ProgramPlace root(file, document, "");
  if (const ProgramPlace schema = root.at("schema"); schema.text() != "incise.program/1")
    schema.fail("'" + schema.text() + "'", "incise.program/1");
  for (const ProgramPlace& item : root.at("header").items(0)) {
    const auto pair = item.items(2);
    program.header.emplace_back(pair[0].text(), pair[1].text());
  }
  for (const ProgramPlace& pose : root.at("poses").items(1)) {
    const ProgramPlace phase = pose.at("phase");
    const std::vector<double> tip = pose.at("tip_mm").numbers(3), turn = pose.at("rotation_vector").numbers(3);
    ProgramPose listed{.tip_mm = Vec3(tip[0], tip[1], tip[2]), .rotation_vector = Vec3(turn[0], turn[1], turn[2])};
    listed.time_s = pose.at("time_s").number();
    listed.tip_speed_mm_s = pose.at("tip_speed_mm_s").number();
    listed.depth_mm = pose.at("depth_mm").number();
    listed.phase = phase_of(phase.text(), phase.complain());
    program.listed_poses.push_back(listed);
  }
  if (document.contains("checks")) {
    for (const ProgramPlace& check : root.at("checks").items(0)) program.listed_checks.push_back(check_of(check));
  }
  std::size_t next = 0;
  for (const ProgramPlace& place : root.at("motion").at("samples").items(0)) {
    const std::vector<double> row = place.numbers(13);
    TimedJoints joints{.time_s = row[0]};
    for (int i = 0; i < 6; ++i) {
      joints.q_rad[i] = row[static_cast<std::size_t>(1 + i)];
      joints.speed_rad_s[i] = row[static_cast<std::size_t>(7 + i)];
    }
    while (next + 1 < program.listed_poses.size() && program.listed_poses[next].time_s <= joints.time_s) ++next;
    joints.phase = program.listed_poses[next].phase;
    add_row(program, joints, place.complain());
  }
  if (program.joints.size() < 2)
    throw DataError(file, "/motion/samples", fmt::format("{} samples", program.joints.size()), "at least 2");
  return program;
}

}  // namespace incise::robot_detail
