#pragma once

#include <incise/geometry/types.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise::io_detail {

/// One value of a JSON document together with its place in it, so that whatever is wrong is told with its JSON pointer.
/// Refers to the document, which has to live longer.
class JsonValue {
 public:
  JsonValue(const nlohmann::ordered_json& value, const std::filesystem::path& file, std::string pointer = "")
      : value_(&value), file_(&file), pointer_(std::move(pointer)) {}

  /// Refuses keys that are not among these, naming the nearest valid one. @throws DataError; also if this is no object.
  void require_only(const std::vector<std::string>& valid_keys) const;
  /// The value under a key. @throws DataError if it is missing, or this is no object.
  [[nodiscard]] JsonValue at(const std::string& key) const;
  [[nodiscard]] std::optional<JsonValue> find(const std::string& key) const;
  /// The items of an array. @throws DataError if this is none, or holds fewer than `least`.
  [[nodiscard]] std::vector<JsonValue> items(std::size_t least = 0) const;

  [[nodiscard]] double number() const;  ///< finite
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] Vec3 point() const;  ///< [x, y, z]
  [[nodiscard]] Mat4 transform() const;  ///< 4 rows of 4 numbers, last row 0 0 0 1, positive determinant

  [[nodiscard]] bool is_text() const { return value_->is_string(); }
  /// What is here, short, for a message.
  [[nodiscard]] std::string shown() const;
  /// @throws DataError "file: pointer: found <found>, expected <expected>. <hint>"
  [[noreturn]] void fail(std::string found, std::string expected, std::string hint = "") const;
  [[noreturn]] void expected(std::string what) const { fail(shown(), std::move(what)); }

 private:
  const nlohmann::ordered_json* value_;
  const std::filesystem::path* file_;
  std::string pointer_;
};

}  // namespace incise::io_detail
