#include "robot/program_digest.hpp"

#include "robot/text_form.hpp"

#include <incise/core/sha256.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace incise::robot_detail {
namespace {

constexpr std::size_t kDigits = 64;
constexpr const char* kAlgorithm = "sha256 ";

/// Position of the digest's digits in a text, as a line or in JSON; nothing if there is no digest, or several.
std::optional<std::size_t> place_of_digits(std::string_view text) {
  const std::array marks{fmt::format("\n{}{}: {}", kHeaderMark, kDigestKey, kAlgorithm),
                         fmt::format("\"{}\",\n      \"{}", kDigestKey, kAlgorithm)};
  std::optional<std::size_t> place;
  for (const std::string& mark : marks) {
    for (std::size_t at = text.find(mark); at != std::string_view::npos; at = text.find(mark, at + 1)) {
      if (place || at + mark.size() + kDigits > text.size()) return std::nullopt;
      place = at + mark.size();
    }
  }
  return place;
}

}  // namespace

ProgramHeader with_digest_entry(ProgramHeader header) {
  // A given entry of this name is not this text's digest.
  std::erase_if(header, [](const auto& entry) { return entry.first == kDigestKey; });
  if (!header.empty()) header.emplace_back(kDigestKey, kAlgorithm + std::string(kDigits, '0'));
  return header;
}

std::string sealed(std::string text) {
  if (const auto place = place_of_digits(text)) text.replace(*place, kDigits, sha256_of_text(text));
  return text;
}

ProgramDigest digest_state(std::string_view text, const ProgramHeader& header) {
  const bool is_there =
      std::any_of(header.begin(), header.end(), [](const auto& entry) { return entry.first == kDigestKey; });
  if (!is_there) return ProgramDigest::Absent;
  const auto place = place_of_digits(text);
  if (!place) return ProgramDigest::Differs;
  std::string blank(text);
  blank.replace(*place, kDigits, std::string(kDigits, '0'));
  return sha256_of_text(blank) == text.substr(*place, kDigits) ? ProgramDigest::Matches : ProgramDigest::Differs;
}

}  // namespace incise::robot_detail
