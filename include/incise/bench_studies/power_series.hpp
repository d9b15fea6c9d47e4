#pragma once

#include <incise/calibration/power_choice.hpp>
#include <incise/core/cache.hpp>
#include <incise/core/describe.hpp>
#include <incise/core/monitor.hpp>
#include <incise/core/problem.hpp>
#include <incise/core/workers.hpp>
#include <incise/virtual_bench/body.hpp>

#include <string>
#include <vector>

namespace incise {

/// A virtual specimen of a power series.
struct PowerSubject {
  std::string name;  ///< of its rows; unique in the series
  Specimen specimen;
};

/// Cuts of a power series. Defaults: the paper's series [Paper, II-B.3].
struct PowerRequest {
  std::vector<double> powers_w{25.0, 30.0, 35.0, 40.0};
  double speed_mm_s = 7.0;
  std::vector<double> speeds_mm_s;
  PowerLimits limits;
  BenchResolution resolution;
};
inline void describe(Visitor& v, PowerRequest& r) {
  v({"power_w", "Powers of the generator, each once.", "W"}, r.powers_w, kPositive);
  v({"speed_mm_s", "Speed of the tool in the series.", "mm/s"}, r.speed_mm_s, kPositive);
  v({"speeds_mm_s", "Speeds at which every specimen is also cut, with the chosen power; each once.", "mm/s"},
    r.speeds_mm_s, kPositive);
  describe(v, r.limits);
  v("resolution", r.resolution, "Resolution of the bench's meshes and steps.");
}
/// Returns every violation; empty if the request is valid.
[[nodiscard]] std::vector<Problem> validate(const PowerRequest& request);

/// Returns the cache key of a virtual cut: the specimen with all its hidden parameters, the bench's resolution, power,
/// speed, the build and the instruction set. The specimen's name is not part of it.
[[nodiscard]] CacheKey power_cut_key(const Specimen& specimen, const BenchResolution& resolution, double power_w,
                                     double speed_mm_s);

/// Result of a power series. Virtual.
struct PowerSeries {
  std::vector<PowerCut> cuts;  ///< specimen by specimen, powers as requested
  PowerChoice choice;
  std::vector<PowerCut>
      speed_cuts;           ///< likewise at the chosen power; empty if none was chosen or no speed requested
  std::size_t made = 0;     ///< cuts made now; the others were in the cache
  double speed_mm_s = 0.0;  ///< of the series
  PowerLimits limits;       ///< by which powers were judged
};
/// Describes the keys of `power.json` (incise.power/1) that a series fills.
inline void describe(Visitor& v, PowerSeries& s) {
  v.derived("verdict", std::string(s.choice.chosen_w ? "chosen" : "no_power_fits"), "Whether a power fits.");
  v({"chosen_w", "The lowest power that fits.", "W"}, s.choice.chosen_w);
  v({"speed_mm_s", "Speed of the tool in the series.", "mm/s"}, s.speed_mm_s);
  v("limits", s.limits, "Limits by which powers were judged.");
  v("powers", s.choice.powers, "Powers in ascending order, with the reasons against each.");
  v("rows", s.cuts, "Cuts of the series, specimen by specimen, powers as requested.");
  v("speed_rows", s.speed_cuts, "Cuts at the chosen power and the requested speeds, specimen by specimen.");
  v.internal("made", s.made, "Cuts made now; the others were in the cache.");
}

/// Cuts every specimen of the virtual bench as planned at every power, chooses the lowest power that fits (see
/// choose_power), and cuts every specimen at that power at every speed. Cuts run side by side, one thread each; those
/// in the cache are not repeated. A cut that fails is a row.
/// @param subjects  at least one, each name once.
/// @throws InvalidArgument for an invalid request or invalid subjects; Cancelled when the monitor asks to stop:
/// finished cuts are in the cache.
[[nodiscard]] PowerSeries run_power_series(const std::vector<PowerSubject>& subjects, const PowerRequest& request,
                                           Cache& kept, Workers& workers, Monitor& monitor);

}  // namespace incise
