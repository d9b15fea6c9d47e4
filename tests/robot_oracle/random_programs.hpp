#pragma once

#include <incise/core/random.hpp>
#include <incise/geometry/tet_mesh.hpp>
#include <incise/robot/program.hpp>

#include <optional>

namespace incise::testing {

/// A program at a random place with a random tool and a random surface beside it.
struct RandomProgram {
  ToolPath path;
  RobotProgram program;
  TriMesh surface;
};

/// Nothing where the arm does not reach what was drawn. Same seed, same program.
[[nodiscard]] std::optional<RandomProgram> random_program(Random& random);

}  // namespace incise::testing
