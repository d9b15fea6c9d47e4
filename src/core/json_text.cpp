#include <incise/core/error.hpp>
#include <incise/core/json_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace incise {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostKeys = 5000;  // in one object; files of incise have a few hundred at most
constexpr int kDeepestJson =
    64;  // deeper than any file of incise; code that walks through the values recurses once per level

void require_finite(const ordered_json& value, const std::string& pointer) {
  if (value.is_number_float()) {
    INCISE_REQUIRE(std::isfinite(value.get<double>()),
                   fmt::format("expected a finite number at {}, found {}", pointer, value.get<double>()));
  } else if (value.is_object()) {
    for (const auto& [key, item] : value.items()) require_finite(item, pointer + "/" + key);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) require_finite(value[i], fmt::format("{}/{}", pointer, i));
  }
}

std::string line_and_column(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return fmt::format("line {}, column {}", line, before.size() - begin + 1);
}

/// Refuses repeated keys, objects with too many keys and values nested too deep. The JSON library silently keeps the
/// last of two equal keys, and finds a key by searching all of them.
class KeyWatch {
 public:
  explicit KeyWatch(const std::filesystem::path& name) : name_(name) {}

  bool operator()(int depth, ordered_json::parse_event_t event, ordered_json& parsed) {
    if (depth > kDeepestJson)
      throw DataError(name_, "", fmt::format("values nested more than {} deep", kDeepestJson),
                      "JSON with less nesting");
    if (event == ordered_json::parse_event_t::object_start) keys_.emplace_back();
    if (event == ordered_json::parse_event_t::object_end) keys_.pop_back();
    if (event == ordered_json::parse_event_t::key && !keys_.back().insert(parsed.get<std::string>()).second) {
      throw DataError(name_, "", fmt::format("the key '{}' twice in one object", parsed.get<std::string>()),
                      "each key once");
    }
    if (!keys_.empty() && keys_.back().size() > kMostKeys)
      throw DataError(name_, "", fmt::format("more than {} keys in one object", kMostKeys), "fewer");
    return true;
  }

 private:
  const std::filesystem::path& name_;
  std::vector<std::set<std::string>> keys_;
};

}  // namespace

std::string json_text(const ordered_json& value) {
  require_finite(value, "");
  return value.dump(2) + "\n";
}

ordered_json parse_json(std::string_view text, const std::filesystem::path& name) {
  if (text.size() > kLargestJsonBytes)
    throw DataError(name, "size", fmt::format("{} bytes", text.size()),
                    fmt::format("at most {} bytes of JSON", kLargestJsonBytes));
  try {
    return ordered_json::parse(text, KeyWatch(name));
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    const std::string found = byte >= text.size() ? "the end of the text" : fmt::format("'{}'", text.substr(byte, 1));
    throw DataError(name, line_and_column(text, byte), found, "JSON");
  } catch (const nlohmann::json::out_of_range&) {
    throw DataError(name, "", "a number beyond 1.8e308", "numbers that a double can hold");
  }
}

}  // namespace incise
