#pragma once

#include <incise/core/describe.hpp>
#include <incise/core/problem.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace incise {

/// Collects problems of settings that the ranges of their description cannot express: values that must fit each other.
class Expect {
 public:
  /// @param violations  list to which problems are added; must outlive this object.
  explicit Expect(std::vector<Problem>& violations) : violations_(violations) {}

  /// Adds a problem if `is_valid` is false or `found` is not finite.
  void operator()(bool is_valid, std::string_view field, double found, std::string_view expected) const;

 private:
  std::vector<Problem>& violations_;
};

/// Returns the numbers of a described value that its description does not allow: not finite, out of range, or a vector
/// that is not a direction (is_direction). Each is named by its path within the value, such as "region.close_margin_mm"
/// or "prony[0].time_s"; of a list of numbers, only the first one is.
template <class T>
[[nodiscard]] std::vector<Problem> problems_of(const T& value);

class DescriptionCheck : public Visitor {
 public:
  [[nodiscard]] bool sets() const override { return false; }
  void begin(const Field& field) override { path_.push_back({place_of(field)}); }
  void end() override { path_.pop_back(); }
  std::size_t begin_list(const Field& field, std::size_t size, std::size_t item_bytes) override;
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
    std::size_t next = 0;  ///< next item of a list
  };
  /// Returns the path of the next value; in a list, advances to the item after it.
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
