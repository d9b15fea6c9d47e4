#pragma once

#include "meshing/body_field.hpp"

#include <optional>
#include <vector>

namespace incise::meshing_detail {

/// The volume enclosed by each iso surface of a body, from samples spread evenly over its voxels.
class VolumeByIso {
 public:
  explicit VolumeByIso(const BodyField& body);
  [[nodiscard]] double volume_mm3(double iso) const;
  /// Returns the iso value whose surface encloses the volume; nullopt if none in [0.1, 0.9] does.
  [[nodiscard]] std::optional<double> iso_for(double volume_mm3) const;

 private:
  std::vector<double> above_mm3_;  ///< volume where the value is at least b / bins, b = 0 … bins
};

}  // namespace incise::meshing_detail
