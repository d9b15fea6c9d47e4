#include "described_options.hpp"

#include "option_checks.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <vector>

namespace incise::cli {
namespace {

/// Shows one field of a value as option text, or sets it from the given texts; leaves all others.
class OneField : public Visitor {
 public:
  explicit OneField(std::string_view name, const std::vector<std::string>* texts = nullptr)
      : name_(name), texts_(texts) {}

  [[nodiscard]] bool sets() const override { return texts_ != nullptr; }
  void begin(const Field&) override { ++depth_; }
  void end() override { --depth_; }
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t) override {
    is_in_list_ = is_it(field);
    ++depth_;
    if (!is_in_list_) return sets() ? kUnchanged : size;
    count = kUnchanged;
    if (sets()) return texts_->size();
    is_absent = size == 0;
    return is_absent ? kEveryKind : size;
  }
  void end_list() override {
    --depth_;
    is_in_list_ = false;
  }
  bool optional(const Field& field, bool is_there) override {
    if (!is_it(field)) return is_there;
    is_absent = !is_there;
    return true;
  }
  void number(const Field& field, double& value, const Range& range) override {
    if (!is_it(field, "FLOAT", range)) return;
    if (sets()) value = number_from(texts_->front(), range);
    is_absent = is_absent || !contains(range, value);  // such as a scale of 0: not given
    shown = fmt::format("{}", value);
  }
  void integer(const Field& field, std::int64_t& value, const Range& range) override {
    if (is_in_list_)
      describe_it(field, "INT", range);  // the list itself was found by begin_list
    else if (!is_it(field, "INT", range))
      return;
    if (sets()) {
      const std::string& text = texts_->at(is_in_list_ ? item_++ : 0);
      const auto whole = whole_number_in<std::int64_t>(text);
      if (!whole || !contains(range, static_cast<double>(*whole))) refuse_text(text, whole_number(range));
      value = *whole;
    }
    shown += fmt::format("{}{}", shown.empty() ? "" : " ", value);
  }
  void flag(const Field& field, bool& value) override {
    if (!is_it(field)) return;
    count = 0;
    if (sets()) value = true;
  }
  void text(const Field& field, std::string& value) override {
    if (is_it(field, "TEXT") && sets()) value = texts_->front();
  }
  void choice(const Field& field, std::size_t& value, Names names) override {
    if (!is_it(field, "TEXT")) return;
    expected = fmt::format("one of: {}", fmt::join(names, ", "));
    if (sets()) {
      const auto found = std::find(names.begin(), names.end(), texts_->front());
      if (found == names.end()) refuse_text(texts_->front(), fmt::format("one of {}", fmt::join(names, ", ")));
      value = static_cast<std::size_t>(found - names.begin());
    }
    shown = std::string(names[value]);
  }
  void block(const Field& field, const Block& block) override {
    if (!is_in_list_ && !is_it(field)) return;
    describe_it(field, "FLOAT", block.range);
    if (!is_in_list_) count = block.count;
    const std::span<double> values(static_cast<double*>(block.data), block.count);
    for (std::size_t i = 0; sets() && i < values.size(); ++i) values[i] = number_from(texts_->at(i), block.range);
    if (!is_absent) shown = fmt::format("{}", fmt::join(values, " "));
  }

  bool is_found = false;
  bool is_absent = false;                      ///< the field has no value by default
  std::string meaning, type, expected, shown;  ///< `shown`: the value as option text
  std::size_t count = 1;                       ///< of texts; kUnchanged: any; 0: a flag

 private:
  bool is_it(const Field& field, const char* kind = "FLOAT", const Range& range = kAny) {
    if (depth_ > 0 || field.name != name_) return false;
    is_found = true;
    describe_it(field, kind, range);
    return true;
  }
  void describe_it(const Field& field, const char* kind, const Range& range) {
    type = kind;
    if (!field.meaning.empty()) meaning = std::string(field.meaning);
    if (range.least > kAny.least || range.most < kAny.most) expected = describe(range);
  }
  [[nodiscard]] double number_from(const std::string& text, const Range& range) const {
    const std::optional<double> value = number_in(text);
    if (!value || !contains(range, *value)) refuse_text(text, describe(range));
    return *value;
  }
  static std::string whole_number(const Range& range) {
    if (range.most > 1e18) return fmt::format("a whole number of {} or more, in digits", range.least);
    return fmt::format("a whole number from {} to {}, in digits", range.least, range.most);
  }
  [[noreturn]] void refuse_text(const std::string& text, const std::string& wanted) const {
    refuse_value(option_name(name_), text, wanted);
  }

  std::string name_;
  const std::vector<std::string>* texts_;
  int depth_ = 0;
  bool is_in_list_ = false;
  std::size_t item_ = 0;  // of the list
};

}  // namespace

std::string option_name(std::string_view field) {
  std::string name = fmt::format("--{}", field);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

CLI::Option* add_option_of(CLI::App& verb, std::string_view field, const std::function<void(Visitor&)>& walk) {
  OneField known(field);
  walk(known);
  INCISE_REQUIRE(known.is_found, fmt::format("expected a field of these settings, found {}", field));
  std::string help = known.meaning;
  if (help.ends_with('.')) help.pop_back();
  if (!known.expected.empty()) help += fmt::format(" ({})", known.expected);
  const auto set = [walk, name = std::string(field)](const std::vector<std::string>& texts) {
    OneField one(name, &texts);
    walk(one);
  };
  if (known.count == 0)
    return verb.add_flag_callback(
        option_name(field), [set] { set({}); }, help);
  CLI::Option* option = verb.add_option_function<std::vector<std::string>>(option_name(field), set, help);
  if (known.count != Visitor::kUnchanged) option->expected(static_cast<int>(known.count));
  return option->type_name(known.type)->default_str(known.is_absent ? "" : known.shown);
}

}  // namespace incise::cli
