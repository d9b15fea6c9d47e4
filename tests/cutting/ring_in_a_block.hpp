#pragma once

#include <incise/cutting/incision.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace incise::testing {

/// A 32 x 32 x 8 mm block, held at its underside, and a thick needle that suits its coarse mesh.
class RingInABlock : public ::testing::Test {
 protected:
  /// Asks to stop half-way.
  class StopAtHalf : public Monitor {
   public:
    void progress(std::string_view, double fraction) override { fraction_ = fraction; }
    [[nodiscard]] bool is_cancelled() const override { return fraction_ > 0.5; }

   private:
    double fraction_ = 0.0;
  };

  static constexpr double kRadiusMm = 9.0;
  static inline const Vec3 kMiddle{16.0, 16.0, 8.0};

  /// Cells of 1.33 mm; coarser ones (cells_across < 24) for tests that cut often and do not look at where.
  explicit RingInABlock(int cells_across = 24)
      : model_(make_tissue_model(make_block({32, 32, 8}, {cells_across, cells_across, cells_across / 4}), Material{},
                                 {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}})) {
    settings_.tool = Needle{.diameter_mm = 1.6 * 24 / cells_across};
    settings_.cut.reach_mm = 0.4 * 24 / cells_across;
    settings_.cut.advance_per_step_mm = 0.8;
    settings_.cut.dullness = 2.0;
  }

  static ToolPath ring(double depth_mm) {
    ToolPath path;
    for (int i = 0; i < 32; ++i) {
      const double angle = 2.0 * M_PI * i / 32.0;
      const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
      Waypoint waypoint{.position_mm = kMiddle + kRadiusMm * outward, .depth_mm = depth_mm};
      path.waypoints.push_back(waypoint);
      path.tumor_edge.points.push_back(kMiddle + (kRadiusMm - 5.0) * outward);
    }
    return path;
  }

  [[nodiscard]] IncisionResult cut(const ToolPath& path) const {
    Workers workers(1);
    Monitor silent;
    return simulate_incision(model_, rest_state(model_), path, settings_, workers, silent);
  }

  static double mean_radius(const Contour& contour) {
    double sum = 0.0;
    for (const Vec3& p : contour.points) sum += std::hypot(p.x() - kMiddle.x(), p.y() - kMiddle.y());
    return sum / static_cast<double>(contour.points.size());
  }

  TissueModel model_;
  IncisionSettings settings_;
};

}  // namespace incise::testing
