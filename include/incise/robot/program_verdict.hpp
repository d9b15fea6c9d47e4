#pragma once

#include <incise/core/verdict.hpp>
#include <incise/robot/checks.hpp>
#include <incise/robot/player.hpp>
#include <incise/robot/program_text.hpp>

namespace incise {

/// What a program's header says of a specimen that is no patient's.
inline constexpr const char* kVirtualSpecimen = "VIRTUAL SPECIMEN: made for a synthetic body, not for a patient.";

/// Failed checks of a program that nobody took on themselves join the verdict as `program_check`.
void add_failed_checks(const ProgramChecks& checks, Verdict& verdict);
/// So does a replay that did not complete.
void add_failed_replay(const Replay& replay, Verdict& verdict);

/// What a program's header says of its verdict: the status, each reason, each accepted caution.
[[nodiscard]] ProgramHeader verdict_header(const Verdict& verdict, const VerdictGate& gate);

/// The verdict of a cut as one of a mark of the tumour's edge: a mark cuts nothing, so that of the cautions only those
/// against its place remain; what is refused as a cut is not marked either.
[[nodiscard]] Verdict as_verdict_of_mark(const Verdict& of_cut);

}  // namespace incise
