#pragma once

#include <incise/core/problem.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace incise::studio {

/// Returns a problem in the interface's form. @param message  the whole sentence.
inline nlohmann::ordered_json problem_json(const Problem& problem, const std::string& message) {
  return {{"path", problem.path},
          {"found", problem.found},
          {"expected", problem.expected},
          {"hint", problem.hint},
          {"message", message}};
}

}  // namespace incise::studio
