#include <incise/robot/program_verdict.hpp>

#include <fmt/format.h>

namespace incise {

void add_failed_checks(const ProgramChecks& checks, Verdict& verdict) {
  for (const ProgramCheck& check : checks.checks) {
    if (!check.passed && !check.is_overridden) verdict.add("program_check", check.value, check.message());
  }
}

void add_failed_replay(const Replay& replay, Verdict& verdict) {
  if (replay.outcome == ReplayOutcome::Completed) return;
  verdict.add("program_check", {},
              fmt::format("the replay of the program ended as {}: {}", to_string(replay.outcome), replay.reason));
}

ProgramHeader verdict_header(const Verdict& verdict, const VerdictGate& gate) {
  ProgramHeader header{{"verdict", std::string(to_string(verdict.status()))}};
  for (const VerdictReason& reason : verdict.reasons()) {
    header.emplace_back("reason", fmt::format("{}: {}: {}", to_string(reason.severity), reason.id, reason.message));
  }
  for (const std::string& id : gate.accepted) header.emplace_back("accepted", id);
  return header;
}

Verdict as_verdict_of_mark(const Verdict& of_cut) {
  Verdict verdict;
  for (const VerdictReason& reason : of_cut.reasons()) {
    if (reason.severity == VerdictStatus::Refused || reason.id == "registration" || reason.id == "typed_transform")
      verdict.add(reason);
  }
  return verdict;
}

}  // namespace incise
