#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace incise::testing {

/// What is wrong with the nesting of tags, or empty. Knows HTML's empty elements and takes script and style content as
/// text.
inline std::string nesting_problem(std::string_view text) {
  static const std::set<std::string, std::less<>> kEmpty{"meta", "img",  "br",       "input",
                                                         "hr",   "link", "!DOCTYPE", "!doctype"};
  std::vector<std::string> open;
  std::size_t at = 0;
  while ((at = text.find('<', at)) != std::string_view::npos) {
    const std::size_t end = text.find('>', at);
    if (end == std::string_view::npos) return "a tag without an end";
    std::string_view tag = text.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag.starts_with("/")) {
      if (open.empty() || open.back() != tag.substr(1))
        return "</" + std::string(tag.substr(1)) + "> closes " + (open.empty() ? "nothing" : open.back());
      open.pop_back();
      continue;
    }
    const std::string name(tag.substr(0, tag.find_first_of(" \n/")));
    if (tag.ends_with("/") || kEmpty.contains(name)) continue;
    open.push_back(name);
    if (name == "script" || name == "style") at = text.find("</" + name, at);
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

/// Every text between `before` and `after`, in order.
inline std::vector<std::string> texts_between(std::string_view text, std::string_view before, std::string_view after) {
  std::vector<std::string> found;
  std::size_t at = 0;
  while ((at = text.find(before, at)) != std::string_view::npos) {
    at += before.size();
    const std::size_t end = text.find(after, at);
    if (end == std::string_view::npos) break;
    found.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return found;
}

/// Decodes base64; fails by returning fewer bytes than the text stands for.
inline std::string decoded_base64(std::string_view text) {
  static constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t value = kAlphabet.find(c);
    if (value == std::string_view::npos) break;
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xffU);
  }
  return bytes;
}

}  // namespace incise::testing
