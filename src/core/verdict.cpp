#include <incise/core/defaults.hpp>
#include <incise/core/error.hpp>
#include <incise/core/utf8.hpp>
#include <incise/core/verdict.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace incise {
namespace {

constexpr VerdictStatus kCaution = VerdictStatus::Caution;
constexpr VerdictStatus kRefused = VerdictStatus::Refused;
constexpr std::optional<double> kNoLimit;
constexpr std::size_t kMostReasons = 1000;

// The one table of limits. Change it together with docs/models/verdict.md.
constexpr auto kRules = std::to_array<VerdictRule>({
    {"outcome", kRefused, kNoLimit, "", "", "The simulated cut did not succeed, or it left nothing to measure."},
    {"tumor_distance", kRefused, kCloseMarginMm, ">", "mm",
     "Smallest distance from the simulated kerf to the tumour's surface, in any direction."},
    {"lateral_margin", kRefused, kCloseMarginMm, ">", "mm",
     "Least tissue that the cut is expected to leave beside the tumour's edge: as simulated, and with the errors that "
     "the case's `compensation` expects beyond the simulation."},
    {"open_layer", kRefused, kNoLimit, "", "mm",
     "A layer within the planned depth in which the simulated ring stayed open."},
    {"contour_surface", kRefused, 5.0, "<=", "mm", "Greatest distance from the tumour's edge to the tumour's surface."},
    {"contour_flipped", kRefused, kNoLimit, "", "mm",
     "The tumour's edge fits its surface only with the axes of the other convention (RAS for LPS)."},
    {"platform", kRefused, 0.0, ">=", "mm",
     "Least height of the tool's tip above the platform that supports the tissue."},
    {"cut_face", kRefused, kNoLimit, "", "",
     "The path or the tumour's edge lies where the region of interest, or the end of the scan, cuts through the "
     "tissue. The specimen continues beyond that face."},
    {"program_check", kRefused, kNoLimit, "", "", "A safety check of the robot program failed."},
    {"photo_oblique", kRefused, 0.03, "<=", "",
     "Change of scale along the ruler of a photograph: the camera does not look straight down."},
    {"photo_lens", kRefused, 0.02, "<=", "",
     "Bending or uneven spacing of the ruler in a photograph: lens distortion was not corrected."},
    {"depth", kCaution, 0.9, ">=", "",
     "Least depth of the simulated kerf anywhere along the path, as a share of the planned depth there."},
    {"heat", kCaution, 0.0, ">=", "mm", "Tissue left unheated between the simulated cut and the tumour's edge."},
    {"simulated_margin", kCaution, kCloseMarginMm, ">", "mm",
     "Least tissue that the simulated cut alone leaves beside the tumour's edge, where `compensation` expects real "
     "cuts to leave enough."},
    {"painted_skin", kCaution, kNoLimit, "", "",
     "The path or the tumour's edge lies on skin that strokes of the brush made (`ct.edits`)."},
    {"typed_transform", kCaution, kNoLimit, "", "",
     "The specimen's place was typed (T_robot_sim of the case, or a transform that `incise register` did not write): "
     "no registration confirms where it lies. Does not apply to a case with `specimen_is: virtual`."},
    {"not_simulated", kCaution, kNoLimit, "", "",
     "No simulated cut is known for the path: nothing predicts where the cut will land."},
    {"not_corrected", kCaution, kNoLimit, "", "",
     "The requested correction is not accepted; the path is the uncorrected one, or the rejected one."},
    {"eligibility", kCaution, kNoLimit, "", "", "The assessment of this specimen advises against the path."},
    {"registration", kCaution, kNoLimit, "", "", "The registration's own figures argue against trusting it."},
    {"cut_rule", kCaution, kNoLimit, "", "",
     "The cut was simulated by a rule other than the default (`cut.rule`), whose cuts have not been compared with "
     "anything."},
    // Between a mesh of 8 000 tets (2.5 mm), whose cut is half as far off as it should be, and one of 42 000.
    {"mesh_resolution", kCaution, 1.5, "<=", "mm", "Mean edge length of the mesh along the path."},
    {"locking", kCaution, 0.49, "<=", "", "Poisson's ratio, where each tetrahedron keeps its own volume."},
    {"convergence", kCaution, kNoLimit, "", "",
     "The simulation of the cut was not solved, not at rest, or held back by its own limits."},
    {"photo_scale", kCaution, 1.0, "<=", "%", "Standard error of the scale that the ruler in a photograph gives."},
    {"photo_specimen", kCaution, 0.3, "<=", "mm",
     "Distance of a photographed tumour edge from the simulated one, or a turn beyond 10 degrees; it may be another "
     "specimen."},
    {"photo_ring", kCaution, kNoLimit, "", "mm",
     "Length of a part of a closed red ring that may be an opening: it looks unlike the rest, as blood does, or is "
     "unseen and slightly longer than allowed."},
    {"scan", kCaution, kNoLimit, "", "",
     "The scan casts doubt on the tissue that was found in it, or another body in it may be the specimen."},
});

/// Returns the rule's row in the table, which orders the reasons of equal severity; the size of the table for an
/// unknown id.
std::size_t row_of(std::string_view id) {
  const auto row = std::find_if(kRules.begin(), kRules.end(), [&](const VerdictRule& rule) { return rule.id == id; });
  return static_cast<std::size_t>(row - kRules.begin());
}

bool is_worse(const VerdictReason& a, const VerdictReason& b) {
  if (a.severity != b.severity) return a.severity > b.severity;
  return row_of(a.id) < row_of(b.id);
}

}  // namespace

std::span<const VerdictRule> verdict_rules() { return kRules; }

const VerdictRule& verdict_rule(std::string_view id) {
  const std::size_t row = row_of(id);
  INCISE_REQUIRE(row < kRules.size(), fmt::format("expected the id of a rule of the verdict, found '{}'", id));
  return kRules[row];
}

void Verdict::add(std::string_view id, std::optional<double> value, std::string message, std::optional<VerdictPlace> at,
                  std::optional<double> limit) {
  const VerdictRule& rule = verdict_rule(id);
  add(VerdictReason{std::string(rule.id), rule.severity, value, limit ? limit : rule.limit, std::string(rule.unit), std::move(at),
                    std::move(message)});
}

void describe(Visitor& v, VerdictReason& reason) {
  v("id", reason.id, "Id of its rule in the table of limits.");
  const auto rule = std::find_if(kRules.begin(), kRules.end(), [&](const VerdictRule& r) { return r.id == reason.id; });
  if (v.sets() && rule == kRules.end())
    v.refuse({"id"}, fmt::format("'{}'", utf8_prefix(reason.id, 40)), "the id of a rule of the verdict");
  v("severity", reason.severity, "Severity of its rule.");
  if (v.sets() && reason.severity != rule->severity) {
    v.refuse({"severity"}, std::string(to_string(reason.severity)), std::string(to_string(rule->severity)));
  }
  v("value", reason.value, "The value that was found.");
  v("limit", reason.limit, "The limit that the value was compared with.");
  v("unit", reason.unit, "Unit of value and limit.");
  v("at", reason.at, "Place to which the reason refers.");
  v("message", reason.message, "One sentence for a person.");
}

void describe(Visitor& v, Verdict& verdict) {
  VerdictStatus status = verdict.status();
  if (v.is_summary()) v("status", status, "Severity of the worst reason.");
  std::vector<VerdictReason> reasons = verdict.reasons_;
  v("reasons", reasons, "Reasons of the verdict, worst first.");
  if (!v.sets()) return;
  if (reasons.size() > kMostReasons)
    v.refuse({"reasons"}, fmt::format("{} reasons", reasons.size()), fmt::format("at most {}", kMostReasons));
  verdict.reasons_.clear();
  for (VerdictReason& reason : reasons) verdict.add(std::move(reason));
  if (v.is_summary() && status != verdict.status()) {
    v.refuse({"status"}, std::string(to_string(status)),
             fmt::format("{}, the severity of the worst reason", to_string(verdict.status())));
  }
}

void Verdict::add(VerdictReason reason) {
  for (std::optional<double>* number : {&reason.value, &reason.limit}) {
    if (*number && !std::isfinite(**number)) number->reset();  // it could not be measured
  }
  const bool is_there = std::any_of(reasons_.begin(), reasons_.end(),
                                    [&](const VerdictReason& r) { return r.id == reason.id && r.message == reason.message; });
  if (is_there) return;
  const auto place = std::upper_bound(reasons_.begin(), reasons_.end(), reason, is_worse);
  reasons_.insert(place, std::move(reason));
}

void Verdict::add(const Verdict& other) {
  for (const VerdictReason& reason : other.reasons_) add(reason);
}

VerdictStatus Verdict::status() const { return reasons_.empty() ? VerdictStatus::Ok : reasons_.front().severity; }

bool Verdict::has(std::string_view id) const {
  return std::any_of(reasons_.begin(), reasons_.end(), [&](const VerdictReason& reason) { return reason.id == id; });
}

VerdictGate gate_of(const Verdict& verdict, std::span<const std::string> accepted_ids) {
  VerdictGate gate;
  const auto note = [](std::vector<std::string>& list, const std::string& id) {
    if (std::find(list.begin(), list.end(), id) == list.end()) list.push_back(id);
  };
  for (const VerdictReason& reason : verdict.reasons()) {
    const bool is_accepted = std::find(accepted_ids.begin(), accepted_ids.end(), reason.id) != accepted_ids.end();
    if (reason.severity == VerdictStatus::Refused) {
      note(gate.refused, reason.id);
    } else if (reason.severity == VerdictStatus::Caution) {
      note(is_accepted ? gate.accepted : gate.missing, reason.id);
    }
  }
  gate.is_open = gate.refused.empty() && gate.missing.empty();
  return gate;
}

Verdict refusals_of(const Verdict& verdict, std::string why) {
  Verdict kept;
  kept.add("not_simulated", {}, std::move(why));
  for (const VerdictReason& reason : verdict.reasons()) {
    if (reason.severity == VerdictStatus::Refused) kept.add(reason);
  }
  return kept;
}

}  // namespace incise
