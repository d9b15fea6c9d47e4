#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/second_bench/specimen.hpp>
#include <incise/storage/run_folder.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace incise {

/// The factors of the second laboratory that are switched, and the specimens.
struct ScreeningSettings {
  std::uint64_t specimens = 6;                                  ///< their seeds count up from the run's; each a series
  second_bench::Factors factors = second_bench::all_factors();  ///< at least two; the others stay off
  std::vector<std::string> overrides;                           ///< as of AcceptanceSettings
  int tets = 25000;                                             ///< of the planner's meshes
};

/// Cuts every specimen as planned under a two-level fractional factorial design of the factors (see
/// FractionalFactorial) and estimates, from the photographs, the effect of each factor and of pairs of them on the
/// error. Nothing is calibrated or corrected. Finished steps are kept in each cut's cache/ and not run again.
///
///   S1/0000/ …  the first specimen's cut without any factor, as of an experiment; the name has a
///   bit for each factor that is on, in hexadecimal, in their order, the first the lowest;  truth/  the specimens;
///   factors.json  factors.csv (a row for each factor)  cuts.csv (for each cut)  factors.svg  manifest.json  bench.json
///
/// @returns the content of factors.json. @throws InvalidArgument for fewer than two factors; DataError for a folder
/// with other files or another seed, or where a file cannot be written; Cancelled.
[[nodiscard]] nlohmann::ordered_json screen_factors(const ScreeningSettings& settings,
                                                    const std::filesystem::path& output, const RunContext& run,
                                                    Workers& workers, Monitor& monitor);

}  // namespace incise
