#pragma once

#include <incise/core/verdict.hpp>
#include <incise/robot/checks.hpp>
#include <incise/robot/player.hpp>
#include <incise/robot/program_text.hpp>

namespace incise {

/// Statement in a program's header if the specimen is virtual.
inline constexpr const char* kVirtualSpecimen = "VIRTUAL SPECIMEN: made for a synthetic body, not for a patient.";

/// Adds each failed check that is not overridden to the verdict, as the reason `program_check`.
void add_failed_checks(const ProgramChecks& checks, Verdict& verdict);
/// Adds a replay that did not complete to the verdict, as the reason `program_check`.
void add_failed_replay(const Replay& replay, Verdict& verdict);

/// Returns the header's entries for a verdict: the status, each reason, each accepted caution.
[[nodiscard]] ProgramHeader verdict_header(const Verdict& verdict, const VerdictGate& gate);

/// Returns the verdict of a mark on the tumour edge, from the verdict of the cut. A mark cuts nothing, so only cautions
/// about its position remain (`registration`, `typed_transform`). Refusals remain too.
[[nodiscard]] Verdict as_verdict_of_mark(const Verdict& of_cut);

}  // namespace incise
