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

/// Inputs of a run, from files or memory. A specimen is a CT, a label volume, or a mesh.
class Inputs {
 public:
  virtual ~Inputs() = default;

  virtual CtVolume read_ct(Monitor& monitor) = 0;
  /// Returns the specimen's labels if somebody drew them; nullopt: thresholds find the tissue in the CT.
  virtual std::optional<LabelVolume> read_labels(Monitor&) { return std::nullopt; }
  /// Returns a hash of everything that determines the result of read_ct or, if there are labels, of read_labels; by
  /// default a hash of that result.
  virtual std::string scan_digest(Monitor& monitor);
  /// Returns the specimen's mesh; nullopt: the mesh is made from the CT or the labels.
  virtual std::optional<TetMesh> read_specimen_mesh(Monitor&) {
    return std::nullopt;
  }
  virtual std::optional<Contour> read_tumor_edge() { return std::nullopt; }
  /// Returns the tumour's closed surface, in the configuration of its edge; nullopt: only the edge is known.
  virtual std::optional<TriMesh> read_tumor_surface() { return std::nullopt; }
  /// Returns a map of Young's modulus, kPa, in the frame of the scan; nullopt: the settings have it.
  virtual std::optional<GrayVolume> read_elasticity_map() { return std::nullopt; }
  virtual std::optional<Contour> read_line() { return std::nullopt; }  ///< the curve of an open cut
  /// Returns a path to follow instead of the planned one; nullopt: none.
  virtual std::optional<ToolPath> read_given_path() {
    return std::nullopt;
  }

  /// Returns the specimen id (io/specimen_id.hpp); empty: none.
  [[nodiscard]] virtual std::string specimen_id() { return {}; }
  /// Returns the name of the followed path in messages.
  [[nodiscard]] virtual std::filesystem::path path_name() const { return "path"; }
  /// Returns the objections of an earlier assessment of this specimen to its path. To the path as planned: the advice
  /// not to use the simulation. To the corrected path: any advice but to compensate.
  [[nodiscard]] virtual Verdict advice_against(bool /*is_corrected*/) const { return {}; }
};

}  // namespace incise
