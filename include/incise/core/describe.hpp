#pragma once

#include <incise/core/ids.hpp>
#include <incise/core/names.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace incise {

/// The numbers that a field may hold.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool is_least_open = false;  ///< `least` itself is not allowed
  bool is_most_open = false;
};
inline constexpr Range kAny{};
inline constexpr Range kPositive{0.0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::infinity(), false, false};

/// Whether a finite number lies in the range.
[[nodiscard]] bool contains(const Range& range, double value);
/// "a number above 0", "a number in [0, 0.5)".
[[nodiscard]] std::string describe(const Range& range);

/// Returns an integer field as a number.
/// @param value  as a visitor receives it. An unsigned value above 2^63 - 1 arrives as its bits, so it is negative.
/// @param range  of the field, which shows whether the field is unsigned.
[[nodiscard]] inline double as_number(std::int64_t value, const Range& range) {
  const bool is_large = value < 0 && range.least >= 0.0 && range.most > 9.3e18;
  return is_large ? static_cast<double>(static_cast<std::uint64_t>(value)) : static_cast<double>(value);
}

/// A value's name in files and on the command line, its unit, and its meaning in one line.
struct Field {
  std::string_view name;
  std::string_view meaning = {};
  std::string_view unit = {};
  std::string_view pattern = {};  ///< regular expression for a text; only the schema states it
  bool is_omitted = false;        ///< a summary has no key for an absent value, instead of a null
};

/// Numbers of one kind, contiguous in memory: a table with `columns` numbers in each row.
struct Block {
  enum class Kind : std::uint8_t { Double, Float, Int32, Int16, UInt8 };
  Kind kind = Kind::Double;
  void* data = nullptr;
  std::size_t count = 0;  ///< numbers in all rows
  std::size_t columns = 1;
  Range range = kAny;         ///< allowed for each number; not checked in binary files
  bool is_direction = false;  ///< a vector whose length does not matter: see core/direction.hpp
};

/// Calls `use` with a pointer to a block's numbers, typed. @returns its result
template <class Use>
auto with_numbers(const Block& block, const Use& use) {
  switch (block.kind) {
    case Block::Kind::Double:
      return use(static_cast<double*>(block.data));
    case Block::Kind::Float:
      return use(static_cast<float*>(block.data));
    case Block::Kind::Int32:
      return use(static_cast<std::int32_t*>(block.data));
    case Block::Kind::Int16:
      return use(static_cast<std::int16_t*>(block.data));
    case Block::Kind::UInt8:
      break;
  }
  return use(static_cast<std::uint8_t*>(block.data));
}

class Visitor;

/// Walks over every field of a value. A type is described once, beside its declaration:
///
///     inline void describe(Visitor& v, Bond& b) {
///       v("tet", b.tet, "The tet that is held.");
///       v({"offset_mm", "Offset of the tet's centroid from the tool's tip at first contact.", "mm"}, b.offset_mm);
///     }
///
/// Files, keys, comparison, schema and reports are visitors of this description, so none of them can miss a field.
/// A visitor either sets values, or only shows them (writes, checks or lists them) and never changes them.
class Visitor {
 public:
  /// Values that a visitor may return instead of a size or a place.
  static constexpr std::size_t kUnchanged = std::numeric_limits<std::size_t>::max();  ///< a list stays as it is
  static constexpr std::size_t kEveryKind = kUnchanged - 1;  ///< show one item or value of each possible kind

  virtual ~Visitor() = default;

  /// Whether the visitor sets values; otherwise it only shows them.
  [[nodiscard]] virtual bool sets() const = 0;
  /// Whether the visitor makes a summary for people and programs, such as a JSON file: see bulk and derived.
  [[nodiscard]] virtual bool is_summary() const { return false; }
  virtual void begin(const Field& field) = 0;  ///< begins a described value; `end` ends it
  virtual void end() = 0;
  /// Begins a list: its items follow, then end_list.
  /// @param size  number of items that the value has now.  @param item_bytes  least size of an item, bytes.
  /// @returns the number of items to visit, kUnchanged or kEveryKind
  virtual std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) = 0;
  virtual void end_list() { end(); }
  /// Called before a value that may be absent.
  /// @returns whether it is present. A visitor that only shows values may return true for an absent one and then
  /// receives a default
  virtual bool optional(const Field& field, bool is_there) = 0;
  virtual void number(const Field& field, double& value, const Range& range) = 0;
  virtual void integer(const Field& field, std::int64_t& value, const Range& range) = 0;
  virtual void flag(const Field& field, bool& value) = 0;
  virtual void text(const Field& field, std::string& value) = 0;
  /// One of `names`; `value` is its index among them.
  virtual void choice(const Field& field, std::size_t& value, Names names) = 0;
  virtual void block(const Field& field, const Block& block) = 0;
  /// Finds which of these fields a group has. It must have exactly one, which is visited next.
  /// @param place  set to the index of the first field present, to kEveryKind (visit all), or to kUnchanged (the whole
  /// group is absent).
  /// @returns how many are present
  virtual std::size_t key(std::size_t& place, std::span<const Field> keys);
  /// Called, while values are set, for a field that is only shown (see derived): the file may contain it.
  virtual void pass_over(const Field& /*field*/) {}
  /// Whether the visitor walks everything that determines a result. Visitors of files that people write do not: such a
  /// file names other files instead of containing them, and lacks the fields that only code may set (see internal).
  [[nodiscard]] virtual bool is_complete() const { return true; }
  /// Refuses a value that was read. @throws DataError, or CaseError where a case is read, naming the place.
  /// A visitor that only shows values throws InvalidArgument: the description is wrong.
  [[noreturn]] virtual void refuse(const Field& field, const std::string& found, const std::string& expected) const;

  template <class T>
  void operator()(std::string_view name, T& value, std::string_view meaning = {}, const Range& range = kAny) {
    visit(Field{name, meaning, {}}, value, range);
  }
  template <class T>
  void operator()(const Field& field, T& value, const Range& range = kAny) {
    visit(field, value, range);
  }
  /// A field that people cannot set in a file: skipped unless is_complete().
  template <class T>
  void internal(std::string_view name, T& value, std::string_view meaning = {}, const Range& range = kAny) {
    if (is_complete()) visit(Field{name, meaning}, value, range);
  }
  /// A vector of which only the direction matters.
  void direction(std::string_view name, Eigen::Vector3d& value, std::string_view meaning = {}) {
    block(Field{name, meaning}, {Block::Kind::Double, value.data(), 3, 3, kAny, true});
  }
  /// The alternative that a variant holds, by its name.
  template <class... T>
  void kind(const Field& field, std::variant<T...>& value) {
    std::size_t place = value.index();
    choice(field, place, names_of(value));
    if (sets()) emplace(value, place);
  }
  /// Sets a variant to the default of one of its alternatives.
  template <class... T>
  static void emplace(std::variant<T...>& value, std::size_t place) {
    std::size_t i = 0;
    ((i++ == place ? static_cast<void>(value = T{}) : static_cast<void>(0)), ...);
  }
  /// A field that summaries omit: it is large, and has its own file if people need it.
  template <class T>
  void bulk(std::string_view name, T& value, std::string_view meaning) {
    if (!is_summary()) visit(Field{name, meaning, {}}, value, kAny);
  }
  /// A value that follows from other fields: a summary shows it, and it is not read back.
  template <class T>
  void derived(std::string_view name, T value, std::string_view meaning) {
    if (!is_summary()) return;
    if (sets()) return pass_over(Field{name, meaning});
    visit(Field{name, meaning}, value, kAny);
  }

 private:
  template <class T>
  void visit(const Field& field, T& value, const Range& range);
  template <class T>
  void visit_list(const Field& field, std::vector<T>& values, const Range& range);
};

namespace describe_detail {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t N>
inline constexpr bool kIsArray<std::array<T, N>> = true;
template <class T>
inline constexpr bool kIsId = false;
template <class Tag>
inline constexpr bool kIsId<Id<Tag>> = true;
template <class T>
inline constexpr bool kIsMatrix = false;
template <int R, int C>
inline constexpr bool kIsMatrix<Eigen::Matrix<double, R, C>> = (R > 0 && C > 0);

template <class T>
inline constexpr bool kIsVariant = false;
template <class... T>
inline constexpr bool kIsVariant<std::variant<T...>> = true;
template <class T>
constexpr std::size_t kinds_of() {
  if constexpr (kIsVariant<T>) return std::variant_size_v<T>;
  return 1;
}
template <class T>
inline constexpr bool kIsShared = false;
template <class T>
inline constexpr bool kIsShared<std::shared_ptr<const T>> = true;

/// Returns the kind and count of the numbers that a T consists of; nullopt if it is not contiguous numbers of one kind.
template <class T>
constexpr std::optional<std::pair<Block::Kind, std::size_t>> layout_of() {
  if constexpr (std::is_same_v<T, double>) return std::pair{Block::Kind::Double, std::size_t{1}};
  if constexpr (std::is_same_v<T, float>) return std::pair{Block::Kind::Float, std::size_t{1}};
  if constexpr (std::is_same_v<T, std::int32_t>) return std::pair{Block::Kind::Int32, std::size_t{1}};
  if constexpr (std::is_same_v<T, std::int16_t>) return std::pair{Block::Kind::Int16, std::size_t{1}};
  if constexpr (std::is_same_v<T, std::uint8_t>) return std::pair{Block::Kind::UInt8, std::size_t{1}};
  if constexpr (kIsId<T>) return std::pair{Block::Kind::Int32, std::size_t{1}};
  if constexpr (kIsMatrix<T>) return std::pair{Block::Kind::Double, sizeof(T) / sizeof(double)};
  if constexpr (kIsArray<T>) {
    constexpr auto kItem = layout_of<typename T::value_type>();
    if constexpr (kItem.has_value()) return std::pair{kItem->first, kItem->second * std::tuple_size_v<T>};
  }
  return std::nullopt;
}

}  // namespace describe_detail

template <class T>
void Visitor::visit(const Field& field, T& value, const Range& range) {
  using namespace describe_detail;
  if constexpr (std::is_same_v<T, bool>) {
    flag(field, value);
  } else if constexpr (std::is_same_v<T, double>) {
    number(field, value, range);
  } else if constexpr (std::is_same_v<T, std::string>) {
    text(field, value);
  } else if constexpr (std::is_enum_v<T>) {
    static_assert(Named<T>, "an enum that is described has a function names_of beside it");
    auto place = static_cast<std::size_t>(value);
    choice(field, place, names_of(value));
    if (sets()) value = static_cast<T>(place);
  } else if constexpr (std::is_integral_v<T>) {
    auto wide = static_cast<std::int64_t>(value);
    Range within = range;
    within.least = std::max(within.least, static_cast<double>(std::numeric_limits<T>::lowest()));
    within.most = std::min(within.most, static_cast<double>(std::numeric_limits<T>::max()));
    integer(field, wide, within);
    if (sets()) value = static_cast<T>(wide);
  } else if constexpr (kIsId<T>) {
    visit(field, value.value, range);
  } else if constexpr (kIsOptional<T>) {
    if (!optional(field, value.has_value())) {
      if (sets()) value.reset();
      return;
    }
    if (value) return visit(field, *value, range);
    typename T::value_type made{};
    visit(field, made, range);
    if (sets()) value = std::move(made);
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    std::optional<std::string> name;
    if (!value.empty()) name = value.generic_string();
    visit(field, name, range);
    if (sets()) value = name.value_or("");
  } else if constexpr (kIsShared<T>) {
    const bool is_there = optional(field, value != nullptr);
    std::remove_const_t<typename T::element_type> own;
    if (is_there && !sets()) own = *value;
    if (is_there) visit(field, own, range);
    if (sets()) value = is_there ? std::make_shared<const typename T::element_type>(std::move(own)) : nullptr;
  } else if constexpr (kIsMatrix<T>) {
    if constexpr (T::ColsAtCompileTime > 1) {  // row by row, as people write it
      Eigen::Matrix<double, T::ColsAtCompileTime, T::RowsAtCompileTime> rows = value.transpose();
      block(field, {Block::Kind::Double, rows.data(), static_cast<std::size_t>(rows.size()),
                    static_cast<std::size_t>(rows.rows()), range});
      if (sets()) value = rows.transpose();
    } else {
      block(field, {Block::Kind::Double, value.data(), static_cast<std::size_t>(value.size()),
                    static_cast<std::size_t>(value.rows()), range});
    }
  } else if constexpr (std::is_same_v<T, Eigen::AlignedBox3d>) {
    std::array<Eigen::Vector3d, 2> corners{value.min(), value.max()};
    visit(field, corners, range);
    if (sets()) value = T(corners[0], corners[1]);
  } else if constexpr (kIsArray<T>) {
    constexpr auto kLayout = layout_of<typename T::value_type>();
    if constexpr (kLayout.has_value()) {
      block(field, {kLayout->first, value.data(), value.size() * kLayout->second, kLayout->second, range});
    } else {
      const std::size_t size = begin_list(field, value.size(), 1);
      if (size != value.size()) refuse(field, std::to_string(size) + " items", std::to_string(value.size()));
      for (auto& item : value) visit(Field{}, item, range);
      end_list();
    }
  } else if constexpr (kIsVector<T>) {
    visit_list(field, value, range);
  } else {
    begin(field);
    describe(*this, value);
    end();
  }
}

template <class T>
void Visitor::visit_list(const Field& field, std::vector<T>& values, const Range& range) {
  constexpr auto kLayout = describe_detail::layout_of<T>();
  const std::size_t size = begin_list(field, values.size(), kLayout.has_value() ? sizeof(T) : 1);
  if (size == kUnchanged) return end_list();
  if (sets()) values.clear();
  if constexpr (kLayout.has_value()) {
    if (sets()) values.resize(size);
    block({}, {kLayout->first, values.data(), values.size() * kLayout->second, kLayout->second, range});
  } else if (size == kEveryKind) {
    constexpr std::size_t kKinds = describe_detail::kinds_of<T>();
    for (std::size_t i = 0; i < kKinds; ++i) {
      T made{};
      if constexpr (describe_detail::kIsVariant<T>) emplace(made, i);
      visit(Field{}, made, range);
    }
  } else {
    for (std::size_t i = 0; i < size; ++i) {
      if (sets()) values.emplace_back();
      visit(Field{}, values[i], range);
    }
  }
  end_list();
}

/// Describes one of several types; the key `kind` names it. A variant type may replace this by its own description.
template <class... T>
void describe(Visitor& v, std::variant<T...>& value) {
  v.kind(Field{"kind", "Which of the types it is."}, value);
  std::visit([&v](auto& own) { describe(v, own); }, value);
}

/// Describes a map: its names in order, then the value of each name.
template <class V>
void describe(Visitor& v, std::map<std::string, V>& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  v("names", names, "Names of the values that follow.");
  if (v.sets()) values.clear();
  for (const std::string& name : names) v(name, values[name]);
}

/// Returns a number as a summary shows it if it may be unknown: nullopt where it is not finite.
[[nodiscard]] inline std::optional<double> if_finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Describes a field with one possible value, such as the format of a file with its version. Other values are refused.
inline void constant(Visitor& v, const Field& field, std::string_view only) {
  std::size_t place = 0;
  v.choice(field, place, Names(&only, 1));
}

}  // namespace incise
