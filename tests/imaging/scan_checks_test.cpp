#include <incise/imaging/phantom.hpp>
#include <incise/imaging/scan_checks.hpp>
#include <incise/imaging/segmentation.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace incise {
namespace {

using ::testing::HasSubstr;

CtVolume virtual_scan(std::uint64_t seed) {
  PhantomSettings settings{.seed = seed};
  settings.spacing_mm = Vec3::Constant(1.5);  // quick to make
  Monitor silent;
  return make_phantom(settings, silent).ct;
}

void shift(CtVolume& ct, int first, int last, int hu) {
  const std::size_t pixels = static_cast<std::size_t>(ct.grid.size[0]) * static_cast<std::size_t>(ct.grid.size[1]);
  for (std::size_t v = static_cast<std::size_t>(first) * pixels; v < static_cast<std::size_t>(last) * pixels; ++v) {
    ct.voxels[v] = static_cast<std::int16_t>(ct.voxels[v] + hu);
  }
}

TEST(CheckScan, SoundScansAreOk) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const CtVolume ct = virtual_scan(seed);
    const Verdict verdict = check_scan(ct);
    EXPECT_EQ(verdict.status(), VerdictStatus::Ok) << seed << ": " << (verdict.reasons().empty() ? "" : verdict.reasons().front().message);
    EXPECT_LT(std::abs(oddest_slice(ct).step_hu), 0.5 * kSliceStepTolerance) << seed;
  }
}

TEST(CheckScan, AnOffsetOfAllValuesIsACaution) {
  for (const int offset : {-200, -100, 100, 200}) {
    CtVolume ct = virtual_scan(1);
    shift(ct, 0, ct.grid.size[2], offset);
    const Verdict verdict = check_scan(ct);
    ASSERT_TRUE(verdict.has("scan")) << offset;
    EXPECT_THAT(verdict.reasons().front().message, HasSubstr("the air in the scan")) << offset;
  }
}

TEST(CheckScan, OneSliceWithAnInterceptOfItsOwnIsACautionThatNamesIt) {
  for (const int slice : {1, 9, 17}) {
    for (const int offset : {-200, 100, 1000}) {
      CtVolume ct = virtual_scan(2);
      shift(ct, slice, slice + 1, offset);
      const Verdict verdict = check_scan(ct);
      ASSERT_TRUE(verdict.has("scan")) << slice << " " << offset;
      EXPECT_EQ(verdict.reasons().back().at->text, "slice " + std::to_string(slice)) << offset;
      EXPECT_NEAR(*verdict.reasons().back().value, offset, 15.0);
    }
  }
}

}  // namespace
}  // namespace incise
