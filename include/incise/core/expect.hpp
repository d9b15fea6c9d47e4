#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// Notes what is wrong with settings, a sentence a field: "dullness: found -1, expected a number above 0".
class Expect {
 public:
  /// @param violations  that are added to; has to outlive this.
  explicit Expect(std::vector<std::string>& violations) : violations_(violations) {}

  /// A number that is not valid, or not finite.
  void operator()(bool is_valid, std::string_view field, double found, std::string_view expected) const;
  /// A number outside [low, high].
  void in_range(std::string_view field, double found, double low, double high) const;

 private:
  std::vector<std::string>& violations_;
};

}  // namespace incise
