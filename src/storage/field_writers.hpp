#pragma once

#include <incise/core/describe.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace incise {

/// Builds the JSON Schema of the described type, with the present values as defaults. In items of a list and in
/// optional groups, only optional fields have defaults.
class SchemaWriter : public Visitor {
 public:
  [[nodiscard]] bool sets() const override { return false; }
  [[nodiscard]] bool is_complete() const override { return false; }
  void begin(const Field& field) override;
  void end() override;
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) override;
  void end_list() override;
  bool optional(const Field& field, bool is_there) override;
  void number(const Field& field, double& value, const Range& range) override;
  void integer(const Field& field, std::int64_t& value, const Range& range) override;
  void flag(const Field& field, bool& value) override;
  void text(const Field& field, std::string& value) override;
  void choice(const Field& field, std::size_t& value, Names names) override;
  void block(const Field& field, const Block& block) override;
  std::size_t key(std::size_t& place, std::span<const Field> keys) override;
  /// Returns the properties of the outermost level.
  [[nodiscard]] nlohmann::ordered_json properties() const { return levels_.front().properties; }

 private:
  struct Level {
    Field field;
    bool is_optional = false;
    bool is_of_item = false;  ///< an item of a list, an optional group, or inside one
    nlohmann::ordered_json properties = nlohmann::ordered_json::object();
    nlohmann::ordered_json items = nlohmann::ordered_json::array();  ///< of a list: one of each kind
    std::vector<std::string> required;
    std::vector<std::string> keys;  ///< exactly one of them must exist
  };
  Level& open(const Field& field);
  [[nodiscard]] Level close();
  void add(const Field& field, nlohmann::ordered_json schema);
  template <class Value>
  void add_with_default(const Field& field, nlohmann::ordered_json schema, const Value& value);
  std::vector<Level> levels_ = std::vector<Level>(1);
  std::optional<bool> is_there_;  ///< set if the next field is optional: whether it has a value
};

/// Lists every setting as one line, in order; absent optional ones have an empty value. A whole list is one line.
class SettingLister : public Visitor {
 public:
  struct Line {
    std::string group;  ///< dotted
    std::string name;
    std::string value;
    std::string unit;
    std::string meaning;
    bool is_group = false;
  };
  [[nodiscard]] bool sets() const override { return false; }
  [[nodiscard]] bool is_complete() const override { return false; }
  void begin(const Field& field) override;
  void end() override;
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) override;
  void end_list() override;
  bool optional(const Field& field, bool is_there) override;
  void number(const Field& field, double& value, const Range& range) override;
  void integer(const Field& field, std::int64_t& value, const Range& range) override;
  void flag(const Field& field, bool& value) override;
  void text(const Field& field, std::string& value) override;
  void choice(const Field& field, std::size_t& value, Names names) override;
  void block(const Field& field, const Block& block) override;
  std::size_t key(std::size_t&, std::span<const Field>) override { return 1; }
  [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }

 private:
  void add(const Field& field, std::string value, bool is_group = false);
  void open(const Field& field, char bracket);
  void close(char bracket);
  std::vector<Line> lines_;
  std::vector<std::string> groups_;
  std::string list_;       ///< the list that is open, as far as it is written
  std::size_t depth_ = 0;  ///< of brackets that are open in it
};

}  // namespace incise
