#include "mechanics/tet_batches.hpp"
#include "mechanics/topology.hpp"

#include <incise/core/units.hpp>
#include <incise/mechanics/tissue.hpp>

#include <map>

namespace incise {
namespace {

/// Appends the items of the copies to a list with one item per original; leaves an empty list empty.
template <class T, class Originals>
void add_copies(std::vector<T>& items, const Originals& originals) {
  if (items.empty()) return;
  items.reserve(items.size() + originals.size());
  for (const auto original : originals) items.push_back(items[original.index()]);
}

/// Returns the volume of tissue around each vertex of the split mesh, mm³: a quarter of the tissue in its tets.
std::vector<double> volumes_about(const TissueModel& model, const MeshSplits& splits) {
  const std::size_t count = model.mesh.tets.size(), whole = count - splits.copies.size();
  std::vector<double> volumes(model.mesh.vertices.size(), 0.0);
  for (std::size_t t = 0; t < count; ++t) {
    const double volume = 0.25 * share_of(splits, whole, TetId(t)) * model.volumes_mm3[t];
    for (const VertexId v : model.mesh.tets[t]) volumes[v.index()] += volume;
  }
  return volumes;
}

}  // namespace

TissueModel split_model(const TissueModel& whole, const MeshSplits& splits) {
  TissueModel model = whole;
  model.mesh = split_mesh(whole.mesh, splits);
  std::vector<TetId> tets;
  for (const SplitTet& tet : splits.copies) tets.push_back(tet.whole);
  add_copies(model.gradients, tets);
  add_copies(model.volumes_mm3, tets);
  add_copies(model.lame, tets);
  add_copies(model.fibres, tets);
  add_copies(model.toughness, tets);
  add_copies(model.is_fixed, splits.vertices);
  add_copies(model.prescribed_displacement_mm, splits.vertices);
  add_copies(model.holder, splits.vertices);
  add_copies(model.dead_load_mn, splits.vertices);
  add_copies(model.vertex_mass_kg, splits.vertices);

  const std::vector<double> volume_mm3 = volumes_about(model, splits);
  const double density = units::kg_mm3_from_kg_m3(model.material.density_kg_m3);
  std::map<VertexId, std::vector<VertexId>> families;  // of each vertex that has copies: itself and its copies
  const std::size_t whole_count = whole.mesh.vertices.size();
  const std::vector<VertexId> originals = whole_vertices(whole_count, splits);
  for (std::size_t v = whole_count; v < originals.size(); ++v) {
    auto& family = families[originals[v]];
    if (family.empty()) family.push_back(originals[v]);
    family.emplace_back(v);
  }
  std::vector<double> share(model.mesh.vertices.size(), 1.0);
  for (const auto& [original, family] : families) {
    double all_mm3 = 0.0;
    for (const VertexId v : family) all_mm3 += volume_mm3[v.index()];
    for (const VertexId v : family) {
      share[v.index()] = volume_mm3[v.index()] / all_mm3;
      model.dead_load_mn[v.index()] *= share[v.index()];
      model.vertex_mass_kg[v.index()] = density * volume_mm3[v.index()];
    }
  }
  // Corners of split tets may carry less mass, even if they have no copy: each part gives its mass to its own corners.
  for (const auto* list : {&splits.changed, &splits.copies}) {
    for (const SplitTet& tet : *list) {
      for (const VertexId v : tet.corners) model.vertex_mass_kg[v.index()] = density * volume_mm3[v.index()];
    }
  }
  for (SupportPlane& support : model.supports) {
    const std::size_t count = support.vertices.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto family = families.find(support.vertices[i]);
      if (family == families.end()) continue;
      const double stiffness = support.stiffness[i];
      for (const VertexId v : family->second) {
        if (v == support.vertices[i]) continue;
        support.vertices.push_back(v);
        support.stiffness.push_back(share[v.index()] * stiffness);
      }
      support.stiffness[i] *= share[support.vertices[i].index()];
    }
  }
  add_split_topology(model, whole, splits);
  model.batches = make_split_batches(model, whole, splits);
  return model;
}

}  // namespace incise
