#include "laboratory/trial_on_bench.hpp"

#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/steps/case_steps.hpp>

#include <fmt/format.h>

namespace incise::laboratory {
void claim_folder(const std::filesystem::path& output, const char* schema, const char* what, std::uint64_t seed,
                  std::initializer_list<const char*> summaries) {
  using ClaimJson = nlohmann::ordered_json;
  constexpr const char* kClaim = "bench.json";
  const std::filesystem::path file = output / kClaim;
  steps::require_own_or_empty(output, {kClaim}, what);
  if (!std::filesystem::exists(file)) {
    write_json(file, {{"schema", schema}, {"specimen_is", "virtual"}, {"seed", seed}});
  } else {
    const ClaimJson kept = read_json(file);
    const auto require = [&](const char* key, const ClaimJson& expected, const char* hint) {
      const ClaimJson found = kept.is_object() ? kept.value(key, ClaimJson()) : ClaimJson();
      if (found != expected)
        throw DataError(file, key, kept.is_object() ? found.dump() : kept.type_name(),
                        fmt::format("{}, that of this command", expected.dump()), hint);
    };
    require("schema", schema, "Choose another place for the output");
    require("seed", seed, "Its specimens differ. Choose another place for the output");
  }
  for (const char* name : summaries) std::filesystem::remove(output / name);
}

}  // namespace incise::laboratory
