#pragma once

#include <incise/core/describe.hpp>
#include <incise/geometry/types.hpp>
#include <incise/mechanics/constraints.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace incise {

/// What a field is called and means; each field of the case file is described once, where describe_case visits it.
struct FieldInfo {
  const char* name;
  const char* unit;     ///< "" for none
  const char* meaning;  ///< one sentence
};

/// One column of a list of groups.
struct Column {
  FieldInfo info;
  Range range;
  bool is_required = true;
  bool is_whole = false;  ///< whole numbers only
};
using Row = std::vector<std::optional<double>>;  ///< one entry per column; nothing: not given

/// One walk over every field of a tree of settings: reading a file, writing the schema and printing the defaults are three visitors
/// of the same description, so that they cannot disagree. The values' state before the walk are the defaults.
class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;
  virtual void begin_group(const FieldInfo& info) = 0;
  virtual void end_group() = 0;
  virtual void number(const FieldInfo& info, double& value, const Range& range) = 0;
  /// A number that may be absent.
  virtual void optional_number(const FieldInfo& info, std::optional<double>& value, const Range& range) = 0;
  virtual void integer(const FieldInfo& info, int& value, const Range& range) = 0;
  virtual void flag(const FieldInfo& info, bool& value) = 0;
  virtual void text(const FieldInfo& info, std::string& value) = 0;
  /// A file or folder, relative to the case file's folder; empty when absent.
  virtual void path(const FieldInfo& info, std::filesystem::path& value) = 0;
  /// One of `names`; `value` is its position.
  virtual void choice(const FieldInfo& info, std::size_t& value, Names names) = 0;
  /// A fixed count of numbers; `is_given` tells whether an optional one is there.
  virtual void numbers(const FieldInfo& info, std::span<double> values, bool& is_given, const Range& range) = 0;
  /// A direction: a vector, or one of anterior, posterior, left, right, superior, inferior (LPS).
  virtual void direction(const FieldInfo& info, Vec3& value) = 0;
  /// A list of groups of numbers, each with the same columns; may be empty.
  virtual void table(const FieldInfo& info, std::span<const Column> columns, std::vector<Row>& rows) = 0;
  /// The list of constraints; nullopt: the default ones.
  virtual void constraints(const FieldInfo& info, std::optional<std::vector<Constraint>>& value) = 0;
};

}  // namespace incise
