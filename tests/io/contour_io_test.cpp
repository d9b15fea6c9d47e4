#include "io/io_test_support.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/surface_io.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace incise {
namespace {

using incise::testing::refusal_of;
using incise::testing::TemporaryFolder;
using incise::testing::write_file;
using ::testing::AllOf;
using ::testing::HasSubstr;

const Contour kTriangle{{Vec3(0.1, 1.0 / 3.0, -2e-9), Vec3(10, 0, 0), Vec3(0, 10, 0.7)}, true};

class ContourFile : public ::testing::Test {
 protected:
  Contour read(const std::string& name, std::string_view text, bool is_closed = true) {
    return read_contour(write_file(folder_ / name, text), is_closed);
  }
  std::string message(const std::string& name, std::string_view text, bool is_closed = true) {
    return refusal_of<DataError>([&] { return read(name, text, is_closed); });
  }
  TemporaryFolder folder_;
};

TEST_F(ContourFile, CsvReadsBackTheSameDoubles) {
  write_contour_csv(folder_ / "a.csv", kTriangle, {{"signed_error_mm", {0.5, -0.25, 0.1}}});
  EXPECT_EQ(read_contour(folder_ / "a.csv").points, kTriangle.points);
  EXPECT_EQ(read_text(folder_ / "a.csv").substr(0, 31), "x_mm,y_mm,z_mm,signed_error_mm\n");
}

TEST_F(ContourFile, CsvTakesByteOrderMarkCrlfBlankLinesAndFurtherColumns) {
  const Contour contour =
      read("a.csv", "\xEF\xBB\xBFn, z_mm ,x_mm,y_mm\r\n\r\n1,3,1,2\r\n2, 6 ,4,+5\r\n\r\n3,9,7,8\r\n");
  EXPECT_EQ(contour.points, (Points{Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9)}));
}

TEST_F(ContourFile, CsvNamesLineAndColumnOfABadNumber) {
  EXPECT_THAT(message("a.csv", "x_mm,y_mm,z_mm\n1,2,3\n4,five,6\n"),
              HasSubstr("a.csv: line 3, column y_mm: found 'five', expected a finite number"));
  EXPECT_THAT(message("a.csv", "x_mm,y_mm,z_mm\n\n1,2,nan\n"), HasSubstr("line 3, column z_mm: found 'nan'"));
  EXPECT_THAT(message("a.csv", "x_mm,y_mm,z_mm\n1,2,3,4\n"), HasSubstr("line 2: found 4 fields, expected 3"));
  EXPECT_THAT(message("a.csv", "x_mm,y_mm,z_mm\n1,2,\n"), HasSubstr("found ''"));
}

TEST_F(ContourFile, CsvAsksForItsHeader) {
  EXPECT_THAT(message("a.csv", "x,y,z\n1,2,3\n"),
              HasSubstr("found the header 'x,y,z', expected a header with the column x_mm"));
  EXPECT_THAT(message("a.csv", "\n\n"), HasSubstr("an empty file"));
}

TEST_F(ContourFile, AnArcIsNotTakenForAClosedCurve) {
  const auto arc = [](double to_deg, bool repeats_first) {
    std::string text = "x_mm,y_mm,z_mm\n";
    for (double angle = 0.0; angle < to_deg; angle += 2.0)
      text += std::to_string(15.0 * std::cos(angle * M_PI / 180.0)) + "," +
              std::to_string(15.0 * std::sin(angle * M_PI / 180.0)) + ",0\n";
    return repeats_first ? text + "15.000000,0.000000,0\n" : text;
  };
  EXPECT_EQ(read("whole.csv", arc(360.0, false)).points.size(), 180U);
  EXPECT_THAT(message("arc.csv", arc(300.0, false)),
              AllOf(HasSubstr("arc.csv"), HasSubstr("ends 15.5 mm apart"), HasSubstr("expected a closed curve")));
  EXPECT_EQ(read("open.csv", arc(300.0, false), false).points.size(), 150U);
  EXPECT_EQ(read("chord.csv", arc(300.0, true)).points.size(), 150U)
      << "its first point stands at its end: that says closed";
}

TEST_F(ContourFile, NeedsThreePointsToCloseAndTwoToStayOpen) {
  const char* two = "x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n";
  EXPECT_THAT(message("a.csv", two), HasSubstr("found 2 points, expected at least 3 for a closed contour"));
  EXPECT_FALSE(read("a.csv", two, false).is_closed);
  EXPECT_THAT(message("a.csv", "x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n0,0,0\n"), HasSubstr("found 2 points"));
}

TEST_F(ContourFile, DropsALastPointThatRepeatsTheFirst) {
  EXPECT_EQ(read("a.csv", "x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n0,1,0\n0,0,0\n").points.size(), 3u);
}

TEST_F(ContourFile, IsNotWrittenWithNumbersThatAreNotFinite) {
  Contour bad = kTriangle;
  bad.points[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_contour_csv(folder_ / "a.csv", bad), InvalidArgument);
  EXPECT_THROW(write_contour_vtp(folder_ / "a.vtp", bad), InvalidArgument);
  EXPECT_THROW(write_contour_csv(folder_ / "a.csv", kTriangle, {{"e_mm", {1.0}}}), InvalidArgument);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(ContourFile, VtpReadsBackTheSameDoublesAndKnowsWhetherItIsClosed) {
  write_contour_vtp(folder_ / "a.vtp", kTriangle, {{"signed_error_mm", {1, {1.0, 2.0, 3.0}}}});
  EXPECT_EQ(read_contour(folder_ / "a.vtp").points, kTriangle.points);
  EXPECT_THAT(refusal_of<DataError>([&] { return read_contour(folder_ / "a.vtp", false); }),
              HasSubstr("found a closed curve, expected an open curve"));
  write_contour_vtp(folder_ / "b.vtp", {kTriangle.points, false});
  EXPECT_FALSE(read_contour(folder_ / "b.vtp", false).is_closed);
}

TEST_F(ContourFile, VtpThatRepeatsItsFirstIndexMayHaveALongLastSide) {
  const Contour chord{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0.5, 0), Vec3(3, 0.5, 0), Vec3(4, 0, 0), Vec3(5, 0, 0)},
                      true};  // neighbours are at most 1.12 mm apart, the ends 5 mm
  write_contour_vtp(folder_ / "closed.vtp", chord);
  EXPECT_EQ(read_contour(folder_ / "closed.vtp").points, chord.points);
  write_contour_vtp(folder_ / "open.vtp", {chord.points, false});
  EXPECT_THAT(refusal_of<DataError>([&] { return read_contour(folder_ / "open.vtp"); }), HasSubstr("ends 5 mm apart"));
}

TEST_F(ContourFile, VtpHasToHoldOnePolyline) {
  const std::vector<Contour> two{kTriangle, kTriangle};
  write_vtp(folder_ / "a.vtp", two);
  EXPECT_THAT(refusal_of<DataError>([&] { return read_contour(folder_ / "a.vtp"); }),
              HasSubstr("found 2 polylines, expected one"));
}

std::string markup(const std::string& type, const std::string& system, const std::string& more = "") {
  return R"({"@schema": "x", "markups": [{"type": ")" + type + R"(", "coordinateSystem": )" + system + more +
         R"(, "controlPoints": [{"id": "1", "position": [1, 2, 3], "positionStatus": "defined"}, {"position": [4, 5, 6]}, {"position": [7, 8, 9]}]}]})";
}

TEST_F(ContourFile, SlicerCurvesComeInLps) {
  EXPECT_EQ(read("a.mrk.json", markup("ClosedCurve", R"("LPS")")).points[0], Vec3(1, 2, 3));
  EXPECT_EQ(read("a.mrk.json", markup("ClosedCurve", R"("RAS")")).points[0], Vec3(-1, -2, 3));
  EXPECT_EQ(read("a.mrk.json", markup("ClosedCurve", R"("0")")).points[1], Vec3(-4, -5, 6));
  EXPECT_EQ(read("a.mrk.json", markup("ClosedCurve", R"("1")")).points[1], Vec3(4, 5, 6));
  EXPECT_FALSE(
      read("a.mrk.json", markup("Curve", R"("LPS")", R"(, "coordinateUnits": ["mm", "UCUM", "millimeter"])"), false)
          .is_closed);
}

TEST_F(ContourFile, SlicerFilesAreRefusedWithThePlace) {
  EXPECT_THAT(message("a.mrk.json", markup("Curve", R"("LPS")")),
              HasSubstr("/markups/0/type: found an open curve, expected a closed curve"));
  EXPECT_THAT(message("a.mrk.json", markup("Fiducial", R"("LPS")")), HasSubstr("expected Curve or ClosedCurve"));
  EXPECT_THAT(message("a.mrk.json", markup("ClosedCurve", R"("IJK")")), HasSubstr("/markups/0/coordinateSystem"));
  EXPECT_THAT(message("a.mrk.json", markup("ClosedCurve", R"("LPS")", R"(, "coordinateUnits": "cm")")),
              HasSubstr("found cm, expected mm"));
  EXPECT_THAT(message("a.mrk.json", R"({"markups": []})"), HasSubstr("0 markups"));
  EXPECT_THAT(
      message("a.mrk.json", R"({"markups": [{"type": "ClosedCurve", "controlPoints": [{"position": [1, "b", 2]}]}]})"),
      HasSubstr("/markups/0/controlPoints/0/position/1"));
}

TEST_F(ContourFile, HasToHaveAKnownEnding) {
  EXPECT_THAT(message("a.txt", ""), HasSubstr("expected .csv, .vtp or .mrk.json"));
}

TEST_F(ContourFile, CarriesItsPointDataThroughTheLinesOfAVtp) {
  const std::vector<Contour> two{kTriangle, {kTriangle.points, false}};
  write_vtp(folder_ / "a.vtp", two, {{"error_mm", {1, {1, 2, 3, 4, 5, 6}}}});
  const TriMesh cloud = read_cloud(folder_ / "a.vtp");
  EXPECT_EQ(cloud.vertices.size(), 6u);
  EXPECT_EQ(cloud.point_data.at("error_mm").values[5], 6.0);
}

}  // namespace
}  // namespace incise
