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
  /// A specimen file in full.
  [[nodiscard]] virtual nlohmann::ordered_json file() const = 0;
  /// @throws CaseError for an elasticity map where the laboratory has none.
  [[nodiscard]] virtual Readings readings(bool has_elasticity, Monitor& monitor) const = 0;
  /// What its surgeon asks for: plan fields of a case, and `power_w`. Null: nothing.
  [[nodiscard]] virtual nlohmann::ordered_json prescription() const = 0;
  virtual void write_truth(const std::filesystem::path& folder) const = 0;
  /// Where the arm takes the tip on a course in its base frame.
  [[nodiscard]] virtual std::vector<TipPose> course(const std::vector<TipPose>& asked) const = 0;
  [[nodiscard]] virtual std::optional<std::string> misfit(const std::vector<TipPose>& course) const = 0;
  /// @returns nothing for a cut that does not come to rest.
  [[nodiscard]] virtual std::optional<PhotographedCut> cut(const std::vector<TipPose>& course, double power_w,
                                                           const PhotographSettings& settings, Workers& workers,
                                                           Monitor& monitor) const = 0;
};

/// The specimen of a file, of either laboratory. @throws DataError
[[nodiscard]] std::unique_ptr<const VirtualSpecimen> specimen_of(const std::filesystem::path& file,
                                                                 const steps::StepContext& context);
/// A request's specimen: that of its file, or one drawn from the context's seed.
/// @throws DataError; CaseError for factors or a series that its laboratory does not have.
[[nodiscard]] std::unique_ptr<const VirtualSpecimen> specimen_of(const MakeSpecimenRequest& request,
                                                                 const steps::StepContext& context);

/// A specimen of the first laboratory that cannot be held and stretched is a result: `monitor` gets a warning.
[[nodiscard]] bool is_stretched(const BenchBody& body, Monitor& monitor);
/// The truth about a virtual cut of the first laboratory.
[[nodiscard]] nlohmann::ordered_json truth_of(const BenchBody& body, const BenchCut& cut);

}  // namespace incise::laboratory
