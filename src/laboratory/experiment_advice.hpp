#pragma once

#include "laboratory/experiment_tables.hpp"

namespace incise::laboratory {

/// Holds what `incise assess` said of specimens against what happened to them. Whether a corrected cut was the worse
/// one, and whether a margin fell below the clinical cut-off, is taken from the bench's truth and never from how a
/// specimen was drawn.
/// @param truth  folder with the truth of each cut: NAME_planned/cut_truth.json, NAME_corrected, NAME_withheld.
/// @returns null without a specimen that was advised on and cut twice; else `specimens` (each with its stated and true
///          gain), `skipped`, `worse`, `auc`, `auc_outside_alone` and `auc_without_pull` (advice and correction without
///          it; each null where all or none were worse), `auc_of` and `auc_of_outside_alone` (the same of what
///          p_worse is made of; a probability that was not stated counts as one half), `close_margin` (reliability of
///          the stated probability), `intervals` (how often those of error and gain hold the photographs').
[[nodiscard]] nlohmann::ordered_json hold_advice_against_truth(const std::vector<Trial>& trials,
                                                               const std::filesystem::path& truth);

/// Writes advice.json, roc.svg (where there is an area) and reliability.svg into an empty folder.
void write_advice(const std::filesystem::path& folder, const nlohmann::ordered_json& advice);

}  // namespace incise::laboratory
