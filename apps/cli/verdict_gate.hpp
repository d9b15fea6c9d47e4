#pragma once

#include "options.hpp"

#include <incise/core/verdict.hpp>
#include <incise/robot/checks.hpp>
#include <incise/robot/program_text.hpp>

#include <string>
#include <vector>

namespace incise::cli {

/// Adds --accept to a verb that writes a robot program.
void add_accept(CLI::App& verb, std::vector<std::string>& accepted);

/// Refuses ids that are no cautions of verdict_rules() (status 2), naming the nearest one.
void require_accepted_ids(const std::vector<std::string>& accepted);

/// Says on the console what stands between a verdict and its program, or which cautions were accepted.
void report_gate(const Verdict& verdict, const VerdictGate& gate, Monitor& monitor);

/// The verdict of a cut as one of a mark of the tumour's edge: a mark cuts nothing, so that of the cautions only those
/// against its place remain; what is refused as a cut is not marked either.
[[nodiscard]] Verdict as_verdict_of_mark(const Verdict& of_cut);

/// What a program's header says of a specimen that is no patient's.
inline constexpr const char* kVirtualSpecimen = "VIRTUAL SPECIMEN: made for a synthetic body, not for a patient.";

/// Failed checks of a program that nobody took on themselves join the verdict as `program_check`.
void add_failed_checks(const ProgramChecks& checks, Verdict& verdict);

/// What a program's header says of its verdict: the status, each reason, each accepted caution.
[[nodiscard]] ProgramHeader verdict_header(const Verdict& verdict, const VerdictGate& gate);

/// The verdict for a person: its status, then a line for each reason, worst first.
void print_verdict(const nlohmann::ordered_json& verdict);

}  // namespace incise::cli
