#pragma once

#include <incise/calibration/drag_fit.hpp>
#include <incise/core/names.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// How much the data say of a parameter.
enum class Identified {
  Apart,   ///< its posterior sd is at most half that of the prior
  Partly,  ///< at most nine tenths
  Not,     ///< more: what one has is the prior
};
inline constexpr std::array<std::string_view, 3> kIdentifiedNames{"apart", "partly", "not"};
[[nodiscard]] constexpr Names names_of(Identified) {
  return kIdentifiedNames;
}

struct ParameterVerdict {
  std::string name;  ///< drag_length, stiffness, bias
  Identified told = Identified::Not;
  double share_of_prior_sd = 1.0;
  std::string tied_to;  ///< the other parameter with which it is correlated by at least 0.7 either way; empty: none
  double correlation = 0.0;  ///< with that one; 0: with none
  bool is_at_limit = false;  ///< the interval ends where the simulations end: the truth may lie beyond
};
inline void describe(Visitor& v, ParameterVerdict& p) {
  v.bulk("name", p.name, "Of the parameter.");
  v("told", p.told, "How far the data identify it.");
  v("share_of_prior_sd", p.share_of_prior_sd, "Posterior sd over that of the prior.");
  std::optional<std::string> tied_to = p.tied_to.empty() ? std::nullopt : std::optional(p.tied_to);
  v("tied_to", tied_to, "The other parameter with which it is correlated.");
  if (v.sets()) p.tied_to = tied_to.value_or("");
  v("correlation", p.correlation, "With that one.");
  v("at_limit", p.is_at_limit, "Whether its interval ends where the simulations end.");
}

/// Which of drag length, stiffness and bias the photographs can tell apart, and the same in plain sentences.
struct Identifiability {
  std::array<ParameterVerdict, 3> parameters;
  std::vector<std::string> sentences;
};

[[nodiscard]] Identifiability identifiability(const DragFit& fit);

}  // namespace incise
