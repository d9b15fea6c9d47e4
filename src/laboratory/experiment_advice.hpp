#pragma once

#include "laboratory/tested_specimen.hpp"

#include <incise/evaluation/t_tests.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise::laboratory {

/// What was said of one cut before it was made, and what came of it.
struct AdvisedCut {
  std::optional<double> p_close_margin;        ///< stated; absent: not
  std::optional<Interval> error_80, error_95;  ///< stated intervals of the photograph's mean |error|, mm
  std::optional<double> photographed_mm;       ///< mean |error| of the photograph; absent: no closed ring in it
  std::optional<double> true_mm;               ///< the same of the truth; absent: the ring stayed open
  std::optional<double> least_margin_mm;       ///< of a closed one
};
inline void describe(Visitor& v, AdvisedCut& c) {
  v("p_close_margin", c.p_close_margin, "Stated probability of a close margin somewhere.", {0.0, 1.0});
  describe_interval(v, {"error_80_mm", "Stated middle 80 % of the photograph's mean absolute error.", "mm"},
                    c.error_80);
  describe_interval(v, {"error_95_mm", "Middle 95 %, likewise.", "mm"}, c.error_95);
  v({"photographed_mm", "Mean absolute error of the photograph; absent: no closed ring.", "mm"}, c.photographed_mm,
    kNotNegative);
  v({"true_mm", "The same of the truth; absent: the ring stayed open.", "mm"}, c.true_mm, kNotNegative);
  v({"least_margin_mm", "Least distance of the true kerf from the tumour's edge.", "mm"}, c.least_margin_mm);
}

/// A specimen that was advised on and cut twice. Probabilities are absent where they were not stated.
struct AdvisedSpecimen {
  std::string name;
  TrialRole role = TrialRole::Test;
  std::string kind;  ///< of one outside the calibrated range; else empty
  std::string advice;
  std::optional<double> expected_gain_mm;
  std::optional<Interval> gain_80, gain_95;
  std::size_t series = 0;  ///< intervals draw those of one number together; all 0: as if they were independent
  std::optional<double> p_worse, p_worse_if_alike, p_worse_if_unlike, p_unlike;
  AdvisedCut planned, corrected;
  std::optional<double> p_worse_without_pull;  ///< the same, had the pull not been measured
  std::optional<AdvisedCut> withheld;          ///< corrected without the pull; absent: not asked for, or refused
  /// By the truth; nothing: two open rings, which tell nothing.
  [[nodiscard]] std::optional<bool> is_worse() const;
  [[nodiscard]] std::optional<bool> is_worse_without_pull() const;
};
void describe(Visitor& v, AdvisedSpecimen& s);

/// Of the trials that were advised on and cut twice. Whether a corrected cut was the worse one, and whether a margin
/// fell below the clinical cut-off, is taken from the bench's truth and never from how a specimen was drawn.
/// @param truth  folder with the truth of each cut: NAME_planned/cut_truth.json, NAME_corrected, NAME_withheld.
[[nodiscard]] std::vector<AdvisedSpecimen> advised_specimens(const std::vector<Trial>& trials,
                                                             const std::filesystem::path& truth);

/// Holds what `incise assess` said of specimens against what happened to them.
/// @returns null without specimens; else `specimens`, `advised`, `worse`, `auc`, `auc_outside_alone` and
///          `auc_without_pull` (advice and correction without it; each null where all or none were worse), `auc_of` and
///          `auc_of_outside_alone` (the same of what p_worse is made of; a probability that was not stated counts as
///          one half), `close_margin` (reliability of the stated probability), `intervals` (how often those of error
///          and gain hold the photographs').
[[nodiscard]] nlohmann::ordered_json advice_scores(const std::vector<AdvisedSpecimen>& specimens);

/// The same of an experiment's trials, and in `skipped` those that were not advised on and cut twice.
[[nodiscard]] nlohmann::ordered_json hold_advice_against_truth(const std::vector<Trial>& trials,
                                                               const std::filesystem::path& truth);

/// Draws roc.svg (where there is an area) and reliability.svg of such scores into a folder.
void draw_advice(const std::filesystem::path& folder, const nlohmann::ordered_json& advice);

}  // namespace incise::laboratory
