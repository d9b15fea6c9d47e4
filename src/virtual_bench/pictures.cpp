#include <incise/core/error.hpp>
#include <incise/virtual_bench/pictures.hpp>

namespace incise {
FrameShot shoot_frame(const BenchBody& body, const Mat4& T_camera_specimen) {
  const Specimen& specimen = body.specimen;
  SeenTissue seen;
  seen.vertices = body.stretched.positions;
  seen.rest = body.tissue->mesh.vertices;
  for (const BoundaryFace& face : body.skin) seen.triangles.push_back(face.corners);
  seen.is_skin.assign(seen.triangles.size(), 1);
  seen.tumor_edge = tumor_edge_at(body, body.stretched.positions);
  return shoot_frame(seen, {specimen.seed, specimen.depth_noise_mm, specimen.depth_scale, specimen.hole_percent},
                     T_camera_specimen);
}

ColorPicture photograph(const BenchBody& body, const BenchCut& cut, const PhotographSettings& settings) {
  INCISE_REQUIRE(cut.after.positions.size() == body.tissue->mesh.vertices.size(), "expected a cut of this body");
  SeenTissue seen;
  seen.vertices = cut.after.positions;
  seen.rest = body.tissue->mesh.vertices;
  add_faces(body, cut.after.is_live, seen.triangles, seen.is_skin);
  seen.tumor_edge = cut.tumor_edge;
  Marked marked;
  marked.seed = body.specimen.seed;
  marked.inner_edge = cut.inner_edge;
  marked.thermal_width_mm = cut.thermal_width_mm;
  marked.approach = body.approach;
  return photograph(seen, marked, settings);
}

}  // namespace incise
