#include "io/io_test_support.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/io/pvd_io.hpp>

namespace incise {
namespace {

using incise::testing::refusal_of;
using incise::testing::TemporaryFolder;
using incise::testing::write_file;
using ::testing::HasSubstr;

TEST(Pvd, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  write_pvd(folder / "frames.pvd", {{0.0, "frames/0000.vtu"}, {0.1, "frames/a & b.vtu"}});
  const auto frames = read_pvd(folder / "frames.pvd");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].time_s, 0.1);
  EXPECT_EQ(frames[1].file, "frames/a & b.vtu");
}

TEST(Pvd, RefusesTimesThatDoNotIncreaseAndAbsoluteNames) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_pvd(folder / "a.pvd", {{1.0, "a.vtu"}, {1.0, "b.vtu"}}), InvalidArgument);
  EXPECT_THROW(write_pvd(folder / "a.pvd", {{1.0, "/a.vtu"}}), InvalidArgument);
  EXPECT_THROW(write_pvd(folder / "a.pvd", {}), InvalidArgument);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pvd"));
}

TEST(Pvd, NamesWhatIsWrongInAFile) {
  const TemporaryFolder folder;
  const auto message = [&](const char* text) {
    return refusal_of<DataError>([&] { return read_pvd(write_file(folder / "a.pvd", text)); });
  };
  EXPECT_THAT(message("<VTKFile><Collection></Collection></VTKFile>"), HasSubstr("no DataSet"));
  EXPECT_THAT(message("<VTKFile><Collection><DataSet timestep=\"nan\" file=\"a\"/></Collection></VTKFile>"),
              HasSubstr("timestep 'nan'"));
  EXPECT_THAT(message("<VTKFile><Coll"), HasSubstr("expected a ParaView collection"));
}

}  // namespace
}  // namespace incise
