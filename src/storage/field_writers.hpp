#pragma once

#include "field_visitor.hpp"

#include <incise/storage/case_file.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace incise {

/// Builds the JSON Schema of the fields that it visits: the values found are the defaults.
class SchemaWriter : public FieldVisitor {
 public:
  SchemaWriter();
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
  /// Properties of the outermost level.
  [[nodiscard]] nlohmann::ordered_json properties() const { return levels_.front(); }

 private:
  void add(const FieldInfo& info, nlohmann::ordered_json schema);
  std::vector<nlohmann::ordered_json> levels_;
  std::vector<FieldInfo> groups_;
};

/// Lists every setting as one line, in order; absent optional ones have an empty value.
class SettingLister : public FieldVisitor {
 public:
  struct Line {
    std::string group;  ///< dotted
    std::string name;
    std::string value;
    std::string unit;
    std::string meaning;
    bool is_group = false;
  };
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
  [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }

 private:
  void add(const FieldInfo& info, std::string value);
  std::vector<Line> lines_;
  std::vector<std::string> groups_;
};

}  // namespace incise
