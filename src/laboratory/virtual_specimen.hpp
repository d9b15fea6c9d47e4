#pragma once

#include <incise/laboratory/bench_steps.hpp>
#include <incise/second_bench/readings.hpp>
#include <incise/virtual_bench/bench_cut.hpp>

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>

namespace incise::laboratory {

/// A cut specimen: its photograph, and the truth about it.
struct PhotographedCut {
  ColorPicture photograph;
  nlohmann::ordered_json truth;
};

/// A specimen of either laboratory in its holder.
class VirtualSpecimen {
 public:
  virtual ~VirtualSpecimen() = default;
  /// Whether the specimen could be stretched. If not, `monitor` gets a warning, and nothing can be read or cut.
  [[nodiscard]] virtual bool is_held(Monitor& monitor) const = 0;
  /// A complete specimen file.
  [[nodiscard]] virtual nlohmann::ordered_json file() const = 0;
  /// Takes the readings. @throws CaseError for an elasticity map if the laboratory has none.
  [[nodiscard]] virtual Readings readings(bool has_elasticity, Monitor& monitor) const = 0;
  /// The surgeon's prescription: plan fields of a case, and `power_w`. Null: none.
  [[nodiscard]] virtual nlohmann::ordered_json prescription() const = 0;
  virtual void write_truth(const std::filesystem::path& folder) const = 0;
  /// Returns the tip's true course when the arm follows `asked`, a course in its base frame.
  [[nodiscard]] virtual std::vector<TipPose> course(const std::vector<TipPose>& asked) const = 0;
  [[nodiscard]] virtual std::optional<std::string> misfit(const std::vector<TipPose>& course) const = 0;
  /// Cuts the specimen. @returns nothing for a cut that does not come to rest.
  [[nodiscard]] virtual std::optional<PhotographedCut> cut(const std::vector<TipPose>& course, double power_w,
                                                           const PhotographSettings& settings, Workers& workers,
                                                           Monitor& monitor) const = 0;
};

/// Returns the specimen in a file, of either laboratory. @throws DataError
[[nodiscard]] std::unique_ptr<const VirtualSpecimen> specimen_of(const std::filesystem::path& file,
                                                                 const steps::StepContext& context);
/// Returns a request's specimen: from its file, or drawn from the context's seed.
/// @throws DataError; CaseError for a bench, factors or a series that the specimen's laboratory or file does not allow.
[[nodiscard]] std::unique_ptr<const VirtualSpecimen> specimen_of(const MakeSpecimenRequest& request,
                                                                 const steps::StepContext& context);

/// Whether a specimen of the first laboratory could be held and stretched. If not, `monitor` gets a warning.
[[nodiscard]] bool is_stretched(const BenchBody& body, Monitor& monitor);
/// The truth about a virtual cut of the first laboratory.
[[nodiscard]] nlohmann::ordered_json truth_of(const BenchBody& body, const BenchCut& cut);

}  // namespace incise::laboratory
