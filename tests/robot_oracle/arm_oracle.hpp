#pragma once

#include <incise/robot/checks.hpp>

#include <map>
#include <string>

namespace incise::testing {

/// What another library finds: kinematics by Orocos KDL, contacts and distances by FCL, hulls and pairs written down
/// once more from docs/models/robot.md.
struct OracleAnswer {
  bool is_in_contact = false;  ///< at any sample of the motion
  double least_mm = 1e9;       ///< distance, at every tenth sample, of those pairs that do not touch
};

/// By the name of the check: self_collision, base, surface_collision, shaft, needle.
[[nodiscard]] std::map<std::string, OracleAnswer> ask_oracle(const RobotProgram& program, const TriMesh& surface,
                                                             const CheckSettings& settings);

}  // namespace incise::testing
