#pragma once

#include <incise/report/report_data.hpp>

#include <functional>
#include <string>
#include <vector>

namespace incise::testing {

/// A block of 60 x 44 x 12 mm with a ring cut into its top, as data for a report. Nothing is simulated: the shapes are
/// formulas.
struct RingFixture {
  static constexpr int kPoints = 72;
  const Vec3 center{30.0, 22.0, 12.0};
  TetMesh mesh;

  explicit RingFixture(double cell_mm = 2.0);

  /// The stretched shape: a little longer along x, a bulge at the top.
  [[nodiscard]] Vec3 stretched(const Vec3& p) const;

  /// A closed curve round the centre on the stretched top: radius as a function of the angle.
  [[nodiscard]] Contour ring(const std::function<double(double)>& radius) const;
  [[nodiscard]] static double tumor_radius(double angle);

  /// Frames: rest, stretched, and `steps` of the cut.
  [[nodiscard]] std::vector<ReportFrame> frames(int steps) const;

  /// An incision whose signed error is about offset + amplitude * cos(angle).
  [[nodiscard]] ReportIncision incision(const std::string& name, double offset, double amplitude) const;

  [[nodiscard]] ReportAnimation animation(const std::string& name, int steps) const;

  /// A scan of 0.5 x 0.5 x 1 mm with the block as tissue, and its occupancy.
  [[nodiscard]] CtPicture scan() const;

  /// Everything that a report can show.
  [[nodiscard]] ReportData data(int steps) const;
};

}  // namespace incise::testing
