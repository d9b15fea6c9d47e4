#pragma once

#include "field_visitor.hpp"

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>
#include <vector>

namespace incise {

/// Fills a tree of settings from YAML, strictly: what is absent keeps its default, what is unknown or does not fit is a CaseError that
/// says where ("case.yaml line 7"), which field, what was found and what was expected.
class YamlReader : public FieldVisitor {
 public:
  /// @param name  the file's name for messages.
  YamlReader(const YAML::Node& root, std::string name);

  void begin_group(const FieldInfo& info) override;
  void end_group() override;
  void number(const FieldInfo& info, double& value, const Range& range) override;
  void optional_number(const FieldInfo& info, std::optional<double>& value, const Range& range) override;
  void integer(const FieldInfo& info, int& value, const Range& range) override;
  void flag(const FieldInfo& info, bool& value) override;
  void text(const FieldInfo& info, std::string& value) override;
  void path(const FieldInfo& info, std::filesystem::path& value) override;
  void choice(const FieldInfo& info, std::size_t& value, Names names) override;
  void numbers(const FieldInfo& info, std::span<double> values, bool& is_given, const Range& range) override;
  void direction(const FieldInfo& info, Vec3& value) override;
  void table(const FieldInfo& info, std::span<const Column> columns, std::vector<Row>& rows) override;
  void constraints(const FieldInfo& info, std::optional<std::vector<Constraint>>& value) override;

  /// Refuses keys of the outermost level that no field asked for. Call once, after the walk.
  void finish();

 private:
  struct Level {
    YAML::Node node;                ///< a map, or undefined when the group is absent
    std::string name;               ///< dotted, "" for the outermost
    std::vector<std::string> known; ///< fields that were asked for
  };
  [[nodiscard]] YAML::Node take(const char* name);
  [[nodiscard]] std::string field(const char* name) const;
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& field, const std::string& found,
                           const std::string& expected, const std::string& hint = "") const;
  [[nodiscard]] double read_number(const YAML::Node& node, const std::string& field, const Range& range) const;
  void read_numbers(const YAML::Node& node, const std::string& field, std::span<double> values, const Range& range) const;
  void require_map(const YAML::Node& node, const std::string& field) const;
  void refuse_unknown_keys(const YAML::Node& node, const std::string& field, const std::vector<std::string>& known) const;
  [[nodiscard]] Vec3 read_direction(const YAML::Node& node, const std::string& field) const;
  [[nodiscard]] Region read_region(const YAML::Node& node, const std::string& field) const;
  [[nodiscard]] PlaneRegion read_plane_region(const YAML::Node& node, const std::string& field) const;
  [[nodiscard]] std::pair<std::string, double> read_name_and_value(const YAML::Node& node, const std::string& field) const;
  [[nodiscard]] SupportConstraint read_support(const YAML::Node& node, const std::string& field) const;
  [[nodiscard]] Constraint read_constraint(const YAML::Node& node, const std::string& field) const;
  [[nodiscard]] YAML::Node required(const YAML::Node& map, const char* key, const std::string& field, const char* expected) const;

  std::string name_;
  std::vector<Level> levels_;
};

/// Unit vector of an anatomical direction in LPS; nullopt for any other word.
[[nodiscard]] std::optional<Vec3> anatomical_direction(const std::string& word);

}  // namespace incise
