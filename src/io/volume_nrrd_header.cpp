#include "io/volume_nrrd_header.hpp"

#include "io/number_text.hpp"
#include "io/volume_stack.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace incise {
namespace {

constexpr std::size_t kAxes = 3;
constexpr std::size_t kLongestShown = 60;

/// Returns the value of a field "key: value"; `key:=value` is a user's remark, not a field.
std::optional<std::string> field(const std::string& header, std::string_view key) {
  for (std::size_t begin = 0; begin < header.size();) {
    const std::size_t end = std::min(header.find('\n', begin), header.size());
    const std::string_view line = std::string_view(header).substr(begin, end - begin);
    const bool is_it =
        line.starts_with(key) && line.substr(key.size()).starts_with(":") && !line.substr(key.size()).starts_with(":=");
    if (is_it) return std::string(io_detail::trimmed(line.substr(key.size() + 1)));
    begin = end + 1;
  }
  return std::nullopt;
}

std::vector<std::string> split(std::string_view text, std::string_view separators) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; (at = text.find_first_not_of(separators, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    parts.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return parts;
}

/// Returns the length of the vector in "x,y,z"; NaN if the text is not a vector.
double length_of(std::string_view vector) {
  double squares = 0.0;
  for (const std::string& part : split(vector, ", \t")) {
    const std::optional<double> value = io_detail::to_number(part);
    if (!value) return std::nan("");
    squares += *value * *value;
  }
  return std::sqrt(squares);
}

/// Returns the length of every axis that has a vector "(x,y,z)", in order.
std::vector<double> lengths_of_directions(std::string_view text) {
  std::vector<double> lengths;
  for (std::size_t open = 0; (open = text.find('(', open)) != std::string_view::npos;) {
    const std::size_t close = std::min(text.find(')', open), text.size());
    lengths.push_back(length_of(text.substr(open + 1, close - open - 1)));
    open = close;
  }
  return lengths;
}

std::vector<double> lengths_of_spacings(std::string_view text) {
  std::vector<double> lengths;
  for (const std::string& part : split(text, " \t"))
    lengths.push_back(io_detail::to_number(part).value_or(std::nan("")));
  return lengths;
}

void require_lengths(const std::filesystem::path& path, const char* key, const std::string& text,
                     const std::vector<double>& lengths) {
  if (lengths.size() < kAxes) {
    throw DataError(path, key, fmt::format("'{}'", text.substr(0, kLongestShown)), "the voxel size along three axes");
  }
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    if (lengths[axis] >= kFinestVoxelMm && lengths[axis] <= kCoarsestVoxelMm) continue;
    throw DataError(
        path, key,
        fmt::format("voxel spacing {:.4g} along axis {} ('{}')", lengths[axis], axis, text.substr(0, kLongestShown)),
        fmt::format("voxels of {} to {} mm", kFinestVoxelMm, kCoarsestVoxelMm), "Lengths are mm");
  }
}

/// Refuses units other than mm. An axis without a unit is taken as mm.
void require_millimetres(const std::filesystem::path& path, const char* key, const std::string& header) {
  constexpr std::array<std::string_view, 5> kMillimetres{"mm", "millimeter", "millimeters", "millimetre",
                                                         "millimetres"};
  const std::optional<std::string> text = field(header, key);
  if (!text) return;
  std::size_t axis = 0;
  for (std::size_t open = 0; axis < kAxes && (open = text->find('"', open)) != std::string::npos; ++axis) {
    const std::size_t close = std::min(text->find('"', open + 1), text->size());
    const std::string_view unit = io_detail::trimmed(std::string_view(*text).substr(open + 1, close - open - 1));
    if (!unit.empty() && std::find(kMillimetres.begin(), kMillimetres.end(), unit) == kMillimetres.end()) {
      throw DataError(path, key, fmt::format("'{}' for axis {}", unit.substr(0, kLongestShown), axis), "\"mm\"",
                      "Convert the volume to millimetres.");
    }
    open = close + 1;
  }
  if (axis == 0)
    throw DataError(path, key, fmt::format("'{}'", text->substr(0, kLongestShown)),
                    "a unit in quotes for every axis: \"mm\"");
}

}  // namespace

void require_stated_nrrd_geometry(const std::filesystem::path& path, const std::string& header) {
  const std::optional<std::string> directions = field(header, "space directions"), spacings = field(header, "spacings");
  if (!directions && !spacings) throw DataError(path, "header", "no voxel spacing", "'space directions' or 'spacings'");
  if (directions) require_lengths(path, "space directions", *directions, lengths_of_directions(*directions));
  if (spacings) require_lengths(path, "spacings", *spacings, lengths_of_spacings(*spacings));
  require_millimetres(path, "space units", header);
  require_millimetres(path, "units", header);
}

bool names_nrrd_space(const std::string& header) {
  return field(header, "space").has_value();
}

}  // namespace incise
