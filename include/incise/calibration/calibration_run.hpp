#pragma once

#include <incise/core/outcome.hpp>
#include <incise/cutting/kerf_measures.hpp>
#include <incise/evaluation/statistics.hpp>
#include <incise/geometry/contour.hpp>

#include <cstddef>
#include <optional>
#include <string>

namespace incise {

/// Plausible lengths of tissue, tools and photographs, mm.
inline constexpr Range kAnatomyMm{1e-9, 1e3};
/// Plausible signed distances between them, mm.
inline constexpr Range kAnatomyErrorMm{-1e3, 1e3};

/// Settings of one simulated cut of a calibration; everything else is the case's.
struct RunSetting {
  double speed_mm_s = 13.0;        ///< of the simulated tool, > 0
  double dullness = 9.0;           ///< contact that a tet needs before it is removed, in reference steps, > 0
  double stiffness_of_case = 1.0;  ///< Young's modulus over the case's, > 0
  bool operator==(const RunSetting&) const = default;
};
inline void describe(Visitor& v, RunSetting& s) {
  v({"speed_mm_s", "Speed of the simulated tool.", "mm/s"}, s.speed_mm_s, {0.01, 100.0});
  v({"dullness", "Contact needed before a tet is removed, in reference steps.", "steps"}, s.dullness, {1e-6, 1e3});
  v("stiffness_of_case", s.stiffness_of_case, "Young's modulus over that of the case.", {1e-3, 1e3});
}

/// Stored result of one simulated cut.
struct CalibrationRun {
  RunSetting setting;
  double reference_step_s = 0.02;  ///< time that one unit of dullness represents
  Outcome outcome = Outcome::NotConverged;
  std::string problem;  ///< why it could not be carried out; empty: it was
  bool closed_loop = false;
  bool paper_success = false;                 ///< see Evaluation::paper_success
  std::optional<Summary> signed_error_mm;     ///< mid-line against the lateral margin
  std::optional<Summary> paper_abs_error_mm;  ///< |distance of the mid-line − (margin − radius)|, as the paper scores
  std::optional<Summary> inner_signed_error_mm;  ///< inner edge against margin less radius, tool out
  std::optional<Summary> inner_abs_error_mm;     ///< its absolute value
  std::optional<Contour> inner_edge;             ///< tool out, tissue still stretched, mm
  Contour final_tumor_edge;                      ///< likewise
  std::optional<ClosedRing> ring;                ///< shallowest closed ring, whether or not the skin parted
  std::size_t tets = 0;
  double wall_s = 0.0;

  /// Returns the drag length, mm: speed · dwell, the distance that the tool travels while it holds a tet.
  [[nodiscard]] double drag_length_mm() const { return setting.speed_mm_s * setting.dullness * reference_step_s; }
  /// Returns whether the cut failed in the paper's sense. A success is a closed ring with a negative margin whose every
  /// point errs by at most margin − radius.
  [[nodiscard]] bool is_failure() const { return outcome != Outcome::Success || !paper_success; }
};
inline void describe(Visitor& v, CalibrationRun& r) {
  v("setting", r.setting, "Settings of the cut, in addition to its case's.");
  v("reference_step_s", r.reference_step_s, "The time that one unit of dullness represents.", kPositive);
  v("outcome", r.outcome, "How the cut ended.");
  v("problem", r.problem, "Why the cut could not be carried out; empty: it was.");
  v("closed_loop", r.closed_loop, "Whether the ring closed.");
  v("paper_success", r.paper_success, "Whether the cut was a success in the paper's sense.");
  v("signed_error_mm", r.signed_error_mm, "Signed error of the mid-line against the lateral margin.");
  v("paper_abs_error_mm", r.paper_abs_error_mm, "Absolute error, as the paper scores it.");
  v("inner_signed_error_mm", r.inner_signed_error_mm,
    "Signed error of the inner edge against margin less radius, tool out.");
  v("inner_abs_error_mm", r.inner_abs_error_mm, "Absolute error of the inner edge.");
  v("inner_edge", r.inner_edge, "The inner edge, tool out, tissue still stretched.");
  v("final_tumor_edge", r.final_tumor_edge, "The tumour's edge, tool out, tissue still stretched.");
  v("ring", r.ring, "The shallowest ring that closed.");
  v("tets", r.tets, "Number of tets before the cut.");
  v("wall_s", r.wall_s, "Time that the simulation took.");
}

}  // namespace incise
