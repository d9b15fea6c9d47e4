#pragma once

#include <incise/imaging/phantom.hpp>
#include <incise/workflow/study.hpp>

#include <optional>

namespace incise::testing {

/// Gives a study the virtual specimen and keeps nothing.
class PhantomStore final : public Store {
 public:
  explicit PhantomStore(const Phantom& phantom) : phantom_(phantom) {}
  CtVolume read_ct(Monitor&) override { return phantom_.ct; }
  std::optional<TetMesh> read_specimen_mesh(Monitor&) override { return {}; }
  std::optional<Contour> read_tumor_edge() override { return phantom_.tumor_edge; }
  std::optional<Contour> read_line() override { return {}; }
  std::optional<ToolPath> read_given_path() override { return {}; }
  std::optional<Segmentation> load_segmentation() override { return {}; }
  void save_segmentation(const Segmentation&, double) override {}
  std::optional<TetMesh> load_mesh() override { return {}; }
  void save_mesh(const MeshProduct&, double) override {}
  std::optional<StaticResult> load_stretched(const TissueModel&) override { return {}; }
  void save_stretched(const TissueModel&, const StaticResult&, double) override {}
  std::optional<ToolPath> load_plan() override { return {}; }
  void save_plan(const ToolPath&, double) override {}
  std::optional<SimulatedCut> load_cut(CutRole) override { return {}; }
  void save_cut(CutRole, const TissueModel&, const StaticResult&, const SimulatedCut&, double) override {}
  std::optional<IncisionProgress> load_progress(CutRole, const TissueModel&, Monitor&) override { return {}; }
  void keep_progress(CutRole, const IncisionProgress&, bool) override {}
  std::optional<Correction> load_correction() override { return {}; }
  void save_correction(const Correction&, double) override {}
  bool adopt_cut(CutRole) override { return false; }

 private:
  const Phantom& phantom_;
};

}  // namespace incise::testing
