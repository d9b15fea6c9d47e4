#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace incise {

/// Notes what is wrong with settings beyond the ranges of their description: values that have to fit each other.
class Expect {
 public:
  /// @param violations  that are added to; has to outlive this.
  explicit Expect(std::vector<Problem>& violations) : violations_(violations) {}

  /// A number that is not valid, or not finite.
  void operator()(bool is_valid, std::string_view field, double found, std::string_view expected) const;

 private:
  std::vector<Problem>& violations_;
};

/// The numbers of a described value that its description does not allow: not finite, out of range, a direction of
/// length 0. Each is named by its path from the value on: "region.close_margin_mm", "prony[0].time_s". Of a list of
/// numbers only the first one is named.
template <class T>
[[nodiscard]] std::vector<Problem> problems_of(const T& value);

class DescriptionCheck : public Visitor {
 public:
  [[nodiscard]] bool sets() const override { return false; }
  void begin(const Field& field) override { path_.push_back({place_of(field)}); }
  void end() override { path_.pop_back(); }
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) override;
  void end_list() override { path_.pop_back(); }
  bool optional(const Field&, bool is_there) override { return is_there; }
  void number(const Field& field, double& value, const Range& range) override;
  void integer(const Field& field, std::int64_t& value, const Range& range) override;
  void flag(const Field& field, bool&) override { static_cast<void>(place_of(field)); }
  void text(const Field& field, std::string&) override { static_cast<void>(place_of(field)); }
  void choice(const Field& field, std::size_t&, Names) override { static_cast<void>(place_of(field)); }
  void block(const Field& field, const Block& block) override;

  [[nodiscard]] std::vector<Problem> take() { return std::move(problems_); }

 private:
  struct Level {
    std::string path;
    bool is_list = false;
    std::size_t next = 0;  ///< item of a list
  };
  /// The path of the value that comes next; counts it where it is an item of a list.
  std::string place_of(const Field& field);

  std::vector<Level> path_;
  std::vector<Problem> problems_;
};

template <class T>
std::vector<Problem> problems_of(const T& value) {
  DescriptionCheck check;
  check(Field{}, const_cast<T&>(value));  // it changes nothing
  return check.take();
}

}  // namespace incise
