// Cuts virtual specimens as planned, by a planner that knows the stretched tissue but not how cutting deforms it, and
// prints how far the true inner edges lie from where they should: the figures that the bench's parameters are chosen by.
//   incise_bench_study [first seed] [specimens] [speed mm/s] [power W] [parameter=value ...] [fine_mm=0.85] [way_mm=0.3]
#include <incise/core/workers.hpp>
#include <incise/geometry/kerf_contours.hpp>
#include <incise/planning/plan_path.hpp>
#include <incise/robot/program.hpp>
#include <incise/virtual_bench/bench_cut.hpp>
#include <incise/virtual_bench/course.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

using namespace incise;

namespace {

/// Time that this thread has computed, s: other work on the machine does not count.
double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Row {
  std::uint64_t seed = 0;
  std::size_t tets = 0;
  double body_s = 0.0, cut_s = 0.0;  // of computing
  double gap_deg = 0.0, gap_mm = 0.0;  // of a ring that is open
  std::optional<BenchCut> cut;
  double pull_n = 0.0;
  double mean_abs = 0.0, sd_abs = 0.0, mean = 0.0, sd = 0.0, least = 0.0, most = 0.0;
};

struct Options {
  double speed_mm_s = 7.0;
  double power_w = 35.0;
  BenchResolution resolution;
  std::vector<std::pair<std::string, double>> given;
};

void measure(const BenchBody& body, Row& row) {
  if (!row.cut->inner_edge) return;
  const std::vector<double> errors = true_errors_mm(body, *row.cut, 4.5);
  const auto n = static_cast<double>(errors.size());
  row.least = row.most = errors.front();
  double squares = 0.0;
  for (const double e : errors) {
    row.mean_abs += std::abs(e) / n;
    row.mean += e / n;
    squares += e * e;
    row.least = std::min(row.least, e);
    row.most = std::max(row.most, e);
  }
  row.sd_abs = std::sqrt((squares - n * row.mean_abs * row.mean_abs) / (n - 1.0));
  row.sd = std::sqrt((squares - n * row.mean * row.mean) / (n - 1.0));
}

void find_gap(const BenchBody& body, Row& row) {
  KerfInput kerf;
  const TetMesh& mesh = body.tissue->mesh;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (row.cut->after.is_live[t] != 0) continue;
    std::array<Vec3, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = body.stretched.positions[mesh.tets[t][c].index()];
    kerf.removed_tets.push_back(corners);
  }
  kerf.surface = skin_at(body, body.stretched.positions);
  kerf.inside_mm = curve_centroid(tumor_edge_at(body, body.stretched.positions));
  const KerfMidline line = midline_contour(kerf);
  row.gap_deg = line.gap_deg;
  row.gap_mm = line.gap_mm;
}

Row run(std::uint64_t seed, const Options& options) {
  Row row;
  row.seed = seed;
  Specimen specimen = draw_specimen(seed);
  for (const auto& [name, value] : options.given) {
    for (const ParameterSpec& spec : parameter_specs())
      if (spec.name == name) specimen.*spec.member = value;
  }
  Workers workers(1);
  Monitor monitor;
  const double start = cpu_s();
  const BenchBody body = make_body(specimen, options.resolution, workers, monitor);
  row.tets = body.tissue->mesh.tets.size();
  row.body_s = cpu_s() - start;
  row.pull_n = body.stretch_force_n;
  PlanSettings plan;
  plan.speed_mm_s = options.speed_mm_s;
  const SurfaceQuery surface(skin_at(body, body.stretched.positions));
  ToolPath path = plan_ring(surface, tumor_edge_at(body, body.stretched.positions), plan);
  // The robot's base is taken to be the specimen's frame: program poses need no other.
  path.frame = PathFrame::Robot;
  ProgramSettings settings;
  settings.plunge_speed_mm_s = options.speed_mm_s;
  const RobotProgram program = make_program(path, settings);
  row.cut = cut_specimen(body, tip_course(program, specimen, Mat4::Identity()), options.power_w, workers, monitor);
  row.cut_s = cpu_s() - start - row.body_s;
  measure(body, row);
  if (!row.cut->inner_edge) find_gap(body, row);
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t first = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const std::size_t count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 8;
  Options options;
  if (argc > 3) options.speed_mm_s = std::atof(argv[3]);
  if (argc > 4) options.power_w = std::atof(argv[4]);
  for (int i = 5; i < argc; ++i) {
    const char* equals = std::strchr(argv[i], '=');
    if (std::strncmp(argv[i], "fine_mm=", 8) == 0) options.resolution.fine_mm = std::atof(equals + 1);
    if (std::strncmp(argv[i], "way_mm=", 7) == 0) options.resolution.way_mm = std::atof(equals + 1);
    if (equals != nullptr) options.given.emplace_back(std::string(argv[i], static_cast<std::size_t>(equals - argv[i])), std::atof(equals + 1));
  }
  std::vector<Row> rows(count);
  std::mutex printing;
  fmt::print("seed,tets,pull_n,outcome,mean_abs_mm,sd_abs_mm,mean_mm,sd_mm,least_mm,most_mm,bulge_mm,drag_mm,force_mn,"
             "thermal_mm,removed,loose,steps,cg,body_s,cut_s,gap_deg,gap_mm\n");
  Workers workers(std::getenv("BENCH_THREADS") != nullptr ? std::atoi(std::getenv("BENCH_THREADS")) : 1);
  workers.for_each(count, 1, [&](std::size_t i) {
    rows[i] = run(first + i, options);
    const Row& r = rows[i];
    const std::scoped_lock lock(printing);
    fmt::print("{},{},{:.2f},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.2f},{:.2f},{:.0f},{:.2f},{},{},{},{},{:.1f},{:.1f},{:.1f},{:.2f}\n",
               r.seed, r.tets, r.pull_n, to_string(r.cut->outcome), r.mean_abs, r.sd_abs, r.mean, r.sd, r.least, r.most,
               r.cut->bulge_mm, r.cut->max_drag_mm, r.cut->mean_force_mn, r.cut->thermal_width_mm, r.cut->removed_tets,
               r.cut->loose_tets, r.cut->steps, r.cut->linear_iterations, r.body_s, r.cut_s, r.gap_deg, r.gap_mm);
    std::fflush(stdout);
  });
  double mean_abs = 0.0, sd_abs = 0.0, mean = 0.0;
  std::size_t closed = 0;
  for (const Row& r : rows) {
    if (!r.cut->inner_edge) continue;
    ++closed;
    mean_abs += r.mean_abs;
    sd_abs += r.sd_abs;
    mean += r.mean;
  }
  const auto n = static_cast<double>(closed);
  fmt::print("# {} of {} rings closed; mean |error| {:.3f} mm, sd along the contour {:.3f} mm, mean signed {:.3f} mm\n",
             closed, count, mean_abs / n, sd_abs / n, mean / n);
}
