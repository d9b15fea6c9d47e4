#pragma once

#include <incise/cutting/incision.hpp>
#include <incise/geometry/kerf_contours.hpp>

#include <functional>
#include <optional>

namespace incise {

class PointLattice;

/// Thickness of a layer: about two tets, so that a single tet does not decide whether the layer is cut.
inline constexpr double kLayerThicknessMm = 1.0;

/// Checks, before a cut is computed, what measuring it will require. @throws InvalidArgument as measure_kerf.
void require_measurable(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                        const IncisionSettings& settings);

/// Measures a cut and stores the measures in `result`: mid-line of the kerf in the stretched reference, inner edge and
/// tumour edge in the final configuration, whether a ring closed, and IncisionResult::kerf. Uses result.record and
/// result.final_state. Takes the measures in parallel.
/// @throws InvalidArgument for a tumour edge more than 0.5 mm off the tissue, and as deep_margin.
void measure_kerf(const TissueModel& model, const TissueState& stretched, const ToolPath& path,
                  const IncisionSettings& settings, IncisionResult& result, Workers& workers);

/// Returns mean and range of values, of which there is at least one.
/// @param weights  of the values in the mean; empty: 1 each.
[[nodiscard]] Spread spread_of(std::span<const double> values, std::span<const double> weights = {});

/// The single measures. `kerf`: the removed tissue as tets in the stretched tissue before the cut.
[[nodiscard]] KerfBody kerf_body(const TetMesh& mesh, std::span<const Vec3> stretched,
                                 std::span<const std::uint8_t> is_live);
[[nodiscard]] KerfLayer kerf_layer(const KerfInput& kerf, const ToolPath& path, double depth_mm);
[[nodiscard]] DepthReached depth_reached(const KerfInput& kerf, const ToolPath& path, const IncisionSettings& settings);
/// @param lattice  the points of a cut by points on the whole mesh; null: of a cut by another rule
[[nodiscard]] std::optional<TissueDrag> tissue_drag(const TissueModel& model, const PointLattice* lattice,
                                                    std::span<const Vec3> stretched, const ToolPath& path,
                                                    const IncisionSettings& settings, const CutState& state);
/// @throws InvalidArgument for a tumour surface that does not enclose a volume.
void require_volume(const TriMesh& tumor_surface);
/// @param body   of the kerf.
/// @param depth  of the kerf, for DeepMargin::floor_below_mm.
/// @throws InvalidArgument as require_volume.
[[nodiscard]] std::optional<DeepMargin> deep_margin(const KerfBody& body, const DepthReached& depth,
                                                    const IncisionSettings& settings);

/// Gives the displacement of the live tissue at a place, mm; nullopt: no live tissue lies within `tolerance_mm` of it.
using LiveDisplacement = std::function<std::optional<Vec3>(const Vec3& place, double tolerance_mm)>;

/// Returns the displacement of live tets from one configuration to another. Keeps references to `from` and `to`.
/// @param from, to  positions of the vertices, N x 3, mm.
[[nodiscard]] LiveDisplacement displacement_of_live(const TetMesh& mesh, std::span<const std::uint8_t> is_live,
                                                    std::span<const Vec3> from, std::span<const Vec3> to);

/// Moves a curve on the kerf from one configuration to another with the live tissue next to it.
/// @param reach_mm  0: the curve lies on the skin. Above 0: it lies in the gap, and each point moves by the mean
///                  displacement of the nearest live tissue to its left and to its right, each within this distance.
/// @param skin      of the body before the cut, in the curve's configuration.
/// @returns nullopt if a point of the curve has no live tissue within 1 mm (on the skin), or within reach on one side
///          (in the gap).
[[nodiscard]] std::optional<Contour> carried_with_live(const Contour& curve, double reach_mm, const Vec3& approach,
                                                       const TriMesh& skin, const LiveDisplacement& displacement);

}  // namespace incise
