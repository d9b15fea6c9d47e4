#pragma once

#include "robot/speed_law.hpp"

#include <incise/robot/program_reading.hpp>

#include <span>
#include <vector>

namespace incise::robot_detail {

/// The tip's route through consecutive movel and movep commands up to the next stop: straight lines, and at blends the
/// circles that touch them.
///
///        P1        r: from the corner to the beginning of the circle
///       /  \.      the tip cuts the corner by r tan(theta / 4)
///      / (  )\     theta: the turn at the corner
///    P0       P2
class TipRoute {
 public:
  /// @param R_start  orientation at the start.  @param slider  share of the controller's speed
  TipRoute(const Vec3& start_mm, const Mat3& R_start, std::span<const ScriptCommand> commands, double slider);

  [[nodiscard]] bool do_blends_overlap() const { return overlap_command_ >= 0; }
  [[nodiscard]] std::size_t overlap_line() const { return overlap_line_; }
  [[nodiscard]] double duration_s() const { return law_.duration_s(); }
  /// Returns T_base_tool at a time, mm, and in `command` the index of the command at whose pose the current move ends.
  [[nodiscard]] Mat4 at(double time_s, std::size_t& command) const;

 private:
  struct Piece {
    double begin_mm = 0.0;
    Vec3 from, along;        ///< unit direction at the beginning
    Vec3 inwards;            ///< circles: unit, to the centre
    double radius_mm = 0.0;  ///< 0: straight
  };
  struct Knot {
    double arc_mm = 0.0;
    Eigen::Quaterniond turn;
  };
  void add(const Vec3& from, const Vec3& along, double length_mm, double speed_mm_s, const Vec3& inwards = Vec3::Zero(),
           double radius_mm = 0.0);

  std::vector<Piece> pieces_;
  std::vector<Knot> knots_;  ///< orientation at each command's corner
  std::vector<SpeedPiece> speeds_;
  SpeedLaw law_;
  double length_mm_ = 0.0;
  int overlap_command_ = -1;
  std::size_t overlap_line_ = 0;
};

/// Returns the rotation given as axis times angle, rad.
[[nodiscard]] Eigen::Quaterniond turn_of(const Vec3& rotation_vector);

}  // namespace incise::robot_detail
