#pragma once

#include "laboratory/tested_specimen.hpp"

#include <incise/evaluation/t_tests.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise::laboratory {

/// The statements about one cut before it was made, and its outcome.
struct AdvisedCut {
  std::optional<double> p_close_margin;        ///< stated; absent: not stated
  std::optional<Interval> error_80, error_95;  ///< stated intervals of the photograph's mean |error|, mm
  std::optional<double> photographed_mm;       ///< mean |error| of the photograph; absent: no closed ring in it
  std::optional<double> true_mm;               ///< mean |error| of the true cut; absent: the ring stayed open
  std::optional<double> least_margin_mm;       ///< least margin of a closed ring
};
inline void describe(Visitor& v, AdvisedCut& c) {
  v("p_close_margin", c.p_close_margin, "Stated probability of a close margin somewhere.", {0.0, 1.0});
  describe_interval(v, {"error_80_mm", "Stated middle 80 % of the photograph's mean absolute error.", "mm"},
                    c.error_80);
  describe_interval(v, {"error_95_mm", "Stated middle 95 % of the photograph's mean absolute error.", "mm"},
                    c.error_95);
  v({"photographed_mm", "Mean absolute error of the photograph; absent: no closed ring.", "mm"}, c.photographed_mm,
    kNotNegative);
  v({"true_mm", "Mean absolute error of the true cut; absent: the ring stayed open.", "mm"}, c.true_mm, kNotNegative);
  v({"least_margin_mm", "Least distance of the true kerf from the tumour's edge.", "mm"}, c.least_margin_mm);
}

/// A specimen that was assessed and cut twice. Probabilities are absent if they were not stated.
struct AdvisedSpecimen {
  std::string name;
  TrialRole role = TrialRole::Test;
  std::string kind;  ///< of a specimen outside the calibrated range; else empty
  std::string advice;
  std::optional<double> expected_gain_mm;
  std::optional<Interval> gain_80, gain_95;
  std::size_t series = 0;  ///< intervals resample specimens of one number together; all 0: as if independent
  std::optional<double> p_worse, p_worse_if_alike, p_worse_if_unlike, p_unlike;
  AdvisedCut planned, corrected;
  std::optional<double> p_worse_without_pull;  ///< p_worse if the pull had not been measured
  std::optional<AdvisedCut> withheld;          ///< corrected without the pull; absent: not requested, or refused
  /// Whether the corrected cut was truly worse. Absent: both rings stayed open, so there is nothing to compare.
  [[nodiscard]] std::optional<bool> is_worse() const;
  [[nodiscard]] std::optional<bool> is_worse_without_pull() const;
};
void describe(Visitor& v, AdvisedSpecimen& s);

/// Compares the statements of `incise assess` about specimens with the outcomes.
/// @returns null without specimens; else `specimens`, `advised`, `worse`, `auc`, `auc_outside_alone` and
/// `auc_without_pull` (advice and correction without the pull; each null if all or none were worse), `auc_of` and
/// `auc_of_outside_alone` (the same for the components of p_worse; a probability that was not stated counts as one
/// half), `close_margin` (reliability of the stated probability), `intervals` (how often the intervals of error and
/// gain contain the photographed values).
[[nodiscard]] nlohmann::ordered_json advice_scores(const std::vector<AdvisedSpecimen>& specimens);

/// As advice_scores, for an experiment's trials; `skipped` lists those that were not assessed and cut twice. Only the
/// bench's truth, never the way a specimen was drawn, decides which cut was worse.
/// @param truth  folder with the truth of each cut: NAME_planned/cut_truth.json, NAME_corrected, NAME_withheld.
[[nodiscard]] nlohmann::ordered_json hold_advice_against_truth(const std::vector<Trial>& trials,
                                                               const std::filesystem::path& truth);

/// Draws roc.svg (if there is an area) and reliability.svg from such scores into a folder.
void draw_advice(const std::filesystem::path& folder, const nlohmann::ordered_json& advice);

}  // namespace incise::laboratory
