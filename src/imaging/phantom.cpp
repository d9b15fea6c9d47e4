#include "imaging/volume_filters.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/core/random.hpp>
#include <incise/core/units.hpp>
#include <incise/imaging/phantom.hpp>
#include <incise/imaging/tumor_star.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace incise {
namespace {

constexpr const char* kPhantomStage = "making the phantom";
constexpr double kScannerAirHu = -1000.0;
constexpr double kGreatestHu = 3071.0;  // 12 bits from kAirHu
constexpr double kAirAroundMm = 10.0;   // beside and above the specimen, and below the board
constexpr double kBoardBeyondMm = 6.0;  // margin of the board around the specimen
constexpr int kColumns = 5;             // sub-columns of a voxel along i, and along j
constexpr std::size_t kTextureWaves = 8;

Box3 board_of(const Box3& body, const PhantomSettings& settings) {
  return {Vec3(body.min().x() - kBoardBeyondMm, body.min().y() - kBoardBeyondMm, -settings.holder_thickness_mm),
          Vec3(body.max().x() + kBoardBeyondMm, body.max().y() + kBoardBeyondMm, 0.0)};
}

// Returns a tight grid, or square slices for a round field of view; shifted by a random fraction of a voxel, because a
// specimen's position in the scanner is random.
VolumeGrid scan_grid(const Box3& board, const Box3& body, const PhantomSettings& settings, Random& random) {
  Vec3 low = board.min() - Vec3::Constant(kAirAroundMm);
  Vec3 high = board.max() + Vec3::Constant(kAirAroundMm);
  high.z() = body.max().z() + kAirAroundMm;
  if (settings.field_of_view_mm > 0.0) {
    low.head<2>().setConstant(-0.5 * settings.field_of_view_mm);
    high.head<2>().setConstant(0.5 * settings.field_of_view_mm);
  }
  VolumeGrid grid;
  grid.spacing_mm = settings.spacing_mm;
  for (int axis = 0; axis < 3; ++axis) {
    grid.size[static_cast<std::size_t>(axis)] =
        static_cast<int>(std::ceil((high[axis] - low[axis]) / settings.spacing_mm[axis])) + 1;
    grid.origin_mm[axis] = low[axis] - random.uniform() * settings.spacing_mm[axis];
  }
  return grid;
}

double overlap(double low, double high, double from, double to) {
  return std::max(0.0, std::min(high, to) - std::max(low, from));
}

// Returns the share of tissue in each voxel: exact along k, sampled by kColumns² columns across.
GrayVolume tissue_share(const TongueShape& shape, const VolumeGrid& grid, Monitor& monitor) {
  GrayVolume share{grid, std::vector<float>(grid.voxel_count(), 0.0F)};
  const Vec3& h = grid.spacing_mm;
  const double low_z = grid.origin_mm.z() - 0.5 * h.z();
  std::vector<double> column(static_cast<std::size_t>(grid.size[2]));
  for (int j = 0; j < grid.size[1]; ++j) {
    throw_if_cancelled(monitor, kPhantomStage);
    monitor.progress(kPhantomStage, 0.5 * j / grid.size[1]);
    for (int i = 0; i < grid.size[0]; ++i) {
      std::fill(column.begin(), column.end(), 0.0);
      for (int s = 0; s < kColumns * kColumns; ++s) {
        const double x = grid.origin_mm.x() + (i + (s % kColumns + 0.5) / kColumns - 0.5) * h.x();
        const double y = grid.origin_mm.y() + (j + (s / kColumns + 0.5) / kColumns - 0.5) * h.y();
        const std::optional<TissueSpan> span = span_at(shape, x, y);
        if (!span) continue;
        const int first = std::max(0, static_cast<int>(std::floor((span->low_mm - low_z) / h.z())));
        const int last = std::min(grid.size[2] - 1, static_cast<int>(std::floor((span->high_mm - low_z) / h.z())));
        for (int k = first; k <= last; ++k)
          column[static_cast<std::size_t>(k)] +=
              overlap(span->low_mm, span->high_mm, low_z + k * h.z(), low_z + (k + 1) * h.z());
      }
      for (int k = 0; k < grid.size[2]; ++k)
        share.at(i, j, k) = static_cast<float>(column[static_cast<std::size_t>(k)] / (kColumns * kColumns * h.z()));
    }
  }
  return share;
}

// Slow changes of HU within muscle: a sum of waves 6 to 20 mm long with a given standard deviation.
struct Texture {
  struct Wave {
    Vec3 per_mm;
    double phase;
  };
  std::array<Wave, kTextureWaves> waves;
  double amplitude_hu = 0.0;

  [[nodiscard]] double at(const Vec3& p) const {
    double sum = 0.0;
    for (const Wave& wave : waves) sum += std::cos(wave.per_mm.dot(p) + wave.phase);
    return amplitude_hu * sum;
  }
};

Texture draw_texture(double sd_hu, Random& random) {
  Texture texture;
  texture.amplitude_hu = sd_hu * std::sqrt(2.0 / kTextureWaves);
  for (Texture::Wave& wave : texture.waves) {
    Vec3 heading;
    for (int axis = 0; axis < 3; ++axis) heading[axis] = random.normal();
    wave.per_mm = 2.0 * units::kPi / random.uniform(6.0, 20.0) * heading.normalized();
    wave.phase = random.uniform(0.0, 2.0 * units::kPi);
  }
  return texture;
}

// Returns HU without blur and noise. Tissue lies above z = 0 and the board below, so their shares of a voxel add up to
// at most 1.
GrayVolume mix(GrayVolume share, const Box3& board, const Texture& texture, const PhantomSettings& settings) {
  const VolumeGrid& grid = share.grid;
  const Vec3 half = 0.5 * grid.spacing_mm;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const Vec3 p = grid.world_from_index(Vec3(i, j, k));
        double plastic = 1.0;
        for (int axis = 0; axis < 3; ++axis)
          plastic *= overlap(p[axis] - half[axis], p[axis] + half[axis], board.min()[axis], board.max()[axis]) /
                     grid.spacing_mm[axis];
        const double tissue = share.at(i, j, k);
        const double muscle_hu = tissue > 0.0 ? settings.tissue_hu + texture.at(p) : 0.0;
        share.at(i, j, k) = static_cast<float>(kScannerAirHu * (1.0 - tissue - plastic) + settings.holder_hu * plastic +
                                               muscle_hu * tissue);
      }
  return share;
}

// Returns noise of unit standard deviation: white noise, averaged slightly with its neighbours in the slice, as by a
// reconstruction kernel.
std::vector<float> noise_slice(int nx, int ny, Random& random) {
  constexpr std::array<double, 3> kTaps{0.25, 0.5, 0.25};
  const double gain = 1.0 / (0.25 * 0.25 + 0.5 * 0.5 + 0.25 * 0.25);  // restores unit deviation after both axes
  const auto wide = static_cast<std::size_t>(nx + 2);
  std::vector<double> white(wide * static_cast<std::size_t>(ny + 2));
  for (double& value : white) value = random.normal();
  std::vector<float> noise;
  noise.reserve(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  for (std::size_t j = 0; j < static_cast<std::size_t>(ny); ++j)
    for (std::size_t i = 0; i < static_cast<std::size_t>(nx); ++i) {
      double sum = 0.0;
      for (std::size_t b = 0; b < 3; ++b)
        for (std::size_t a = 0; a < 3; ++a) sum += kTaps[a] * kTaps[b] * white[i + a + wide * (j + b)];
      noise.push_back(static_cast<float>(gain * sum));
    }
  return noise;
}

CtVolume scan(const GrayVolume& ideal, const PhantomSettings& settings, Random& random) {
  const VolumeGrid& grid = ideal.grid;
  CtVolume ct{grid, {}};
  ct.voxels.reserve(grid.voxel_count());
  const double radius = 0.5 * settings.field_of_view_mm;
  for (int k = 0; k < grid.size[2]; ++k) {
    const std::vector<float> noise = noise_slice(grid.size[0], grid.size[1], random);
    std::size_t n = 0;
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i, ++n) {
        const double hu = ideal.at(i, j, k) + settings.noise_hu * noise[n];
        const bool is_padding = radius > 0.0 && grid.world_from_index(Vec3(i, j, k)).head<2>().norm() > radius;
        ct.voxels.push_back(
            is_padding ? kAirHu : static_cast<std::int16_t>(std::lround(std::clamp(hu, double{kAirHu}, kGreatestHu))));
      }
  }
  return ct;
}

void require_valid(const PhantomSettings& settings) {
  const std::vector<Problem> problems = validate(settings);
  if (!problems.empty())
    throw CaseError("phantom", "settings",
                    fmt::format("{} violation(s): {}", problems.size(), fmt::join(sentences(problems), "; ")),
                    "settings in their ranges");
}

CtVolume scan_with(const TongueShape& shape, const PhantomSettings& settings, Random& random, Monitor& monitor) {
  const Texture texture = draw_texture(settings.texture_hu, random);
  const Box3 body = bounds_mm(shape);
  const Box3 board = board_of(body, settings);
  const VolumeGrid grid = scan_grid(board, body, settings, random);
  GrayVolume ideal = mix(tissue_share(shape, grid, monitor), board, texture, settings);
  monitor.progress(kPhantomStage, 0.7);
  throw_if_cancelled(monitor, kPhantomStage);
  Workers alone(1);
  ideal = gaussian(std::move(ideal), settings.blur_mm, alone);
  CtVolume ct = scan(ideal, settings, random);
  monitor.progress(kPhantomStage, 1.0);
  return ct;
}

Vec3 on_back(const TongueShape& shape, double x_mm, double y_mm) {
  const std::optional<TissueSpan> span = span_at(shape, x_mm, y_mm);
  INCISE_REQUIRE(span.has_value(), "expected a tumour that fits on the back of the tongue; reduce tumor_diameter_mm");
  return {x_mm, y_mm, span->high_mm};
}

// Rings of points from the centre (one point) to the edge, on the back or on the bowl beneath it; each has as many
// points as the edge.
constexpr int kRings = 8;

Vec3 bowl_point(const TongueShape& shape, const Vec3& center, const Vec3& edge, double share, double depth_mm) {
  const Vec3 flat = center + share * (edge - center);
  Vec3 p = on_back(shape, flat.x(), flat.y());
  p.z() -= depth_mm * std::sqrt(std::max(0.0, 1.0 - share * share));
  return p;
}

VertexId add_vertex(TriMesh& mesh, const Vec3& p) {
  mesh.vertices.push_back(p);
  return VertexId(mesh.vertices.size() - 1);
}

// Adds one side of the tumour inside `rim`: the back for `depth_mm` 0, otherwise the bowl. Faces up if `is_up`.
void add_cap(TriMesh& mesh, const TongueShape& shape, const Vec3& center, const std::vector<VertexId>& rim,
             double depth_mm, bool is_up) {
  const std::size_t sides = rim.size();
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    mesh.triangles.push_back(is_up ? Triangle{a, b, c} : Triangle{a, c, b});
  };
  std::vector<VertexId> outer = rim;
  for (int ring = kRings - 1; ring >= 1; --ring) {
    std::vector<VertexId> inner;
    for (std::size_t n = 0; n < sides; ++n)
      inner.push_back(add_vertex(mesh, bowl_point(shape, center, mesh.vertices[rim[n].index()],
                                                  static_cast<double>(ring) / kRings, depth_mm)));
    for (std::size_t n = 0; n < sides; ++n) {
      const std::size_t next = (n + 1) % sides;
      add(inner[n], outer[n], outer[next]);
      add(inner[n], outer[next], inner[next]);
    }
    outer = std::move(inner);
  }
  const VertexId middle = add_vertex(mesh, bowl_point(shape, center, center, 0.0, depth_mm));
  for (std::size_t n = 0; n < sides; ++n) add(middle, outer[n], outer[(n + 1) % sides]);
}

// Draws the tumour onto the back of `phantom.shape`: sets `tumor_edge`, `tumor`, `tumor_center_mm` and
// `tissue_below_tumor_mm`.
void draw_tumor(const PhantomSettings& settings, Random& random, Phantom& phantom) {
  const TumorStar star = draw_tumor_star(settings.tumor_diameter_mm, settings.tumor_irregularity, random);
  const double y = (settings.tumor_position - 0.5) * phantom.shape.length_mm;
  const Vec3 center = on_back(phantom.shape, midline_x_mm(phantom.shape, y), y);
  std::vector<VertexId> rim;
  for (int n = 0; n < settings.tumor_points; ++n) {
    const double angle = 2.0 * units::kPi * n / settings.tumor_points;
    const double r = star.radius_at_mm(angle);
    const Vec3 p = on_back(phantom.shape, center.x() + r * std::cos(angle), center.y() + r * std::sin(angle));
    phantom.tumor_edge.points.push_back(p);
    rim.push_back(add_vertex(phantom.tumor, p));
  }
  add_cap(phantom.tumor, phantom.shape, center, rim, 0.0, true);
  add_cap(phantom.tumor, phantom.shape, center, rim, settings.tumor_depth_mm, false);
  phantom.tumor_center_mm = center;
  const std::optional<TissueSpan> span = span_at(phantom.shape, center.x(), center.y());
  phantom.tissue_below_tumor_mm = span->high_mm - span->low_mm;
}

}  // namespace

std::vector<Problem> validate(const PhantomSettings& settings) {
  std::vector<Problem> problems = problems_of(settings);
  if (settings.field_of_view_mm != 0.0) {
    // The circle must hold the largest specimen that these settings can draw.
    const TongueShapeSettings& shape = settings.shape;
    const double diagonal =
        std::hypot(shape.length_mm, shape.width_mm + 2.0 * shape.bend_mm) * (1.0 + shape.variation + shape.asymmetry);
    const double least = std::ceil(diagonal + kAirAroundMm);
    Expect{problems}(settings.field_of_view_mm >= least, "field_of_view_mm", settings.field_of_view_mm,
                     fmt::format("0, or {} or more", least));
  }
  return problems;
}

Phantom make_phantom(const PhantomSettings& settings, Monitor& monitor) {
  require_valid(settings);
  Random random(settings.seed);
  Phantom phantom;
  phantom.shape = draw_tongue_shape(settings.shape, random);
  phantom.true_volume_mm3 = volume_mm3(phantom.shape);
  phantom.tip_end_mm = -0.5 * phantom.shape.length_mm;
  phantom.posterior_end_mm = 0.5 * phantom.shape.length_mm;
  draw_tumor(settings, random, phantom);
  phantom.ct = scan_with(phantom.shape, settings, random, monitor);
  return phantom;
}

CtVolume scan_shape(const TongueShape& shape, const PhantomSettings& settings, Monitor& monitor) {
  require_valid(settings);
  Random random(settings.seed);
  return scan_with(shape, settings, random, monitor);
}

}  // namespace incise
