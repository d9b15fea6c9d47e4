#include "verdict_gate.hpp"

#include <incise/core/nearest_name.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace incise::cli {

void add_accept(CLI::App& verb, std::vector<std::string>& accepted) {
  verb.add_option("--accept", accepted,
                  "Write the program even if the verdict has the caution with this id, such as depth. Repeat for each "
                  "caution; the program lists them. A refusal cannot be accepted")
      ->expected(1)
      ->take_all();
}

void require_accepted_ids(const std::vector<std::string>& accepted) {
  std::vector<std::string> cautions;
  for (const VerdictRule& rule : verdict_rules()) {
    if (rule.severity == VerdictStatus::Caution) cautions.emplace_back(rule.id);
  }
  for (const std::string& id : accepted) {
    if (std::find(cautions.begin(), cautions.end(), id) != cautions.end()) continue;
    const bool is_refusal = std::any_of(verdict_rules().begin(), verdict_rules().end(), [&](const VerdictRule& rule) { return rule.id == id; });
    throw CaseError("command line", "--accept", fmt::format("'{}'", id),
                    is_refusal ? std::string("the id of a caution; nobody can accept a refusal")
                               : fmt::format("one of {}", fmt::join(cautions, ", ")),
                    is_refusal ? std::string() : did_you_mean(id, cautions));
  }
}

void print_verdict(const nlohmann::ordered_json& verdict) {
  fmt::print("{:<36} {}\n", "verdict", verdict.at("status").get<std::string>());
  for (const auto& reason : verdict.at("reasons")) {
    fmt::print("  {}: {}: {}\n", reason.at("severity").get<std::string>(), reason.at("id").get<std::string>(),
               reason.at("message").get<std::string>());
  }
}

}  // namespace incise::cli
