// Files that were made, or happened, to do harm: each is refused with its name, and before much memory is taken.

#include "io/io_test_support.hpp"

#include <incise/io/contour_io.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/surface_io.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <zlib.h>

#include <fstream>

namespace incise {
namespace {

using incise::testing::refusal_of;
using incise::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;

void write(const std::filesystem::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

/// What reading a PLY file with this header and these bytes says.
std::string ply_says(const std::string& header, const std::string& body) {
  const TemporaryFolder folder;
  write(folder / "a.ply", "ply\nformat binary_little_endian 1.0\n" + header + "end_header\n" + body);
  return refusal_of<DataError>([&] { return read_cloud(folder / "a.ply"); });
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

TEST(HostilePly, NormalsBesideNxOverflowNoArray) {
  EXPECT_THAT(ply_says("element vertex 4\n" + kXyz + "property float normals\nproperty float nz\n", std::string(80, '\0')), HasSubstr("'normals'"));
  EXPECT_THAT(ply_says("element vertex 4\n" + kXyz + "property float nz\nproperty float normals\n", std::string(80, '\0')), HasSubstr("'normals'"));
}

TEST(HostilePly, ASecondElementVertexOrPropertyIsRefused) {
  EXPECT_THAT(ply_says("element vertex 2\n" + kXyz + "element vertex 9\n" + kXyz + "property float q\n", std::string(200, '\0')),
              HasSubstr("a second element vertex"));
  EXPECT_THAT(ply_says("element vertex 2\n" + kXyz + "property float x\n", std::string(200, '\0')), AllOf(HasSubstr("'x'"), HasSubstr("twice")));
}

TEST(HostilePly, NoMoreIsMadeRoomForThanTheFileHolds) {
  std::string properties = kXyz;
  for (int k = 0; k < 200; ++k) properties += fmt::format("property double p{}\n", k);
  // 100 000 vertices of 1612 bytes would take 160 MB; the file has 0.1 MB for them.
  EXPECT_THAT(ply_says("element vertex 100000\n" + properties, std::string(100000, '\0')), HasSubstr("100000 items of 'vertex'"));
  EXPECT_THAT(ply_says("element vertex 1\n" + kXyz + "element face 50\nproperty list uchar int vertex_indices\n", std::string(40, '\0')),
              HasSubstr("50 items of 'face'"));
}

TEST(HostilePly, AFaceOfNoCornersIsRefusedWhereItStands) {
  EXPECT_THAT(ply_says("element vertex 1\n" + kXyz + "element face 50\nproperty list uchar int vertex_indices\n", std::string(62, '\0')),
              AllOf(HasSubstr("face 0"), HasSubstr("0 corners")));
}

TEST(HostileJson, DeepNestingIsRefusedBeforeAnybodyWalksThroughIt) {
  for (const char* bracket : {"[", "{\"a\":"}) {
    std::string text;
    for (int level = 0; level < 73000; ++level) text += bracket;
    EXPECT_THAT(refusal_of<DataError>([&] { return parse_json(text, "deep.json"); }),
                AllOf(HasSubstr("deep.json"), HasSubstr("nested more than 64 deep")));
  }
  std::string sound = "1";
  for (int level = 0; level < 60; ++level) sound = "[" + sound + "]";
  EXPECT_NO_THROW(static_cast<void>(parse_json(sound, "x")));
}

TEST(HostileVtk, DataThatUnpackToFarMoreThanTheFileAreRefused) {
  // 300 MB of zeros shrink to 0.3 MB.
  const std::string zeros(1 << 20, '\0');
  uLongf size = compressBound(zeros.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(zeros.data()), zeros.size());
  packed.resize(size);
  constexpr std::uint32_t kBlocks = 300;
  std::string data;
  const auto put = [&data](std::uint32_t number) { data.append(reinterpret_cast<const char*>(&number), 4); };
  put(kBlocks);
  put(1 << 20);
  put(0);
  for (std::uint32_t i = 0; i < kBlocks; ++i) put(static_cast<std::uint32_t>(packed.size()));
  for (std::uint32_t i = 0; i < kBlocks; ++i) data += packed;
  const TemporaryFolder folder;
  write(folder / "bomb.vtp",
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece "
        "NumberOfPoints=\"1\"><Points><DataArray type=\"UInt8\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece>"
        "</PolyData><AppendedData encoding=\"raw\">_" + data + "</AppendedData></VTKFile>");
  EXPECT_THAT(refusal_of<DataError>([&] { return read_cloud(folder / "bomb.vtp"); }), HasSubstr("unpack to more than"));
}

TEST(HostileVtk, ALegacyArrayThatClaimsMoreThanItsFileIsRefused) {
  const TemporaryFolder folder;
  write(folder / "a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 0 float\nFIELD f 1\nq 90 90 double\n1 2 3 " + std::string(200, ' '));
  EXPECT_THAT(refusal_of<DataError>([&] { return read_tet_mesh(folder / "a.vtk"); }), HasSubstr("a.vtk"));
}

TEST(InputFiles, APipeADeviceAndAFolderAreRefusedByEveryReader) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe.ply").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo((folder / "pipe.json").c_str(), 0600), 0);
  EXPECT_THAT(refusal_of<DataError>([&] { return read_cloud(folder / "pipe.ply"); }),
              AllOf(HasSubstr("pipe.ply"), HasSubstr("found a pipe")));
  EXPECT_THAT(refusal_of<DataError>([&] { return read_json(folder / "pipe.json"); }), HasSubstr("found a pipe"));
  EXPECT_THAT(refusal_of<DataError>([&] { return sha256_of_file(folder / "pipe.json"); }), HasSubstr("found a pipe"));
  EXPECT_THAT(refusal_of<DataError>([&] { return read_json("/dev/zero"); }), HasSubstr("found a device"));
  EXPECT_THAT(refusal_of<DataError>([&] { return read_json(folder.path()); }), HasSubstr("found a folder"));
  std::filesystem::create_symlink("/dev/zero", folder / "link.json");
  EXPECT_THAT(refusal_of<DataError>([&] { return read_json(folder / "link.json"); }), HasSubstr("found a device"));
}

TEST(InputFiles, AFileAboveTheLimitIsRefusedByItsSize) {
  const TemporaryFolder folder;
  write(folder / "a", "12345");
  EXPECT_NO_THROW(require_regular_file(folder / "a", 5));
  EXPECT_THAT(refusal_of<DataError>([&] { require_regular_file(folder / "a", 4); }),
              HasSubstr("found 5 bytes, expected at most 4"));
}

/// The names of the files that reading one opens.
std::vector<std::string> names(const std::filesystem::path& file) {
  std::vector<std::string> found;
  for (const auto& path : input_files(file)) found.push_back(path.filename().string());
  return found;
}

TEST(InputFiles, AreTheFileAndAllThatItsHeaderNames) {
  const TemporaryFolder folder;
  using ::testing::ElementsAre;
  write(folder / "a.mhd", "NDims = 3\nElementDataFile = ct.raw\n");
  EXPECT_THAT(names(folder / "a.mhd"), ElementsAre("a.mhd", "ct.raw"));
  write(folder / "b.mha", "NDims = 3\nElementDataFile = LOCAL\nxxxx");
  EXPECT_THAT(names(folder / "b.mha"), ElementsAre("b.mha"));
  write(folder / "c.mhd", "ElementDataFile = LIST\none.raw\ntwo.raw\n");
  EXPECT_THAT(names(folder / "c.mhd"), ElementsAre("c.mhd", "one.raw", "two.raw"));
  write(folder / "d.nhdr", "NRRD0004\ndata file: voxels.raw.gz\n\n");
  EXPECT_THAT(names(folder / "d.nhdr"), ElementsAre("d.nhdr", "voxels.raw.gz"));
  write(folder / "e.nhdr", "NRRD0004\ndatafile: s%02d.raw 3 7 2\n\n");
  EXPECT_THAT(names(folder / "e.nhdr"), ElementsAre("e.nhdr", "s03.raw", "s05.raw", "s07.raw"));
  write(folder / "f.nhdr", "NRRD0004\r\nData File: LIST 2\r\na.raw\r\nb.raw\r\n");
  EXPECT_THAT(names(folder / "f.nhdr"), ElementsAre("f.nhdr", "a.raw", "b.raw"));
  write(folder / "g.node", "");
  EXPECT_THAT(names(folder / "g.node"), ElementsAre("g.node", "g.ele"));
}

TEST(InputFiles, TheHashChangesWithEveryByteOfEveryOneOfThem) {
  const TemporaryFolder folder;
  write(folder / "a.mhd", "NDims = 3\nElementDataFile = ct.raw\n");
  const std::string without = sha256_of_input(folder / "a.mhd");
  write(folder / "ct.raw", "voxels");
  const std::string with = sha256_of_input(folder / "a.mhd");
  write(folder / "ct.raw", "voxelt");
  EXPECT_NE(without, with);
  EXPECT_NE(with, sha256_of_input(folder / "a.mhd"));
  write(folder / "m.csv", "1");
  EXPECT_EQ(sha256_of_input(folder / "m.csv"), sha256_of_file(folder / "m.csv"));
}

}  // namespace
}  // namespace incise
