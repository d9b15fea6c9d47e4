#pragma once

#include <incise/core/describe.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Returns a described value as JSON: an object with a key for each field in the order of the description, without its
/// bulk fields and with its derived ones. An absent value is null (or has no key: Field::is_omitted); a choice is its
/// name; a vector is a list of numbers, a matrix a list of rows.
template <class T>
[[nodiscard]] nlohmann::ordered_json to_json(const T& value);

/// Returns the value that the JSON describes. A field that may be absent is absent where its key is missing or null.
/// Unknown keys are ignored.
/// @param file  names the JSON in messages.  @param pointer  JSON pointer to the value in its file.
/// @param hint  how to make a valid file of this kind; may be empty.
/// @throws DataError with file and JSON pointer: a missing key, a value of another kind, a number out of its range, an
/// unknown choice, null for a field with Field::is_omitted.
template <class T>
[[nodiscard]] T from_json(const nlohmann::ordered_json& json, const std::filesystem::path& file,
                          std::string_view pointer = {}, std::string_view hint = {});

class JsonWriter : public Visitor {
 public:
  [[nodiscard]] bool sets() const override { return false; }
  [[nodiscard]] bool is_summary() const override { return true; }
  void begin(const Field& field) override;
  void end() override { open_.pop_back(); }
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) override;
  bool optional(const Field& field, bool is_there) override;
  void number(const Field& field, double& value, const Range& range) override;
  void integer(const Field& field, std::int64_t& value, const Range& range) override;
  void flag(const Field& field, bool& value) override;
  void text(const Field& field, std::string& value) override;
  void choice(const Field& field, std::size_t& value, Names names) override;
  void block(const Field& field, const Block& block) override;
  [[noreturn]] void refuse(const Field& field, const std::string& found, const std::string& expected) const override;

  [[nodiscard]] nlohmann::ordered_json take() { return std::move(root_); }

 private:
  /// Puts a value under the field's name, or at the end of the open list. @returns the value in its place
  nlohmann::ordered_json& put(const Field& field, nlohmann::ordered_json value);

  nlohmann::ordered_json root_;
  std::vector<nlohmann::ordered_json*> open_;  ///< from the outermost to the innermost; empty: the root is next
};

class JsonReader : public Visitor {
 public:
  /// `json` and `file` must outlive the reader.
  JsonReader(const nlohmann::ordered_json& json, const std::filesystem::path& file, std::string_view pointer = {},
             std::string_view hint = {})
      : root_(&json), file_(file), pointer_(pointer), hint_(hint) {}
  /// Makes the reader refuse keys that the description does not have; the message suggests the nearest known key.
  JsonReader& refuse_unknown_keys() {
    is_strict_ = true;
    return *this;
  }

  [[nodiscard]] bool sets() const override { return true; }
  [[nodiscard]] bool is_summary() const override { return true; }
  void begin(const Field& field) override;
  void end() override;
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) override;
  void end_list() override { open_.pop_back(); }
  bool optional(const Field& field, bool is_there) override;
  void number(const Field& field, double& value, const Range& range) override;
  void integer(const Field& field, std::int64_t& value, const Range& range) override;
  void flag(const Field& field, bool& value) override;
  void text(const Field& field, std::string& value) override;
  void choice(const Field& field, std::size_t& value, Names names) override;
  void block(const Field& field, const Block& block) override;
  void pass_over(const Field& field) override { note(field); }
  [[noreturn]] void refuse(const Field& field, const std::string& found, const std::string& expected) const override;

 private:
  /// An object or list that is being read.
  struct Open {
    const nlohmann::ordered_json* json;
    std::string key;                 ///< of this object or list in its parent
    std::size_t next = 0;            ///< next item of a list
    std::vector<std::string> known;  ///< keys visited so far; empty unless unknown keys are refused
  };
  void note(const Field& field);
  /// Returns the value of a field from the open object or list; null if it is missing.
  const nlohmann::ordered_json* find(const Field& field);
  /// Returns the same. @throws DataError if it is missing, or not of this kind.
  const nlohmann::ordered_json& take(const Field& field, bool (nlohmann::ordered_json::*is_kind)() const noexcept,
                                     std::string_view kind);

  const nlohmann::ordered_json* root_;
  const std::filesystem::path& file_;
  std::string pointer_;
  std::string hint_;
  std::vector<Open> open_;
  bool is_strict_ = false;
  const nlohmann::ordered_json* waiting_ = nullptr;  ///< found by `optional`; the next `find` returns it
};

template <class T>
nlohmann::ordered_json to_json(const T& value) {
  JsonWriter writer;
  writer(Field{}, const_cast<T&>(value));  // a writer changes nothing
  return writer.take();
}

template <class T>
T from_json(const nlohmann::ordered_json& json, const std::filesystem::path& file, std::string_view pointer,
            std::string_view hint) {
  T value{};
  JsonReader reader(json, file, pointer, hint);
  reader(Field{}, value);
  return value;
}

}  // namespace incise
