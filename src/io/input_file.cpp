#include "io/number_text.hpp"

#include <incise/core/error.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/manifest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {
namespace {

namespace fs = std::filesystem;

/// Returns the status of a path, following links. @throws DataError if there is nothing.
fs::file_status status_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw DataError(path, "", "no such file", "a readable file");
  return status;
}

constexpr std::size_t kLongestHeader = 64 << 10;  // bytes; a header that lists its slices is long

/// Returns the trimmed lines in the first kLongestHeader bytes of a file.
std::vector<std::string> header_lines(const fs::path& path) {
  const std::string text = beginning_of(path, kLongestHeader);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.emplace_back(io_detail::trimmed(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  return lines;
}

/// Returns the value of "key: value" or "key = value"; nothing for any other line. Ignores the case of the line's key.
std::optional<std::string> value_after(const std::string& line, std::string_view key, char mark) {
  const std::size_t at = line.find(mark);
  if (at == std::string::npos || io_detail::lower_case(io_detail::trimmed(std::string_view(line).substr(0, at))) != key) return std::nullopt;
  return std::string(io_detail::trimmed(std::string_view(line).substr(at + 1)));
}

constexpr int kMostSlices = 100000;

/// Returns the names of a numbered series such as "slice%03d.raw 1 20 1"; none for text of any other form.
std::vector<std::string> numbered(const std::string& value) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < value.size();) {
    const std::size_t end = std::min(value.find_first_of(" \t", begin), value.size());
    if (end > begin) words.push_back(value.substr(begin, end - begin));
    begin = end + 1;
  }
  std::vector<std::string> names;
  const std::size_t percent = words.empty() ? std::string::npos : words[0].find('%');
  if (words.size() < 3 || percent == std::string::npos) return names;
  const std::size_t end = words[0].find('d', percent);
  if (end == std::string::npos) return names;
  const std::string width_text = words[0].substr(percent + 1, end - percent - 1);
  const auto first = io_detail::to_integer(words[1]), last = io_detail::to_integer(words[2]);
  const auto step = words.size() > 3 ? io_detail::to_integer(words[3]) : std::optional<long long>(1);
  const auto width = width_text.empty() ? std::optional<long long>(0) : io_detail::to_integer(width_text);
  constexpr long long kGreatest = 1'000'000'000;  // no sum or difference overflows
  const auto is_small = [](const std::optional<long long>& n) { return n && *n >= -kGreatest && *n <= kGreatest; };
  if (!is_small(first) || !is_small(last) || !is_small(step) || !width || *step < 1 || *width < 0 || *width > 20 ||
      (*last - *first) / *step > kMostSlices)
    return names;
  for (long long number = *first; number <= *last; number += *step) {
    const bool is_padded = !width_text.empty() && width_text[0] == '0';
    const std::string digits = is_padded ? fmt::format("{:0{}}", number, *width) : fmt::format("{:{}}", number, *width);
    names.push_back(words[0].substr(0, percent) + digits + words[0].substr(end + 1));
  }
  return names;
}

/// Returns the data files that a header's line `at` names: one file, a numbered series, or the lines that follow it.
std::vector<std::string> named_data(const std::vector<std::string>& lines, std::size_t at, const std::string& value) {
  const std::string word = io_detail::lower_case(value.substr(0, value.find_first_of(" \t")));
  if (word == "local") return {};
  if (word == "list") {
    std::vector<std::string> names;
    for (std::size_t i = at + 1; i < lines.size() && names.size() < kMostSlices; ++i) {
      if (!lines[i].empty()) names.push_back(lines[i]);
    }
    return names;
  }
  std::vector<std::string> names = numbered(value);
  return names.empty() ? std::vector<std::string>{value} : names;
}

void add_named(const fs::path& header, std::initializer_list<std::string_view> keys, char mark, std::vector<fs::path>& files) {
  const std::vector<std::string> lines = header_lines(header);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const std::string_view key : keys) {
      const std::optional<std::string> value = value_after(lines[i], key, mark);
      if (!value || value->empty()) continue;
      for (const std::string& name : named_data(lines, i, *value)) files.push_back(header.parent_path() / name);
      return;
    }
  }
}

}  // namespace

std::string kind_of_file(const fs::path& path) {
  switch (status_of(path).type()) {
    case fs::file_type::regular:
      return "a file";
    case fs::file_type::directory:
      return "a folder";
    case fs::file_type::fifo:
      return "a pipe";
    case fs::file_type::character:
    case fs::file_type::block:
      return "a device";
    case fs::file_type::socket:
      return "a socket";
    default:
      return "something that is not a file";
  }
}

void require_regular_file(const fs::path& path, std::uint64_t most_bytes) {
  const fs::file_status status = status_of(path);
  if (!fs::is_regular_file(status)) throw DataError(path, "", kind_of_file(path), "a file");
  std::error_code error;
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw DataError(path, "", system_reason(error), "a readable file");
  if (size > most_bytes) {
    throw DataError(path, "size", fmt::format("{} bytes", size), fmt::format("at most {} bytes for a file of this kind", most_bytes));
  }
}

void require_file_or_folder(const fs::path& path) {
  if (!fs::is_directory(status_of(path))) require_regular_file(path);
}

std::string beginning_of(const fs::path& path, std::size_t most_bytes) {
  std::ifstream stream(path, std::ios::binary);
  std::string text(most_bytes, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

std::vector<fs::path> input_files(const fs::path& path) {
  require_file_or_folder(path);
  std::vector<fs::path> files;
  if (fs::is_directory(path)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
  }
  files.push_back(path);
  const std::string ending = io_detail::lower_case(path.extension().string());
  if (ending == ".mhd" || ending == ".mha") add_named(path, {"elementdatafile"}, '=', files);
  if (ending == ".nhdr" || ending == ".nrrd") add_named(path, {"data file", "datafile"}, ':', files);
  if (ending == ".node") files.push_back(fs::path(path).replace_extension(".ele"));
  if (ending == ".ele") files.push_back(fs::path(path).replace_extension(".node"));
  return files;
}

std::string sha256_of_input(const fs::path& path) {
  if (fs::is_directory(path)) return sha256_of_folder(path);
  const std::vector<fs::path> files = input_files(path);
  if (files.size() == 1 && files.front() == path) return sha256_of_file(path);
  std::string lines;
  for (const fs::path& file : files) {
    std::error_code error;
    const std::string hash = fs::is_regular_file(file, error) ? sha256_of_file(file) : std::string("missing");
    lines += fmt::format("{}  {}\n", hash, file.lexically_relative(path.parent_path()).generic_string());
  }
  return sha256_of_text(lines);
}

}  // namespace incise
