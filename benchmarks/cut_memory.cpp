// What a cut holds: expected_memory_bytes beside the peak of a process that makes the model of a block and cuts a few
// steps, less what it held before. One process for each size; prints the table of docs/records/cutting.md.
#include "process_cost.hpp"

#include <incise/cutting/incision.hpp>
#include <incise/cutting/incision_memory.hpp>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace incise::bench {
namespace {

constexpr double kSideMm = 32.0;
constexpr double kHeightMm = 8.0;

struct Size {
  std::array<int, 3> cells;
  VolumeTreatment volume;
};
constexpr std::array<Size, 5> kSizes{{
    {{24, 24, 3}, VolumeTreatment::PerTet},
    {{34, 25, 8}, VolumeTreatment::PerTet},
    {{44, 44, 9}, VolumeTreatment::PerTet},
    {{60, 60, 14}, VolumeTreatment::PerTet},
    {{24, 24, 12}, VolumeTreatment::Averaged},
}};

/// Asks to stop once all is held that a cut holds, but for frames.
class StopSoon : public Monitor {
 public:
  void progress(std::string_view, double) override { ++steps_; }
  [[nodiscard]] bool is_cancelled() const override { return steps_ >= 3; }

 private:
  int steps_ = 0;
};

ToolPath ring() {
  ToolPath path;
  for (int i = 0; i < 32; ++i) {
    const double angle = 2.0 * M_PI * i / 32.0;
    Waypoint waypoint;
    waypoint.position_mm =
        Vec3(0.5 * kSideMm + 9.0 * std::cos(angle), 0.5 * kSideMm + 9.0 * std::sin(angle), kHeightMm);
    waypoint.depth_mm = 4.0;
    path.waypoints.push_back(waypoint);
  }
  return path;
}

void print_row(const Size& size) {
  TetMesh mesh = make_block({kSideMm, kSideMm, kHeightMm}, size.cells);
  const std::size_t tets = mesh.tets.size();
  const std::uint64_t expected = expected_memory_bytes(mesh.vertices.size(), tets, size.volume, 0);
  Material material{.volume = size.volume};
  const double before = peak_bytes();
  const TissueModel model =
      make_tissue_model(std::move(mesh), material,
                        {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(kSideMm + 1, kSideMm + 1, 0.1))}}});
  IncisionSettings settings;
  Workers workers(1);
  StopSoon monitor;
  static_cast<void>(simulate_incision(model, rest_state(model), ring(), settings, workers, monitor));
  fmt::print("| {}{} | {:.1f} | {:.1f} |\n", tets, size.volume == VolumeTreatment::Averaged ? ", averaged volume" : "",
             1e-6 * static_cast<double>(expected), 1e-6 * (peak_bytes() - before));
}

}  // namespace
}  // namespace incise::bench

int main() {
  fmt::print("| tets | expected, MB | measured, MB |\n|---|---|---|\n");
  std::fflush(stdout);
  for (const incise::bench::Size& size : incise::bench::kSizes) {
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) {
      incise::bench::print_row(size);
      std::fflush(stdout);
      _exit(0);
    }
    int status = 0;
    if (waitpid(child, &status, 0) != child || status != 0) return 1;
  }
  return 0;
}
