#pragma once

#include <incise/calibration/power_choice.hpp>
#include <incise/core/cache.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/virtual_bench/body.hpp>

#include <optional>
#include <string>
#include <vector>

namespace incise {

/// A virtual specimen of a power series.
struct PowerSubject {
  std::string name;  ///< of its rows; no other has it
  Specimen specimen;
};

/// What is cut. Defaults: the paper's series [Paper, II-B.3].
struct PowerRequest {
  std::vector<double> powers_w{25.0, 30.0, 35.0, 40.0};  ///< each > 0, each once
  double speed_mm_s = 7.0;                               ///< of the series, > 0
  std::vector<double> speeds_mm_s;                       ///< of the cuts at the chosen power, each > 0, each once
  PowerLimits limits;
  BenchResolution resolution;
};
/// Every violation, one sentence each with the field's name; empty: valid.
[[nodiscard]] std::vector<std::string> validate(const PowerRequest& request);

/// The key of a virtual cut: the specimen with all its hidden parameters, the bench's resolution, power, speed, the
/// build and the instruction set. Its name is no part of it.
[[nodiscard]] CacheKey power_cut_key(const Specimen& specimen, const BenchResolution& resolution, double power_w,
                                     double speed_mm_s);

/// What a series found. Virtual.
struct PowerSeries {
  std::vector<PowerCut> cuts;  ///< specimen by specimen, powers as they were asked for
  PowerChoice choice;
  std::vector<PowerCut>
      speed_cuts;        ///< likewise at the chosen power; empty where none was chosen or no speed asked for
  std::size_t made = 0;  ///< cuts made now; the others were there already
};

/// Cuts every specimen of the virtual bench as planned at every power, chooses the lowest that fits (see choose_power),
/// and cuts every specimen at that power at every speed. Cuts run side by side, one thread each; those that the cache
/// has are not made again. A cut that fails is a row.
/// @param subjects  at least one.
/// @throws InvalidArgument for a request that is not valid; Cancelled when the monitor asks to stop: finished cuts are
/// in
///         the store.
[[nodiscard]] PowerSeries run_power_series(const std::vector<PowerSubject>& subjects, const PowerRequest& request,
                                           Cache& kept, Workers& workers, Monitor& monitor);

}  // namespace incise
