#pragma once

#include <incise/cutting/incision.hpp>
#include <incise/geometry/kerf_contours.hpp>

#include <functional>
#include <optional>

namespace incise {

/// Thickness of a layer that has a mid-line of its own: enough for two tets, so that single ones do not decide whether
/// it is cut.
inline constexpr double kLayerThicknessMm = 1.0;

/// Measures what a cut left behind and enters it in `result`: mid-line of the kerf in the stretched reference, inner
/// edge and tumour edge in the final configuration, whether a ring closed. Uses result.record and result.final_state.
/// The measures are taken side by side.
void measure_kerf(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                  const IncisionSettings& settings, IncisionResult& result, Workers& workers);

/// The single measures; `kerf` is the removed tets in the stretched tissue before the cut.
[[nodiscard]] KerfBody kerf_body(const TetMesh& mesh, std::span<const Vec3> stretched,
                                 std::span<const std::uint8_t> is_live);
[[nodiscard]] KerfLayer kerf_layer(const KerfInput& kerf, const ToolPath& path, double depth_mm);
[[nodiscard]] DepthReached depth_reached(const KerfInput& kerf, const ToolPath& path, const IncisionSettings& settings);
[[nodiscard]] std::optional<TissueDrag> tissue_drag(const TissueModel& model, std::span<const Vec3> stretched,
                                                    const ToolPath& path, const IncisionSettings& settings,
                                                    const CutState& state);
/// @param body   of the kerf.  @param depth  for the floor.
/// @throws InvalidArgument for a tumour surface that does not enclose a volume.
[[nodiscard]] std::optional<DeepMargin> deep_margin(const KerfBody& body, const DepthReached& depth,
                                                    const IncisionSettings& settings);

/// The displacement at a place of live tissue within a tolerance, mm; nullopt: there is none.
using LiveDisplacement = std::function<std::optional<Vec3>(const Vec3& place, double tolerance_mm)>;

/// That of live tets. Keeps references to both lists of positions, mm.
[[nodiscard]] LiveDisplacement displacement_of_live(const TetMesh& mesh, std::span<const std::uint8_t> is_live,
                                                    std::span<const Vec3> from, std::span<const Vec3> to);

/// A curve on the kerf, moved from one configuration to the other with the live tissue next to it.
/// @param reach_mm  0: the curve lies on the skin. Else it lies in the gap, and moves by the mean displacement of the
/// live tissue that comes
///                  first to its left and to its right, looked for this far.
/// @param skin      of the body before the cut, in the curve's configuration
/// @returns nullopt where there is no live tissue within 1 mm of a curve on the skin, or within reach of one in the
/// gap.
[[nodiscard]] std::optional<Contour> carried_with_live(const Contour& curve, double reach_mm, const Vec3& approach,
                                                       const TriMesh& skin, const LiveDisplacement& displacement);

}  // namespace incise
