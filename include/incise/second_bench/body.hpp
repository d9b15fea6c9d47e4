#pragma once

#include <incise/core/monitor.hpp>
#include <incise/core/outcome.hpp>
#include <incise/geometry/contour.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/second_bench/specimen.hpp>

#include <memory>
#include <vector>

namespace incise::second_bench {

struct BodyState;

/// How finely the second bench computes. Part of what it is: results change with it.
struct Resolution {
  double brick_mm = 2.0;   ///< round the tumour's ring
  double coarse_mm = 4.5;  ///< far from it
  double way_mm = 0.5;     ///< of the tool between two looks at what parts
  int relaxations = 14;    ///< of tissue in each of these
};

struct Body {
  Specimen specimen;
  Resolution resolution;
  std::shared_ptr<const BodyState> state;  ///< held, stretched
  Contour tumor_edge_rest;
  double stretch_force_n = 0.0;  ///< the suture's pull when the cut begins
  double gauge_force_n = 0.0;    ///< what its gauge said when it was read, bias included
  double residual = 0.0;
  Outcome outcome = Outcome::NotConverged;
  double wall_s = 0.0;
};

[[nodiscard]] Body make_body(const Specimen& specimen, const Resolution& resolution, Monitor& monitor);

}  // namespace incise::second_bench
