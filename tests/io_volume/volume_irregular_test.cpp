// Series that are tilted, uneven or incomplete: found, named, and resampled to where the tissue is, or refused.
#include "io_volume/handmade_files.hpp"
#include "support/monitors.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/volume_io.hpp>

#include <gmock/gmock.h>

#include <functional>
#include <numbers>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace incise::testing;

/// A scan of a function of space: square slices at the given positions of their first pixel.
struct Scan {
  int pixels = 48;
  double pixel_mm = 1.0;
  Vec3 row = Vec3::UnitX();
  Vec3 column = Vec3::UnitY();
  std::vector<Vec3> positions;
};

using Tissue = std::function<double(const Vec3&)>;  // HU at a place

void write_scan(const TemporaryFolder& folder, const Scan& scan, const Tissue& tissue) {
  for (std::size_t k = 0; k < scan.positions.size(); ++k) {
    std::vector<std::uint16_t> stored;
    for (int j = 0; j < scan.pixels; ++j) {
      for (int i = 0; i < scan.pixels; ++i) {
        const Vec3 place = scan.positions[k] + scan.pixel_mm * (i * scan.row + j * scan.column);
        stored.push_back(static_cast<std::uint16_t>(std::lround(tissue(place)) + 1024));
      }
    }
    HandmadeSlice slice(scan.pixels, scan.pixels, scan.positions[k], stored);
    slice.axes(scan.row, scan.column).text(0x00280030, "DS", fmt::format("{0}\\{0}", scan.pixel_mm));
    write_bytes(folder / fmt::format("{}.dcm", k), slice.bytes());
  }
}

ReadVolume read(const TemporaryFolder& folder, const CtReadSettings& settings = {}) {
  RecordingMonitor monitor;
  ReadVolume result = read_ct(folder.path(), settings, monitor);
  EXPECT_EQ(monitor.messages, result.diagnostics.notices);
  EXPECT_TRUE(std::is_sorted(monitor.fractions.begin(), monitor.fractions.end()) || result.diagnostics.is_resampled);
  return result;
}

std::string failure_of(const TemporaryFolder& folder, const CtReadSettings& settings = {}) {
  return message_of<DataError>([&] { (void)read(folder, settings); });
}

/// Gantry tilted by `degrees`: slices lean backwards while the table moves along z in the given steps.
Scan tilted_scan(double degrees, const std::vector<double>& table_mm) {
  const double angle = degrees * std::numbers::pi / 180;
  Scan scan{.column = Vec3(0, std::cos(angle), -std::sin(angle))};
  for (const double z : table_mm) scan.positions.emplace_back(-24, -23 + 10 * std::sin(angle), z);
  return scan;
}

std::vector<double> even_steps(int count, double step) {
  std::vector<double> z;
  for (int k = 0; k < count; ++k) z.push_back(k * step);
  return z;
}

/// A table that moves by 2 mm for the first half, then by 3 mm: two spacings in one series, as head protocols have.
std::vector<double> mixed_steps() {
  std::vector<double> z{0};
  for (int k = 0; k < 10; ++k) z.push_back(z.back() + 2);
  for (int k = 0; k < 10; ++k) z.push_back(z.back() + 3);
  return z;
}

struct Body {
  double volume_mm3 = 0;
  Vec3 centre_mm = Vec3::Zero();
};

/// Volume and centre of what is brighter than air, each voxel counted by its share of brightness.
Body measure(const CtVolume& ct, double air_hu, double tissue_hu) {
  Body body;
  const auto& [columns, rows, slices] = ct.grid.size;
  double sum = 0;
  for (int k = 0; k < slices; ++k) {
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const double share = std::max(0.0, (ct.at(i, j, k) - air_hu) / (tissue_hu - air_hu));
        sum += share;
        body.centre_mm += share * ct.grid.world_from_index(Vec3(i, j, k));
      }
    }
  }
  body.centre_mm /= sum;
  body.volume_mm3 = sum * ct.grid.voxel_volume_mm3();
  return body;
}

constexpr double kRadius = 15;
const Vec3 kCentre(1.3, -0.8, 25.4);

/// A ball of water in air, its rim softened over 2 mm as a scanner's blur does; the softening leaves the volume
/// unchanged to 1 %.
double water_ball(const Vec3& place) {
  const double inside = std::clamp((kRadius - (place - kCentre).norm()) / 2 + 0.5, 0.0, 1.0);
  return -1024 + 1024 * inside;
}

void expect_the_ball(const CtVolume& ct) {
  const Body body = measure(ct, -1024, 0);
  const double expected = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
  EXPECT_NEAR(body.volume_mm3 / expected, 1.0, 0.01);
  EXPECT_LT((body.centre_mm - kCentre).norm(), 0.05) << body.centre_mm.transpose();
}

TEST(RegularSeries, IsNotTouched) {
  const TemporaryFolder folder;
  write_scan(folder, tilted_scan(0, even_steps(26, 2)), water_ball);
  const ReadVolume result = read(folder);
  EXPECT_THAT(result.diagnostics.notices, IsEmpty());
  EXPECT_FALSE(result.diagnostics.is_resampled);
  EXPECT_THAT(result.volume.grid.size, ElementsAre(48, 48, 26));
  expect_the_ball(result.volume);
}

TEST(RegularSeries, ToleratesRoundedPositions) {
  const TemporaryFolder folder;
  Scan scan = tilted_scan(0, even_steps(26, 2));
  for (std::size_t k = 0; k < scan.positions.size(); ++k)
    scan.positions[k] += Vec3(0.02, -0.02, k % 2 == 0 ? 0.02 : -0.02);
  write_scan(folder, scan, water_ball);
  EXPECT_FALSE(read(folder, {.irregular = IrregularSlices::Refuse}).diagnostics.is_resampled);
}

TEST(TiltedSeries, ComesBackWithTheBallInItsPlaceAndSize) {
  const TemporaryFolder folder;
  write_scan(folder, tilted_scan(18.5, even_steps(26, 2)), water_ball);
  const ReadVolume result = read(folder);
  EXPECT_TRUE(result.diagnostics.is_resampled);
  EXPECT_NEAR(result.diagnostics.gantry_tilt_deg, 18.5, 1e-6);
  EXPECT_THAT(result.diagnostics.notices,
              ElementsAre(AllOf(HasSubstr("gantry tilt of 18.5 deg"), HasSubstr("resampling"))));
  EXPECT_LT((result.volume.grid.direction.transpose() * result.volume.grid.direction - Mat3::Identity()).norm(), 1e-9);
  expect_the_ball(result.volume);
}

TEST(TiltedSeries, WouldMisplaceTheBallIfTakenAsRegular) {
  const TemporaryFolder folder;
  const Scan scan = tilted_scan(18.5, even_steps(26, 2));
  write_scan(folder, scan, water_ball);
  // The same pixels on the grid that a reader without an eye for tilt would believe in.
  Scan straight = scan;
  const Vec3 normal = scan.row.cross(scan.column);
  for (std::size_t k = 0; k < straight.positions.size(); ++k) {
    straight.positions[k] = scan.positions[0] + normal * normal.dot(scan.positions[k] - scan.positions[0]);
  }
  const TemporaryFolder wrong;
  write_scan(wrong, straight, [&](const Vec3& place) {
    const auto k = static_cast<std::size_t>(std::lround(normal.dot(place - straight.positions[0]) / (2 * normal[2])));
    return water_ball(place - straight.positions[k] + scan.positions[k]);
  });
  EXPECT_GT((measure(read(wrong).volume, -1024, 0).centre_mm - kCentre).norm(), 5);
}

TEST(UnevenSeries, ComesBackWithTheBallInItsPlaceAndSize) {
  const TemporaryFolder folder;
  write_scan(folder, tilted_scan(0, mixed_steps()), water_ball);
  const ReadVolume result = read(folder);
  EXPECT_THAT(result.diagnostics.notices,
              ElementsAre(AllOf(HasSubstr("uneven slice steps of 2 to 3 mm"), HasSubstr("2 mm from slice to slice"))));
  EXPECT_EQ(result.diagnostics.min_step_mm, 2);
  EXPECT_EQ(result.diagnostics.max_step_mm, 3);
  EXPECT_THAT(result.volume.grid.size, ElementsAre(48, 48, 26));
  expect_the_ball(result.volume);
}

TEST(TiltedAndUnevenSeries, ComesBackWithTheBallInItsPlaceAndSize) {
  const TemporaryFolder folder;
  write_scan(folder, tilted_scan(-12, mixed_steps()), water_ball);
  const ReadVolume result = read(folder);
  EXPECT_THAT(result.diagnostics.notices,
              ElementsAre(AllOf(HasSubstr("gantry tilt of 12.0 deg and uneven slice steps"))));
  expect_the_ball(result.volume);
}

TEST(TiltedAndUnevenSeries, ReproducesALinearFieldAndIsAirBeyondTheSlices) {
  // Linear interpolation of a linear field is exact: what remains is the rounding of stored values and of the result.
  const auto field = [](const Vec3& p) { return 100 + 3.1 * p[0] - 2.3 * p[1] + 4.7 * p[2]; };
  const TemporaryFolder folder;
  const Scan scan = tilted_scan(18.5, mixed_steps());
  write_scan(folder, scan, field);
  const CtVolume ct = read(folder).volume;
  const auto& [columns, rows, slices] = ct.grid.size;
  int air = 0;
  for (int k = 0; k < slices; ++k) {
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        if (ct.at(i, j, k) == kAirHu) {
          ++air;
        } else {
          ASSERT_NEAR(ct.at(i, j, k), field(ct.grid.world_from_index(Vec3(i, j, k))), 1.01)
              << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
  // All slices are there in full: the grid grew sideways by the shear, 50 mm * sin(18.5 deg) = 15.9 pixels, and that
  // much is air.
  EXPECT_EQ(rows, 48 + 16);
  EXPECT_NEAR(static_cast<double>(air) / (columns * slices), 16, 2);
  // Both ends of the stack are kept.
  EXPECT_NEAR((ct.grid.world_from_index(Vec3(0, 0, slices - 1)) - ct.grid.world_from_index(Vec3(0, 0, 0))).norm(),
              50 * std::cos(18.5 * std::numbers::pi / 180), 1e-6);
}

TEST(IrregularSeries, IsRefusedOnRequestWithBothReasons) {
  const TemporaryFolder folder;
  write_scan(folder, tilted_scan(18.5, mixed_steps()), water_ball);
  EXPECT_THAT(failure_of(folder, {.irregular = IrregularSlices::Refuse}),
              AllOf(HasSubstr("gantry tilt of 18.5 deg"), HasSubstr("uneven slice steps of 1.897 to 2.845 mm")));
}

TEST(SeriesShiftedSideways, IsNamedAsSuchAndPutRight) {
  const TemporaryFolder folder;
  Scan scan = tilted_scan(0, even_steps(26, 2));
  for (std::size_t k = 10; k < 20; ++k) scan.positions[k] += Vec3(2.5, 0, 0);  // recentred in mid-scan, back at the end
  write_scan(folder, scan, water_ball);
  const ReadVolume result = read(folder);
  EXPECT_THAT(result.diagnostics.notices, ElementsAre(HasSubstr("slices shifted sideways by up to 2.5 mm")));
  expect_the_ball(result.volume);
}

class SeriesWithAHole : public ::testing::Test {
 protected:
  SeriesWithAHole() {
    Scan scan = tilted_scan(0, even_steps(26, 2));
    scan.positions.erase(scan.positions.begin() + 9, scan.positions.begin() + 11);  // z = 18 and 20
    write_scan(folder, scan, water_ball);
  }
  TemporaryFolder folder;
};

TEST_F(SeriesWithAHole, IsRefusedWithTheHoleNamed) {
  EXPECT_THAT(failure_of(folder), AllOf(HasSubstr("2 missing"), HasSubstr("2 mm apart"),
                                        HasSubstr("between '8.dcm' and '9.dcm', 6 mm apart")));
}

TEST_F(SeriesWithAHole, IsBridgedOnRequestWithANotice) {
  const ReadVolume result = read(folder, {.missing = MissingSlices::Interpolate});
  EXPECT_THAT(result.diagnostics.notices,
              ElementsAre(AllOf(HasSubstr("2 missing slices"), HasSubstr("'8.dcm' and '9.dcm'"))));
  EXPECT_EQ(result.diagnostics.missing_slices, 2);
  EXPECT_THAT(result.volume.grid.size, ElementsAre(48, 48, 26));
  // Slices that were there are not changed by the bridge.
  const double hu = result.volume.at(24, 23, 15);
  EXPECT_EQ(hu, std::lround(water_ball(result.volume.grid.world_from_index(Vec3(24, 23, 15)))));
}

TEST_F(SeriesWithAHole, IsStillRefusedWhenBridgedSlicesAreIrregular) {
  EXPECT_THAT(failure_of(folder, {.irregular = IrregularSlices::Refuse, .missing = MissingSlices::Interpolate}),
              HasSubstr("missing"));
}

TEST(UnevenSeries, WithAForeignSliceFarAwayIsRefusedRatherThanBlownUp) {
  const TemporaryFolder folder;
  Scan scan = tilted_scan(0, {0, 1, 2, 3.5, 1e9});
  scan.pixels = 2;
  write_scan(folder, scan, [](const Vec3&) { return 0.0; });
  EXPECT_THAT(failure_of(folder), AllOf(HasSubstr("4.dcm"), HasSubstr("ImagePositionPatient"), HasSubstr("within 100000 mm")));
}

TEST(IrregularSeries, StopsOnRequest) {
  const TemporaryFolder folder;
  write_scan(folder, tilted_scan(18.5, mixed_steps()), water_ball);
  RecordingMonitor monitor;
  monitor.stop = true;
  EXPECT_THROW((void)read_ct(folder.path(), {}, monitor), Cancelled);
}

}  // namespace
}  // namespace incise
