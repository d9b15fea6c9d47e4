#pragma once

#include <incise/core/describe.hpp>

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Reads described fields from YAML, strictly. An absent field keeps its default; an unknown key or an unsuitable value
/// throws CaseError with place ("case.yaml line 7"), field, found and expected. In an item of a list, every field that
/// is not optional is required.
class YamlReader : public Visitor {
 public:
  /// @param name  name of the file, for messages
  YamlReader(const YAML::Node& root, std::string name);

  [[nodiscard]] bool sets() const override { return true; }
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
  [[noreturn]] void refuse(const Field& field, const std::string& found, const std::string& expected) const override;

  /// Refuses keys of the outermost level that no field asked for. Call once, after the walk.
  void finish() { end(); }

 private:
  struct Level {
    YAML::Node node;   ///< a map or list, or undefined where it is absent
    std::string name;  ///< dotted, "" for the outermost
    bool is_list = false;
    bool is_of_item = false;            ///< an item of a list, an optional group, or inside one
    std::size_t next = 0;               ///< item
    std::vector<std::string> known;     ///< fields that were visited
    std::vector<std::string> required;  ///< required fields whose description has no meaning
    std::optional<Field> missing;       ///< the first required field that is absent
  };
  [[nodiscard]] YAML::Node find(std::string_view name) const;
  [[nodiscard]] YAML::Node take(const Field& field);
  [[nodiscard]] std::string path_of(std::string_view name) const;
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& path, const std::string& found,
                           const std::string& expected, const std::string& hint = "") const;
  [[nodiscard]] double read_number(const YAML::Node& node, const std::string& path, const Range& range) const;
  void whole_numbers(const Field& field, const Block& block);
  void read_numbers(const YAML::Node& node, const std::string& path, const Block& block) const;
  void require_map(const YAML::Node& node, const std::string& path) const;
  void refuse_unknown_keys(const Level& level) const;

  std::string name_;
  std::vector<Level> levels_;
  bool is_optional_ = false;  ///< whether the next field is optional
};

}  // namespace incise
