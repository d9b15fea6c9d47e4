#pragma once

#include <incise/core/describe.hpp>

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace incise {

/// The judgement of a cut, a run or a measurement. Ordered: the greater, the worse.
enum class VerdictStatus {
  Ok,       ///< no objection is known
  Caution,  ///< a robot program is written only if a person accepts each reason by its id
  Refused,  ///< it must not be carried out; no robot program is written
};
inline constexpr std::array<std::string_view, 3> kVerdictStatusNames{"ok", "caution", "refused"};
[[nodiscard]] constexpr Names names_of(VerdictStatus) {
  return kVerdictStatusNames;
}

/// One row of the table of limits: a possible objection to a cut, and the limit beyond which it is raised.
struct VerdictRule {
  std::string_view id;             ///< as users write it: `--accept depth`
  VerdictStatus severity;          ///< Caution or Refused
  std::optional<double> limit;     ///< in `unit`; absent: a plain yes or no, or a limit that the case sets
  std::string_view relation;       ///< of a good value to the limit: "<=", ">=", "<", ">"; empty: nothing is compared
  std::string_view unit;           ///< empty: a share or a count
  std::string_view meaning;        ///< one sentence
};

/// Returns the table of limits, in the order in which reasons of equal severity are listed. docs/models/verdict.md
/// shows the same table; a test compares the two.
[[nodiscard]] std::span<const VerdictRule> verdict_rules();

/// Returns the rule with this id. @throws InvalidArgument for an id that the table does not have.
[[nodiscard]] const VerdictRule& verdict_rule(std::string_view id);

/// Where along a path or in the tissue something was found.
struct VerdictPlace {
  std::optional<double> arclength_mm;           ///< along the path from its start, >= 0
  std::optional<Eigen::Vector3d> position_mm;   ///< in the frame of the result that holds the verdict
  std::string text;                             ///< for a person: "waypoint 12", "layer 4 mm deep"; may be empty
};
inline void describe(Visitor& v, VerdictPlace& p) {
  v("arclength_mm", p.arclength_mm, "Distance along the path from its start.", kNotNegative);
  v("position_mm", p.position_mm, "Position in the frame of the result that holds the verdict.");
  v("text", p.text, "The place in words, for a person.");
}

/// One objection to a cut.
struct VerdictReason {
  std::string id;                                  ///< of its rule
  VerdictStatus severity = VerdictStatus::Caution;
  std::optional<double> value;                     ///< that was found, in `unit`
  std::optional<double> limit;                     ///< with which the value was compared
  std::string unit;
  std::optional<VerdictPlace> at;
  std::string message;                             ///< one sentence for a person, with the numbers in it
};
void describe(Visitor& v, VerdictReason& reason);

/// The verdict and its reasons, worst first. Terminal, JSON, report, manifest and the program gate show it.
class Verdict {
 public:
  Verdict() = default;

  /// Adds a reason with the severity, unit and limit of the rule `id`. @param limit  replaces the rule's limit, if
  /// given.
  /// @throws InvalidArgument for an unknown id.
  void add(std::string_view id, std::optional<double> value, std::string message, std::optional<VerdictPlace> at = {},
           std::optional<double> limit = {});
  /// Adds a complete reason, such as one read from a file, unless one with the same id and message is there already. A
  /// value or limit that is not finite becomes absent.
  void add(VerdictReason reason);
  /// Adds every reason of another verdict.
  void add(const Verdict& other);

  [[nodiscard]] VerdictStatus status() const;  ///< severity of the worst reason; Ok without one
  [[nodiscard]] const std::vector<VerdictReason>& reasons() const { return reasons_; }
  [[nodiscard]] bool has(std::string_view id) const;
  friend void describe(Visitor& v, Verdict& verdict);

 private:
  std::vector<VerdictReason> reasons_;
};

/// While reading, refuses an id that the table does not have, a severity other than its rule's, a status other than the
/// worst reason's, and more than 1000 reasons.
void describe(Visitor& v, Verdict& verdict);

/// Whether a verdict allows a robot program, after a person has accepted some cautions.
struct VerdictGate {
  bool is_open = false;                 ///< the program may be written
  std::vector<std::string> accepted;    ///< ids of the cautions that were accepted, each once, in the verdict's order
  std::vector<std::string> missing;     ///< ids of the cautions that nobody accepted
  std::vector<std::string> refused;     ///< ids of the reasons that nobody can accept
};
inline void describe(Visitor& v, VerdictGate& g) {
  v("open", g.is_open, "Whether the program may be written.");
  v("accepted", g.accepted, "Ids of the cautions that were accepted.");
  v("missing", g.missing, "Ids of the cautions that nobody accepted.");
  v("refused", g.refused, "Ids of the reasons that nobody can accept.");
}

/// Returns whether a verdict allows a robot program.
/// @param accepted_ids  as given with `--accept`; ids of reasons that the verdict does not have are ignored.
[[nodiscard]] VerdictGate gate_of(const Verdict& verdict, std::span<const std::string> accepted_ids);

/// Returns the verdict on a path that is no longer the one that was cut: the refusals of the old verdict and a caution
/// `not_simulated`. So nobody can accept a path that was refused.
/// @param why  one sentence: why the path counts as not simulated.
[[nodiscard]] Verdict refusals_of(const Verdict& verdict, std::string why);

}  // namespace incise
