#pragma once

#include "meshing/body_field.hpp"

#include <incise/meshing/sizing_field.hpp>

#include <vector>

namespace incise::meshing_detail {

/// The distance to the band, which refinement needs millions of times: sampled once on a lattice of 1 mm (coarser for a
/// large body) over the body's box, and interpolated trilinearly. Valid for every scaling of the same field.
/// Coordinates are the body's local ones.
class SampledSizing {
 public:
  SampledSizing(const SizingField& field, const BodyField& body, double iso);

  [[nodiscard]] double distance_mm(const Vec3& local) const;

  /// Returns Σ volume / h³ over the body, for edge lengths h of a scaled version of the field: about the number of
  /// cubes of edge h.
  [[nodiscard]] double cubes(const SizingField& scaled) const;

 private:
  void measure_body(const BodyField& body, double iso);

  double step_mm_ = 1.0;
  GrayVolume distance_mm_;          ///< on the lattice; empty for a uniform field
  std::vector<double> volume_mm3_;  ///< of the body, by distance in bins of kBinMm
};

}  // namespace incise::meshing_detail
