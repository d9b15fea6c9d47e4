#pragma once

#include <incise/core/problem.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Notes what is wrong with settings, a sentence a field: "dullness: found -1, expected a number above 0".
class Expect {
 public:
  /// @param violations  that are added to; has to outlive this.
  explicit Expect(std::vector<Problem>& violations) : problems_(&violations) {}
  explicit Expect(std::vector<std::string>& violations) : sentences_(&violations) {}

  /// A number that is not valid, or not finite.
  void operator()(bool is_valid, std::string_view field, double found, std::string_view expected) const;
  /// A number outside [low, high].
  void in_range(std::string_view field, double found, double low, double high) const;

 private:
  void note(const Problem& problem) const;
  std::vector<Problem>* problems_ = nullptr;
  std::vector<std::string>* sentences_ = nullptr;
};

}  // namespace incise
