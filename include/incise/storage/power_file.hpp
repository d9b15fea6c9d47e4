#pragma once

#include <incise/calibration/incision_speed.hpp>
#include <incise/io/table_io.hpp>
#include <incise/workflow/power_series.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace incise {

/// Finished cuts of a power series as files, one each. What determines a cut is the specimen with all its hidden
/// parameters, the bench's resolution, power, speed, the build and the instruction set: a cut is found again whatever
/// else is asked for.
class PowerCutFolder : public PowerCutStore {
 public:
  /// @param folder  is made when the first cut is saved.
  PowerCutFolder(std::filesystem::path folder, const BenchResolution& resolution);

  /// A damaged or changed file is reported and treated as missing: the cut is simulated again and replaces it.
  std::optional<PowerCut> load(const PowerSubject& subject, double power_w, double speed_mm_s,
                               Monitor& monitor) override;
  void save(const PowerSubject& subject, const PowerCut& cut) override;

  /// Where a cut is or would be.
  [[nodiscard]] std::filesystem::path file_of(const PowerSubject& subject, double power_w, double speed_mm_s) const;

 private:
  [[nodiscard]] std::string key_of(const PowerSubject& subject, double power_w, double speed_mm_s) const;
  std::filesystem::path folder_;
  BenchResolution resolution_;
};

/// The keys of `power.json` (incise.power/1) that a series fills: verdict (chosen, no_power_fits), chosen_w, limits,
/// powers with the reasons against each, rows, speed_rows, virtual.
[[nodiscard]] nlohmann::ordered_json to_json(const PowerSeries& series, const PowerRequest& request);
[[nodiscard]] nlohmann::ordered_json to_json(const SpeedEstimate& estimate);

/// All cuts, one a row; the column `series` says which of the two they belong to, power or speed. What was not measured
/// is an empty field.
[[nodiscard]] TextTable power_table(const PowerSeries& series);

/// Reads timed straight cuts: a CSV with the columns length_mm (1 to 2000) and time_s, at 0.5 to 50 mm/s.
/// @throws DataError naming line and column.
[[nodiscard]] std::vector<TimedCut> read_timed_cuts(const std::filesystem::path& file);

}  // namespace incise
