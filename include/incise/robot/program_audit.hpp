#pragma once

#include <incise/robot/player.hpp>
#include <incise/robot/program_reading.hpp>

#include <string>
#include <vector>

namespace incise {

/// What a written program says of itself, held against what can be found out from it.
struct [[nodiscard]] ProgramAudit {
  ProgramDigest digest = ProgramDigest::Absent;
  std::vector<std::string> contradictions;  ///< lines of the header that are not so, one sentence each
  std::vector<std::string> recomputed;      ///< names of the checks that were made again
  std::vector<std::string> not_recomputed;  ///< of those that only the header names, or why none was made again
  std::vector<std::string> moved_limits;    ///< "close_margin_mm 1, by default 2.2": what options moved
  /// It is the program that was written, to the byte, and its checks give what it states.
  [[nodiscard]] bool is_checked() const { return digest == ProgramDigest::Matches && contradictions.empty(); }
};
inline void describe(Visitor& v, ProgramAudit& a) {
  v.derived("checked", a.is_checked(), "It is the program that was written, and its checks come out as it says.");
  v.derived("digest_matches",
            a.digest == ProgramDigest::Absent ? std::nullopt : std::optional(a.digest == ProgramDigest::Matches),
            "Absent: it carries no digest.");
  v("contradictions", a.contradictions, "Lines of the header that are not so.");
  v("recomputed", a.recomputed, "Names of the checks that were made again.");
  v("not_recomputed", a.not_recomputed, "Of those that only the header states, or why none was made again.");
  v("moved_limits", a.moved_limits, "What options moved.");
}

/// Makes the program again from its header (path, tumour edge, settings, limits), checks it again and holds the
/// header's lines against what comes out. What needs the tissue's surface, the registration or the path before
/// correction cannot be made again.
[[nodiscard]] ProgramAudit audit_program(const WrittenProgram& program);

/// A completed replay of a program whose digest differs, or whose header is not so, gets that outcome. A program
/// without a digest plays: it is just not a checked one.
void judge_audit(Replay& replay, const ProgramAudit& audit);

}  // namespace incise
