#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/verdict.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/geometry/tool_path.hpp>
#include <incise/geometry/volume.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace incise {

/// What a run is given, wherever it comes from. A specimen is a CT, a label volume, or a mesh.
class Inputs {
 public:
  virtual ~Inputs() = default;

  virtual CtVolume read_ct(Monitor& monitor) = 0;
  /// The specimen's labels, where somebody drew them; nothing: thresholds find it in the CT.
  virtual std::optional<LabelVolume> read_labels(Monitor&) { return std::nullopt; }
  /// Hash of all that read_ct or, where there are labels, read_labels depends on; by default of what it gives.
  virtual std::string scan_digest(Monitor& monitor);
  virtual std::optional<TetMesh> read_specimen_mesh(Monitor&) {
    return std::nullopt;
  }  ///< nothing: the mesh is made from the CT
  virtual std::optional<Contour> read_tumor_edge() { return std::nullopt; }
  /// The tumour's closed surface, in the configuration of its edge; nothing: only the edge is known.
  virtual std::optional<TriMesh> read_tumor_surface() { return std::nullopt; }
  /// Young's modulus, kPa, in the frame of the scan; nothing: the settings have it.
  virtual std::optional<GrayVolume> read_elasticity_map() { return std::nullopt; }
  virtual std::optional<Contour> read_line() { return std::nullopt; }  ///< the curve of an open cut
  virtual std::optional<ToolPath> read_given_path() {
    return std::nullopt;
  }  ///< a path to follow in place of the planned one

  /// Whose specimen it is (io/specimen_id.hpp); empty: nobody's in particular.
  [[nodiscard]] virtual std::string specimen_id() { return {}; }
  /// What messages call the path that is followed.
  [[nodiscard]] virtual std::filesystem::path path_name() const { return "path"; }
  /// What an earlier assessment of this specimen advised against the path: as planned, that the simulation is not to
  /// be used; corrected, anything but to compensate.
  [[nodiscard]] virtual Verdict advice_against(bool /*is_corrected*/) const { return {}; }
};

}  // namespace incise
