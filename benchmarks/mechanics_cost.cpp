// Cost of a static stretch against the size of the body, and SOFA's beam: accuracy beside time, as a table and as CSV.
//   incise_mechanics_cost [--csv FILE] [--figure FILE.svg] [--large] [--million] [--threads N]
#include "cost_table.hpp"
#include "process_cost.hpp"
#include "test_body.hpp"

#include <incise/core/isa.hpp>
#include <incise/mechanics/motion.hpp>
#include <incise/report/line_plot.hpp>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace incise::bench {
namespace {

struct Row {
  std::string name;
  std::size_t tets = 0;
  std::size_t vertices = 0;
  double processor_s = 0.0;
  double wall_s = 0.0;
  int newton = 0;
  int linear_iterations = 0;
  double accuracy = 0.0;       // relative residual of the last equation
  double bytes_per_tet = 0.0;  // of all that its process held at most, program and libraries included
  bool has_converged = true;
};

Row stretch(double tets, int threads) {
  Workers workers(threads);
  const TissueModel model = pulled_block(tets);
  Monitor silent;
  const double start = processor_seconds();
  const StaticResult result = solve_static(model, StaticSettings{}, workers, silent);
  Row row{"static_stretch", model.mesh.tets.size(), model.mesh.vertices.size()};
  row.processor_s = processor_seconds() - start;
  row.wall_s = result.wall_s;
  row.newton = result.iterations;
  row.linear_iterations = result.linear_iterations;
  row.accuracy = result.relative_residual;
  row.bytes_per_tet = peak_bytes() / static_cast<double>(row.tets);
  row.has_converged = result.outcome == Outcome::Success;
  return row;
}

/// Runs `work` in a process of its own, so that its peak of memory is its own, too.
template <class Work>
Row in_own_process(const Work& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot start a process");
  if (child == 0) {
    const Row row = work();
    const std::string text = fmt::format("{} {} {} {} {} {} {} {} {} {}", row.name, row.tets, row.vertices, row.processor_s, row.wall_s,
                                         row.newton, row.linear_iterations, row.accuracy, row.bytes_per_tet, row.has_converged ? 1 : 0);
    const bool is_sent = write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(is_sent ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t n = 0; (n = read(ends[0], buffer.data(), buffer.size())) > 0;) text.append(buffer.data(), static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  Row row;
  std::istringstream in(text);
  in >> row.name >> row.tets >> row.vertices >> row.processor_s >> row.wall_s >> row.newton >> row.linear_iterations >> row.accuracy >>
      row.bytes_per_tet >> row.has_converged;
  if (status != 0 || in.fail()) throw std::runtime_error("a benchmark's process ended without its row");
  return row;
}

/// 8 x 26 x 8 vertices, 1000 implicit steps, as in SOFA's pull request 2842, which gives 13.97 s for
/// TetrahedralCorotational and 5.77 s for FastTetrahedralCorotational but neither material nor step nor machine: a
/// horizontal beam of 10 x 40 x 10 fixed at one end that falls in gravity, with the material, step and damping of
/// SOFA's corotational example (data/fem/sofa_corotational_beam), cells in six tets. Each system is solved to 1e-6,
/// where SOFA stops after 25 iterations wherever it is.
Row beam(int threads) {
  Workers workers(threads);
  constexpr int kSteps = 1000;
  Material material{.youngs_modulus_kpa = 1000.0, .poissons_ratio = 0.3};
  material.density_kg_m3 = 0.2e9;  // 0.2 per unit of volume
  const TissueModel model = make_tissue_model(make_block({10, 40, 10}, {7, 25, 7}), material,
                                              {FixedConstraint{EndRegion{-Vec3::UnitY(), 0.1}}}, Vec3(0, 0, -9));
  MotionSettings settings;
  settings.step_s = 0.05;
  settings.rayleigh_alpha = 0.1;
  settings.rayleigh_beta = 0.1;
  settings.solver = LinearSolver::ConjugateGradients;
  Motion motion = motion_at_rest(model, rest_state(model));
  MotionWorkspace workspace(model, settings);
  Row row{"beam_8x26x8_1000_steps", model.mesh.tets.size(), model.mesh.vertices.size()};
  const double start = processor_seconds();
  const double from = wall_seconds();
  for (int i = 0; i < kSteps; ++i) {
    const StepReport report = advance_motion(model, motion, settings, workspace, workers);
    row.newton += report.newton_iterations;
    row.linear_iterations += report.linear_iterations;
    row.accuracy = std::max(row.accuracy, report.relative_residual);
    row.has_converged = row.has_converged && report.outcome == Outcome::Success;
  }
  row.wall_s = wall_seconds() - from;
  row.processor_s = processor_seconds() - start;
  row.bytes_per_tet = peak_bytes() / static_cast<double>(row.tets);
  return row;
}

/// Slope of log(time) over log(tets), by least squares.
double exponent(const std::vector<Row>& rows) {
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (const Row& row : rows) {
    const double a = std::log(static_cast<double>(row.tets));
    const double b = std::log(row.processor_s);
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Time against size, both axes logarithmic, beside a line that grows as fast as the body.
std::string figure_of(const std::vector<Row>& stretches, double slope) {
  LinePlot plot{fmt::format("Static stretch from rest to 1e-6: time grows as tets^{:.2f}", slope), "tetrahedra", "wall time, s", true, true, {}};
  LineSeries measured{"measured", {}, {}, false};
  LineSeries linear{"proportional to the body", {}, {}, true};
  for (const Row& row : stretches) {
    const auto tets = static_cast<double>(row.tets);
    measured.add(tets, row.wall_s);
    linear.add(tets, stretches.back().wall_s * tets / static_cast<double>(stretches.back().tets));
  }
  plot.series = {measured, linear};
  return line_plot_svg(plot);
}

std::string line_of(const Row& row, int threads) {
  return fmt::format("{},{},{},{},{:.3f},{:.3f},{},{},{:.1e},{:.0f},{},{},{}\n", row.name, row.tets, row.vertices, threads,
                     row.processor_s, row.wall_s, row.newton, row.linear_iterations, row.accuracy, row.bytes_per_tet,
                     row.has_converged ? "yes" : "no", to_string(active_isa()), source_commit());
}

int run(int argc, char** argv) {
  std::string csv;
  std::string figure;
  std::vector<double> sizes{10e3, 30e3, 100e3};
  int threads = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--large") {
      sizes.push_back(300e3);
    } else if (argument == "--million") {
      sizes.push_back(1e6);
    } else if (argument == "--csv" && i + 1 < argc) {
      csv = argv[++i];
    } else if (argument == "--figure" && i + 1 < argc) {
      figure = argv[++i];
    } else if (argument == "--threads" && i + 1 < argc) {
      threads = std::atoi(argv[++i]);
    } else {
      throw std::runtime_error(
          fmt::format("expected [--csv FILE] [--figure FILE] [--large] [--million] [--threads N], found {}", argument));
    }
  }
  std::string table;
  tell(origin_line(), table);
  tell(
      "name,tets,vertices,threads,processor_s,wall_s,newton,linear_iterations,relative_residual,bytes_per_tet,converged,isa,"
      "commit\n",
      table);
  std::vector<Row> stretches;
  for (const double size : sizes) {
    stretches.push_back(in_own_process([&] { return stretch(size, threads); }));
    tell(line_of(stretches.back(), threads), table);
  }
  const Row bent = in_own_process([&] { return beam(threads); });
  tell(line_of(bent, threads), table);
  const double slope = exponent(stretches);
  fmt::print("processor time of the stretch grows as tets^{:.2f}\n", slope);
  write_text(csv, table);
  if (!figure.empty()) write_text(figure, figure_of(stretches, slope));
  const bool all_converged = std::all_of(stretches.begin(), stretches.end(), [](const Row& row) { return row.has_converged; });
  return all_converged && bent.has_converged ? 0 : 4;
}

}  // namespace
}  // namespace incise::bench

int main(int argc, char** argv) {
  return incise::bench::reporting_errors("incise_mechanics_cost", [&] { return incise::bench::run(argc, argv); });
}
