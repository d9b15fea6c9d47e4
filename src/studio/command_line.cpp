#include "command_line.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace incise::studio {
namespace {

/// Returns a word of a command line, quoted for a shell.
std::string word(const std::string& text) {
  const bool is_plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-./=,:").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::string command_line(const std::vector<std::string>& words) {
  std::string line = "incise";
  for (const std::string& one : words) line += " " + word(one);
  return line;
}

}  // namespace incise::studio
