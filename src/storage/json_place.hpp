#pragma once

#include <incise/core/error.hpp>
#include <incise/geometry/contour.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// A JSON object of a result file, and where in that file it is: reads values with their kind checked.
/// Every reader throws DataError naming file and key, what was found and what was expected.
struct JsonPlace {
  const std::filesystem::path& path;
  const nlohmann::ordered_json& object;
  std::string prefix;  ///< of the keys, with a dot at its end; empty at the top
  const char* hint;    ///< how such a file is made

  [[noreturn]] void refuse(const std::string& key, const std::string& found, const std::string& expected) const;
  [[nodiscard]] bool has(const std::string& key) const { return object.contains(key); }
  [[nodiscard]] const nlohmann::ordered_json& at(const std::string& key, const char* expected) const;
  [[nodiscard]] double number(const std::string& key) const;
  [[nodiscard]] double number_between(const std::string& key, double low, double high) const;  ///< both included
  [[nodiscard]] std::string text(const std::string& key) const;
  [[nodiscard]] bool flag(const std::string& key) const;
  [[nodiscard]] std::optional<double> number_or_null(const std::string& key) const;
  [[nodiscard]] std::optional<bool> flag_or_null(const std::string& key) const;
  [[nodiscard]] std::vector<double> numbers(const std::string& key) const;
  [[nodiscard]] JsonPlace inside(const std::string& key) const;
  /// The objects of a list, each as a place.
  [[nodiscard]] std::vector<JsonPlace> objects(const std::string& key) const;
};

/// The contour that contour_json wrote, closed. @throws DataError for fewer than 3 points, lists of different length,
/// or a coordinate farther from 0 than any scan or robot reaches.
[[nodiscard]] Contour contour_of(const JsonPlace& place);

}  // namespace incise
