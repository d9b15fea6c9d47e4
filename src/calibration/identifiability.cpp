#include <incise/calibration/identifiability.hpp>

#include <fmt/format.h>

#include <cmath>

namespace incise {
namespace {

constexpr double kApartShare = 0.5;
constexpr double kNotShare = 0.9;
constexpr double kTied = 0.7;
constexpr std::array<const char*, 3> kNames{"drag_length", "stiffness", "bias"};
constexpr std::array<const char*, 3> kSpoken{"the drag length", "the stiffness", "the bias"};

Identified told_by(double share) {
  return share <= kApartShare ? Identified::Apart : share <= kNotShare ? Identified::Partly : Identified::Not;
}

/// Returns the other parameter with the strongest correlation of at least kTied in magnitude; −1: none.
int partner_of(const Mat3& correlation, int parameter) {
  int partner = -1;
  for (int other = 0; other < 3; ++other) {
    if (other == parameter || std::abs(correlation(parameter, other)) < kTied) continue;
    if (partner < 0 || std::abs(correlation(parameter, other)) > std::abs(correlation(parameter, partner)))
      partner = other;
  }
  return partner;
}

std::string sentence_of(const ParameterVerdict& verdict, std::size_t parameter) {
  std::string name = kSpoken[parameter];
  name[0] = 'T';
  const char* told = verdict.told == Identified::Apart ? "is identified by the data"
                     : verdict.told == Identified::Partly
                         ? "is identified in part"
                         : "is not identified by the data: its value is the assumed one";
  std::string text =
      fmt::format("{} {} (its sd is {:.0f} % of the prior sd", name, told, 100.0 * verdict.share_of_prior_sd);
  for (std::size_t other = 0; other < 3; ++other) {
    if (verdict.tied_to == kNames[other])
      text += fmt::format("; correlation {:.2f} with {}", verdict.correlation, kSpoken[other]);
  }
  text += ").";
  if (verdict.is_at_limit) text += " Its interval ends where the simulations end: the truth may lie beyond.";
  return text;
}

}  // namespace

Identifiability identifiability(const DragFit& fit) {
  Identifiability result;
  const std::array<const ParameterEstimate*, 3> estimates{&fit.drag_length_mm, &fit.ln_stiffness, &fit.bias_mm};
  for (std::size_t i = 0; i < 3; ++i) {
    ParameterVerdict& verdict = result.parameters[i];
    verdict.name = kNames[i];
    if (i == 1 && !fit.knows_stiffness) {
      result.sentences.push_back("The stiffness was not varied: no second stiffness left a closed ring.");
      continue;
    }
    verdict.share_of_prior_sd = estimates[i]->sd / estimates[i]->prior_sd;
    verdict.told = told_by(verdict.share_of_prior_sd);
    if (const int partner = partner_of(fit.correlation, static_cast<int>(i)); partner >= 0) {
      verdict.tied_to = kNames[static_cast<std::size_t>(partner)];
      verdict.correlation = fit.correlation(static_cast<int>(i), partner);
    }
    if (i == 0) {
      const std::vector<double>& grid = estimates[i]->grid;
      const double step = grid[1] - grid[0];
      verdict.is_at_limit = estimates[i]->high > grid.back() - step || estimates[i]->low < grid.front() + step;
    }
    result.sentences.push_back(sentence_of(verdict, i));
  }
  return result;
}

}  // namespace incise
