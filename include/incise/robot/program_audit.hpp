#pragma once

#include <incise/robot/player.hpp>
#include <incise/robot/program_reading.hpp>

#include <string>
#include <vector>

namespace incise {

/// Result of an audit: whether a written program is unchanged, and whether its header is true.
struct [[nodiscard]] ProgramAudit {
  ProgramDigest digest = ProgramDigest::Absent;
  std::vector<std::string> contradictions;  ///< statements of the program that are false, one sentence each
  std::vector<std::string> recomputed;      ///< names of the checks that were made again
  std::vector<std::string> not_recomputed;  ///< names of the other checks, or why none was made again
  std::vector<std::string> moved_limits;    ///< limits that options changed: "close_margin_mm 1, by default 2.2"
  /// Whether the program is unchanged to the byte and the audit found no contradiction.
  [[nodiscard]] bool is_checked() const { return digest == ProgramDigest::Matches && contradictions.empty(); }
};
inline void describe(Visitor& v, ProgramAudit& a) {
  v.derived("checked", a.is_checked(),
            "Whether the program is unchanged and its checks, made again, agree with its header.");
  v.derived("digest_matches",
            a.digest == ProgramDigest::Absent ? std::nullopt : std::optional(a.digest == ProgramDigest::Matches),
            "Whether the digest matches the program; absent: the program has no digest.");
  v("contradictions", a.contradictions, "Statements of the header that are not true.");
  v("recomputed", a.recomputed, "Names of the checks that were made again.");
  v("not_recomputed", a.not_recomputed, "Names of the other checks, or why no check was made again.");
  v("moved_limits", a.moved_limits, "Limits that options changed.");
}

/// Makes the program again from its header (path, tumour edge, settings, limits), checks it again, and compares the
/// motion and the header with the result. Checks that need the tissue's surface, the registration, the power or the
/// path before correction cannot be made again.
[[nodiscard]] ProgramAudit audit_program(const WrittenProgram& program);

/// Changes the outcome of a completed replay: to Altered if the program's digest differs, otherwise to FalseChecks if
/// the audit found a contradiction. A program without a digest may complete, although ProgramAudit::is_checked is
/// false.
void judge_audit(Replay& replay, const ProgramAudit& audit);

}  // namespace incise
