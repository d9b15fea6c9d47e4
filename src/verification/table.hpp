#pragma once

#include "verification/check.hpp"

#include <functional>

namespace incise {

struct CheckEntry {
  std::string name;
  std::function<VerificationCheck(const CheckContext&)> run;
};

/// Returns every check, in the order in which they run.
[[nodiscard]] const std::vector<CheckEntry>& check_table();

}  // namespace incise
