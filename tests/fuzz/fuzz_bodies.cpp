#include "fuzz/fuzz_bodies.hpp"

#include "mechanics/bodies.hpp"

#include <incise/io/mesh_io.hpp>

#include <fmt/format.h>

namespace incise::testing {
namespace {

TissueModel held(TetMesh mesh) {
  const Box3 box = bounding_box(mesh.vertices);
  Vec3 high = box.max() + Vec3::Ones();
  high.x() = box.min().x() + 0.1 * box.sizes().x();
  return make_tissue_model(std::move(mesh), Material{}, {FixedConstraint{BoxRegion{Box3(box.min() - Vec3::Ones(), high)}}}, Vec3::Zero());
}

/// A block in which every seventh inner vertex lies almost in the plane of its neighbours: tets a hundredth as thick as they are wide.
TetMesh block_with_slivers() {
  const Vec3 size(20, 16, 12);
  TetMesh mesh = make_block(size, {10, 8, 6});
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 7) {
    Vec3& p = mesh.vertices[v];
    if ((p.array() > 1e-9).all() && ((size - p).array() > 1e-9).all()) p.z() += 1.96;  // of a cell of 2 mm
  }
  return mesh;
}

/// A tube along x: a block without its core.
TetMesh tube() {
  const TetMesh block = make_block({24, 12, 12}, {12, 6, 6});
  TetMesh mesh;
  std::vector<std::int32_t> place(block.vertices.size(), -1);
  for (const Tet& t : block.tets) {
    Vec3 middle = Vec3::Zero();
    for (const VertexId v : t) middle += 0.25 * block.vertices[v.index()];
    if (std::abs(middle.y() - 6.0) < 4.0 && std::abs(middle.z() - 6.0) < 4.0) continue;
    Tet kept = t;
    for (VertexId& v : kept) {
      std::int32_t& at = place[v.index()];
      if (at < 0) {
        at = static_cast<std::int32_t>(mesh.vertices.size());
        mesh.vertices.push_back(block.vertices[v.index()]);
      }
      v = VertexId(static_cast<std::size_t>(at));
    }
    mesh.tets.push_back(kept);
  }
  return mesh;
}

/// Scaled so that its longest side is 60 mm, whatever unit its file is in.
TetMesh read_scaled(const std::filesystem::path& file) {
  TetMesh mesh = read_tet_mesh(file);
  const double longest = bounding_box(mesh.vertices).sizes().maxCoeff();
  for (Vec3& p : mesh.vertices) p *= 60.0 / longest;
  return mesh;
}

}  // namespace

std::vector<FuzzBody> fuzz_bodies(const std::filesystem::path& data_dir) {
  std::vector<FuzzBody> bodies;
  bodies.push_back({"block", held(make_block({20, 16, 12}, {10, 8, 6}))});
  bodies.push_back({"fine block", held(make_block({20, 16, 12}, {16, 12, 9}))});
  bodies.push_back({"irregular block", held(irregular_block({20, 16, 12}, {10, 8, 6}, 0.2, 3))});
  bodies.push_back({"block with slivers", held(block_with_slivers())});
  bodies.push_back({"sheet", held(make_block({40, 30, 1}, {20, 15, 1}))});
  bodies.push_back({"beam", held(make_block({80, 4, 4}, {60, 3, 3}))});
  bodies.push_back({"tube", held(tube())});
  if (data_dir.empty()) {
    fmt::print("NOT FUZZED: liver and tongues, because INCISE_DATA_DIR does not name the folder of shared test data\n");
    return bodies;
  }
  bodies.push_back({"liver", held(read_scaled(data_dir / "meshes/sofa/liver2.msh"))});
  bodies.push_back({"ArtiSynth tongue", held(read_scaled(data_dir / "meshes/artisynth_tongue/tongue.1.node"))});
  bodies.push_back({"tongue v3", held(read_scaled(data_dir / "meshes/lrquad_tongue/tongue_tuned_v3.1.node"))});
  return bodies;
}

TissueModel fuzz_block() {
  SupportConstraint platform;
  return make_tissue_model(make_block({30, 20, 10}, {12, 8, 4}), Material{}, {FixedConstraint{plane_x(0.0)}, platform});
}

}  // namespace incise::testing
