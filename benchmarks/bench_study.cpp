// Cuts virtual specimens as planned, by a planner that knows the stretched tissue but not how cutting deforms it, and
// prints how far the inner edges lie from where they should, in truth and as a reader of photographs finds them: the
// figures that the bench's parameters are chosen by.
//   incise_bench_study [first seed] [specimens] [key=value ...]
// Keys: speed_mm_s, power_w, fine_mm, coarse_mm, way_mm, threads, draw_only (1: bodies are made and not cut),
// photo (1: photographs are taken and read), pictures (a folder for them, made before), and every parameter of a
// specimen (then not drawn).
#include <incise/bench_studies/planned_bench_cut.hpp>
#include <incise/core/error.hpp>
#include <incise/core/workers.hpp>
#include <incise/geometry/kerf_contours.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/virtual_bench/bench_cut.hpp>
#include <incise/virtual_bench/pictures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
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

/// Of the errors along one contour, mm.
struct Errors {
  double mean_abs = 0.0, sd_abs = 0.0, mean = 0.0, sd = 0.0, least = 0.0, most = 0.0;
};

Errors measure(const std::vector<double>& errors) {
  Errors result;
  const auto n = static_cast<double>(errors.size());
  result.least = result.most = errors.front();
  double squares = 0.0;
  for (const double e : errors) {
    result.mean_abs += std::abs(e) / n;
    result.mean += e / n;
    squares += e * e;
    result.least = std::min(result.least, e);
    result.most = std::max(result.most, e);
  }
  result.sd_abs = std::sqrt((squares - n * result.mean_abs * result.mean_abs) / (n - 1.0));
  result.sd = std::sqrt((squares - n * result.mean * result.mean) / (n - 1.0));
  return result;
}

struct Row {
  std::uint64_t seed = 0;
  std::size_t tets = 0;
  double body_s = 0.0, cut_s = 0.0, photo_s = 0.0;  // of computing
  double gap_deg = 0.0;                             // of a ring that is open
  double pull_n = 0.0;
  std::string outcome;
  BenchCut cut;
  std::optional<Errors> truth, photo;
};

struct Options {
  std::map<std::string, double> given{
      {"speed_mm_s", 7.0}, {"power_w", 35.0}, {"threads", 1.0}, {"draw_only", 0.0}, {"photo", 0.0}};
  BenchResolution resolution;
  std::string pictures;
};

double find_gap_deg(const BenchBody& body, const BenchCut& cut) {
  KerfInput kerf;
  const TetMesh& mesh = body.tissue->mesh;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (cut.after.is_live[t] != 0) continue;
    std::array<Vec3, 4> corners;
    for (std::size_t c = 0; c < 4; ++c) corners[c] = body.stretched.positions[mesh.tets[t][c].index()];
    kerf.removed_tets.push_back(corners);
  }
  kerf.surface = skin_at(body, body.stretched.positions);
  kerf.inside_mm = curve_centroid(tumor_edge_at(body, body.stretched.positions));
  return midline_contour(kerf).gap_deg;
}

/// What a reader of photographs measures: nearest distance of the red line from the green one, less the target.
std::optional<Errors> read_photo(const BenchBody& body, const BenchCut& cut, const std::string& pictures) {
  const PhotographSettings settings;
  const ColorPicture picture = photograph(body, cut, settings);
  if (!pictures.empty()) {
    std::ofstream file(fmt::format("{}/photo_{}.png", pictures, body.specimen.seed), std::ios::binary);
    file << encode_png(picture);
  }
  const PhotoScale scale = scale_from_mm_per_pixel(settings.mm_per_pixel, picture.height);
  PhotoContours found;
  try {
    found = find_photo_contours(picture, scale, {}, fmt::format("photograph of {}", body.specimen.seed));
  } catch (const DataError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return std::nullopt;
  }
  if (!found.incision.is_closed) {
    fmt::print(stderr, "photograph of {}: the red line is open by {:.1f} mm\n", body.specimen.seed,
               found.red.max_gap_mm());
    return std::nullopt;
  }
  std::vector<double> errors;
  for (const Vec3& p : resample(found.incision, 360).points) {
    const double distance = nearest_on(found.tumor_edge, p).distance_mm;
    errors.push_back((contains_in_view(found.tumor_edge, p, -Vec3::UnitZ()) ? -distance : distance) -
                     kInnerEdgeTargetMm);
  }
  return measure(errors);
}

Row run(std::uint64_t seed, const Options& options) {
  Row row;
  row.seed = seed;
  Specimen specimen = draw_specimen(seed);
  for (const ParameterSpec& spec : parameter_specs()) {
    const auto found = options.given.find(std::string(spec.name));
    if (found != options.given.end()) specimen.*spec.member = found->second;
  }
  Workers workers(1);
  Monitor monitor;
  const double start = cpu_s();
  const BenchBody body = make_body(specimen, options.resolution, workers, monitor);
  row.tets = body.tissue->mesh.tets.size();
  row.body_s = cpu_s() - start;
  row.pull_n = body.stretch_force_n;
  row.outcome = to_string(body.outcome);
  if (body.outcome == Outcome::NotConverged || options.given.at("draw_only") != 0.0) return row;
  PlanSettings plan{.speed_mm_s = options.given.at("speed_mm_s"), .power_w = options.given.at("power_w")};
  row.cut = cut_as_planned(body, plan, workers, monitor);
  row.cut_s = cpu_s() - start - row.body_s;
  row.outcome = to_string(row.cut.outcome);
  if (row.cut.inner_edge)
    row.truth = measure(true_errors_mm(body, row.cut, kInnerEdgeTargetMm));
  else
    row.gap_deg = find_gap_deg(body, row.cut);
  if (options.given.at("photo") != 0.0) {
    const double before = cpu_s();
    row.photo = read_photo(body, row.cut, options.pictures);
    row.photo_s = cpu_s() - before;
  }
  return row;
}

void print(const Row& r) {
  const Errors none;
  const Errors& t = r.truth ? *r.truth : none;
  const Errors& p = r.photo ? *r.photo : none;
  fmt::print(
      "{},{},{:.2f},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.2f},{:.3f},{:.3f},{:.2f},{:.2f},{:.2f},{:.0f},{:.2f},{},{}"
      ",{},{},"
      "{:.3f},{},{:.1f},{:.1f},{:.1f},{:.1f}\n",
      r.seed, r.tets, r.pull_n, r.outcome, t.mean_abs, t.sd_abs, t.mean, t.sd, t.least, t.most, p.mean_abs, p.sd_abs,
      r.cut.shove_mm, r.cut.bulge_mm, r.cut.max_drag_mm, r.cut.mean_force_mn, r.cut.thermal_width_mm,
      r.cut.removed_tets, r.cut.loose_tets, r.cut.steps, r.cut.solutions, r.cut.unrest_mm, r.cut.linear_iterations,
      r.body_s, r.cut_s, r.photo_s, r.gap_deg);
  std::fflush(stdout);
}

/// Mean and standard deviation over specimens.
void print_summary(const char* name, const std::vector<Row>& rows, std::optional<Errors> Row::*which) {
  std::vector<double> means, sds;
  for (const Row& r : rows) {
    if (!(r.*which)) continue;
    means.push_back((r.*which)->mean_abs);
    sds.push_back((r.*which)->sd_abs);
  }
  if (means.size() < 2) return;
  const Errors m = measure(means);
  const Errors s = measure(sds);
  fmt::print(
      "# {}, {} closed rings: mean |error| {:.3f} mm (sd over specimens {:.3f}, {:.2f} to {:.2f}); sd along the "
      "contour {:.3f} mm ({:.2f} to {:.2f})\n",
      name, means.size(), m.mean, m.sd, m.least, m.most, s.mean, s.least, s.most);
}

/// The bands that the bench has to keep over many seeds, cut as planned at 7 mm/s and 35 W: mean absolute error of the
/// inner edge 1.4 to 2.1 mm (Paper Table II: 1.57 and 1.91), its standard deviation along the contour 0.6 to 1.0 mm.
/// Judged on photographs where they were taken, and on no fewer than 100 specimens.
bool are_in_bands(const std::vector<Row>& rows) {
  constexpr std::size_t kLeastSpecimens = 100;
  double mean = 0.0;
  double sd = 0.0;
  std::size_t n = 0;
  for (const Row& r : rows) {
    if (!r.photo) continue;
    mean += r.photo->mean_abs;
    sd += r.photo->sd_abs;
    ++n;
  }
  if (n < kLeastSpecimens) {
    fmt::print("# bands: not judged, {} photographs measured, {} are needed\n", n, kLeastSpecimens);
    return true;
  }
  mean /= static_cast<double>(n);
  sd /= static_cast<double>(n);
  const bool is_good = mean >= 1.4 && mean <= 2.1 && sd >= 0.6 && sd <= 1.0;
  fmt::print("# bands: mean {:.3f} mm in 1.4 to 2.1, sd along the contour {:.3f} mm in 0.6 to 1.0: {}\n", mean, sd,
             is_good ? "both hold" : "NOT KEPT");
  return is_good;
}

bool read_option(const std::string& argument, Options& options) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos) return false;
  const std::string key = argument.substr(0, equals);
  const double value = std::atof(argument.c_str() + equals + 1);
  if (key == "pictures")
    options.pictures = argument.substr(equals + 1);
  else if (key == "fine_mm")
    options.resolution.fine_mm = value;
  else if (key == "coarse_mm")
    options.resolution.coarse_mm = value;
  else if (key == "way_mm")
    options.resolution.way_mm = value;
  else {
    const auto specs = parameter_specs();
    const bool is_parameter =
        std::any_of(specs.begin(), specs.end(), [&key](const ParameterSpec& s) { return s.name == key; });
    if (!is_parameter && options.given.count(key) == 0) return false;
    options.given[key] = value;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t first = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const std::size_t count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 8;
  Options options;
  for (int i = 3; i < argc; ++i) {
    if (read_option(argv[i], options)) continue;
    fmt::print(stderr, "expected key=value with a key that the head of bench_study.cpp names, found '{}'\n", argv[i]);
    return 2;
  }
  std::vector<Row> rows(count);
  std::mutex printing;
  fmt::print(
      "seed,tets,pull_n,outcome,mean_abs_mm,sd_abs_mm,mean_mm,sd_mm,least_mm,most_mm,photo_mean_abs_mm,photo_sd_abs_mm,"
      "shove_mm,bulge_mm,drag_mm,"
      "force_mn,thermal_mm,removed,loose,steps,solutions,unrest_mm,cg,body_s,cut_s,photo_s,gap_deg\n");
  Workers workers(static_cast<int>(options.given.at("threads")));
  workers.for_each(count, 1, [&](std::size_t i) {
    rows[i] = run(first + i, options);
    const std::scoped_lock lock(printing);
    print(rows[i]);
    rows[i].cut.after = {};
  });
  std::map<std::string, int> outcomes;
  for (const Row& r : rows) ++outcomes[r.outcome];
  for (const auto& [name, n] : outcomes) fmt::print("# {}: {} of {}\n", name, n, count);
  print_summary("truth", rows, &Row::truth);
  print_summary("photographs", rows, &Row::photo);
  return are_in_bands(rows) ? 0 : 4;
}
