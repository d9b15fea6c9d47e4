#pragma once

#include <incise/calibration/drag_fit.hpp>
#include <incise/core/names.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// How well the data identify a parameter.
enum class Identified {
  Apart,   ///< posterior sd at most half the prior's
  Partly,  ///< at most nine tenths
  Not,     ///< more: the estimate is the prior
};
inline constexpr std::array<std::string_view, 3> kIdentifiedNames{"apart", "partly", "not"};
[[nodiscard]] constexpr Names names_of(Identified) {
  return kIdentifiedNames;
}

struct ParameterVerdict {
  std::string name;  ///< drag_length, stiffness, bias
  Identified told = Identified::Not;
  double share_of_prior_sd = 1.0;
  std::string tied_to;       ///< parameter with the strongest correlation, if at least 0.7 in magnitude; empty: none
  double correlation = 0.0;  ///< with that parameter; 0: none
  bool is_at_limit = false;  ///< drag length only: interval ends where the simulations end; the truth may lie beyond
};
inline void describe(Visitor& v, ParameterVerdict& p) {
  v.bulk("name", p.name, "Name of the parameter.");
  v("told", p.told, "How well the data identify the parameter.");
  v("share_of_prior_sd", p.share_of_prior_sd, "Posterior sd over that of the prior.");
  std::optional<std::string> tied_to = p.tied_to.empty() ? std::nullopt : std::optional(p.tied_to);
  v("tied_to", tied_to, "The other parameter with which it is most strongly correlated.");
  if (v.sets()) p.tied_to = tied_to.value_or("");
  v("correlation", p.correlation, "Correlation with that parameter.");
  v("at_limit", p.is_at_limit, "Whether its interval ends where the simulations end.");
}

/// How well the photographs identify drag length, stiffness and bias (in this order), and the same in sentences.
struct Identifiability {
  std::array<ParameterVerdict, 3> parameters;
  std::vector<std::string> sentences;
};

/// Returns how well a fit identifies each parameter.
[[nodiscard]] Identifiability identifiability(const DragFit& fit);

}  // namespace incise
