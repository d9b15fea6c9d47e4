#include "support/contour_shapes.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/storage/calibration_file.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace incise {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;
using ::testing::ThrowsMessage;

constexpr RunSetting kSetting{.speed_mm_s = 9.0, .dullness = 13.0, .stiffness_of_case = 0.3};

CalibrationRun closed_run() {
  CalibrationRun run;
  run.setting = kSetting;
  run.outcome = Outcome::Success;
  run.closed_loop = true;
  run.paper_success = true;
  run.signed_error_mm = Summary{-1.0 / 3.0, 0.2, -1.0, 0.1};
  run.paper_abs_error_mm = Summary{1.55, 1.1, 0.0, 3.3};
  run.inner_signed_error_mm = Summary{-1.2, 0.5, -3.0, 0.0};
  run.inner_abs_error_mm = Summary{1.2, 0.5, 0.0, 3.0};
  run.inner_edge = testing::circle(13.1, 50);
  run.final_tumor_edge = testing::circle(9.7, 40);
  run.ring = ClosedRing{1.25, 0.5 / 3.0, testing::circle(13.6, 30)};
  run.tets = 12345;
  return run;
}

CalibrationRun failed_run() {
  CalibrationRun run{.setting = kSetting, .outcome = Outcome::OpenLoop};
  return run;
}

/// 0.75 mean + 0.25 max: 1.95 mm
const std::vector<PhotographedErrors> kPhotographs{{1.8, 2.4}, {1.8, 2.4}};

Calibration two_specimens() {
  Calibration calibration{.method = CalibrationMethod::Paper};
  CalibratedSpecimen first{.name = "s1", .runs = {closed_run(), closed_run()}};
  CalibratedSpecimen second = first;
  second.name = "s2";
  second.runs[1] = failed_run();
  calibration.specimens = {first, second};
  calibration.table = score_table({first.runs, second.runs}, kPhotographs);
  calibration.chosen = kSetting;
  calibration.score_percent = calibration.table.rows[0].percent;
  return calibration;
}

Calibration fitted() {
  Calibration calibration = two_specimens();
  calibration.method = CalibrationMethod::Fit;
  DragFit fit;
  fit.drag_length_mm = {2.0, 0.2, 1.7, 2.3, 0.9, {1.0, 2.0, 3.0}, {0.1, 0.8, 0.1}};
  fit.ln_stiffness = {0.1, 0.4, -0.6, 0.7, 0.5, {-1.0, 0.0, 1.0}, {0.2, 0.6, 0.2}};
  fit.bias_mm = {-0.1, 0.1, -0.3, 0.1, 0.5, {-0.5, 0.0, 0.5}, {0.2, 1.6, 0.2}};
  fit.samples = {{0.25, 1.8, 0.9, -0.2}, {0.75, 2.1, 1.1, 0.0}};
  fit.residual = {.sd_mm = 0.4,
                  .correlation_deg = 30.0,
                  .reading_mm = 0.1,
                  .specimen_spread_mm = 0.2,
                  .placement_mm = 0.3,
                  .n_effective = 6.0};
  calibration.fit = fit;
  calibration.identifiability = identifiability(fit);
  return calibration;
}

/// With rings and profiles, as a planner needs them.
Calibration with_rings(std::size_t sectors) {
  Calibration calibration = fitted();
  for (CalibratedSpecimen& specimen : calibration.specimens)
    specimen.ring = RingCovariates{
        .radius_mm = 9.0, .youngs_modulus_kpa = 12.0, .lateral_margin_mm = 5.0, .depth_mm = 5.0, .speed_mm_s = 7.0};
  calibration.fit->specimens = {
      {.name = "s1", .observed_mm = std::vector(sectors, -1.0), .fitted_mm = std::vector(sectors, -0.9)},
      {.name = "s2", .observed_mm = std::vector(sectors, -0.5), .fitted_mm = std::vector(sectors, -0.7)}};
  return calibration;
}

class CalibrationFileTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "calibration.json"; }
  void expect_refused(const nlohmann::ordered_json& json, const char* place) {
    write_json(path(), json);
    EXPECT_THAT([&] { static_cast<void>(read_calibration(path())); },
                ThrowsMessage<DataError>(::testing::AllOf(HasSubstr("calibration.json"), HasSubstr(place))));
  }
  TemporaryFolder folder_;
};

TEST_F(CalibrationFileTest, GivesAPlannerThePosteriorAgain) {
  write_json(path(), to_json(fitted()));
  const Calibration found = read_calibration(path());
  EXPECT_EQ(found.method, CalibrationMethod::Fit);
  ASSERT_EQ(found.specimens.size(), 2U);
  EXPECT_EQ(found.specimens[1].name, "s2");
  EXPECT_FALSE(found.specimens[0].stretch_force_n);
  EXPECT_FALSE(found.specimens[0].registration);
  ASSERT_EQ(found.fit->samples.size(), 2U);
  EXPECT_EQ(found.fit->samples[1].drag_length_mm, 2.1);
  EXPECT_EQ(found.fit->samples[0].bias_mm, -0.2);
  EXPECT_EQ(found.fit->residual.placement_mm, 0.3);
  EXPECT_EQ(found.chosen, kSetting);
}

TEST_F(CalibrationFileTest, KeepsWhatWasMeasuredOfItsSpecimens) {
  Calibration calibration = with_rings(36);
  calibration.specimens[0].youngs_modulus_kpa = 12.5;
  calibration.specimens[0].stretch_force_n = 4.2;
  calibration.specimens[0].registration = RegistrationQuality{0.31, 1.02};
  calibration.specimens[0].signed_mean_mm = -1.61;
  calibration.specimens[1].signed_mean_mm = -0.53;  // of a corrected cut …
  calibration.specimens[1].moved_mean_mm = 1.3;     // … whose path lay farther out by so much
  write_json(path(), to_json(calibration));
  Calibration found = read_calibration(path());
  EXPECT_EQ(found.specimens[0].youngs_modulus_kpa, 12.5);
  EXPECT_EQ(found.specimens[0].stretch_force_n, 4.2);
  ASSERT_TRUE(found.specimens[0].registration);
  EXPECT_EQ(found.specimens[0].registration->rmse_mm, 0.31);
  EXPECT_EQ(found.specimens[0].registration->scale, 1.02);
  EXPECT_EQ(range_of(found).signed_error_mm, (std::vector<double>{-1.61, -1.83}));
  EXPECT_FALSE(belief_of(found, path()).knows_forces) << "the second specimen's pull is not known";
  found.specimens[1].stretch_force_n = 3.9;
  EXPECT_TRUE(belief_of(found, path()).knows_forces);
  EXPECT_EQ(belief_of(found, path()).speed_mm_s, kSetting.speed_mm_s);

  // Files of earlier versions, without the keys.
  nlohmann::ordered_json older = to_json(calibration);
  older["specimens"][0].erase("registration");
  for (auto& specimen : older["specimens"]) specimen.erase("photographed_mean_signed_mm");
  write_json(path(), older);
  EXPECT_FALSE(read_calibration(path()).specimens[0].registration);
  EXPECT_TRUE(range_of(read_calibration(path())).signed_error_mm.empty());
}

TEST_F(CalibrationFileTest, GivesAPlannerThePhotographsOfItsRings) {
  const Calibration calibration = with_rings(36);
  write_json(path(), to_json(calibration));
  const CalibratedBelief belief = belief_of(read_calibration(path()), path());
  ASSERT_EQ(belief.rings.size(), 2U);
  EXPECT_EQ(belief.rings[1].photographed_mm, std::vector(36, -0.5));
  EXPECT_EQ(belief.rings[1].simulated_mm, std::vector(36, -0.7));
  EXPECT_EQ(belief.rings[0].ring.youngs_modulus_kpa, 12.0);
  const auto expect_no_belief = [&](const Calibration& found, const char* words) {
    EXPECT_THAT([&] { static_cast<void>(belief_of(found, path())); },
                ThrowsMessage<DataError>(::testing::AllOf(HasSubstr("calibration.json"), HasSubstr(words))));
  };
  expect_no_belief(fitted(), "Calibrate again");
  expect_no_belief(with_rings(8), "9 to 360");
  expect_no_belief(with_rings(361), "9 to 360");
  Calibration other = calibration;
  other.fit->specimens[1].observed_mm.resize(18);
  expect_no_belief(other, "18 numbers");
  other = calibration;
  other.fit->specimens[1].fitted_mm[3] = 11.0;
  expect_no_belief(other, "at most 10 mm");

  nlohmann::ordered_json bad = to_json(calibration);
  bad["fitted"][1]["name"] = "s9";
  expect_refused(bad, "/fitted/1/name");
  bad = to_json(calibration);
  bad["fitted"][0]["fitted_mm"] = {-0.9};
  expect_refused(bad, "/fitted/0/fitted_mm");
  bad = to_json(calibration);
  bad["fitted"][0]["observed_mm"] = std::vector(36, 1e308);
  expect_refused(bad, "/fitted/0/observed_mm");
  bad = to_json(calibration);
  bad["fitted"].erase(1);
  expect_refused(bad, "fitted");
}

TEST_F(CalibrationFileTest, AGridOfScoresIsNoBeliefAboutTheNextSpecimen) {
  write_json(path(), to_json(two_specimens()));
  EXPECT_THAT([&] { static_cast<void>(belief_of(read_calibration(path()), path())); },
              ThrowsMessage<DataError>(::testing::AllOf(HasSubstr("calibration.json"), HasSubstr("method"))));
}

TEST_F(CalibrationFileTest, RefusesWhatIsNoCalibrationByFileAndKey) {
  const nlohmann::ordered_json good = to_json(fitted());
  nlohmann::ordered_json bad = good;
  bad["schema"] = "incise.calibration/9";
  expect_refused(bad, "schema");
  bad = good;
  bad["posterior"]["samples"][0]["weight"] = 0.5;
  expect_refused(bad, "add up to 1");
  bad = good;
  bad["posterior"]["samples"][1]["drag_length_mm"] = -1.0;
  expect_refused(bad, "/posterior/samples/1/drag_length_mm");
  bad = good;
  bad["residual"].erase("sd_mm");
  expect_refused(bad, "/residual/sd_mm");
  bad = good;
  bad["method"] = "guess";
  expect_refused(bad, "method");
}

TEST_F(CalibrationFileTest, RefusesFiguresThatNoTissueToolOrPhotographHas) {
  Calibration calibration = fitted();
  for (CalibratedSpecimen& specimen : calibration.specimens) {
    specimen.youngs_modulus_kpa = 12.5;
    specimen.stretch_force_n = 4.2;
    specimen.registration = RegistrationQuality{0.31, 1.02};
  }
  const nlohmann::ordered_json good = to_json(calibration);
  const auto expect_bounded = [&](const char* pointer, const char* place, double value) {
    nlohmann::ordered_json bad = good;
    bad[nlohmann::ordered_json::json_pointer(pointer)] = value;
    expect_refused(bad, place);
  };
  std::vector<std::pair<std::string, std::string>> bounded{
      {"/posterior/samples/0/drag_length_mm", "/posterior/samples/0/drag_length_mm: found"},
      {"/posterior/samples/1/stiffness_factor", "/posterior/samples/1/stiffness_factor: found"},
      {"/posterior/samples/1/bias_mm", "/posterior/samples/1/bias_mm: found"},
      {"/specimens/0/youngs_modulus_kpa", "/specimens/0/youngs_modulus_kpa: found"},
      {"/specimens/0/stretch_force_n", "/specimens/0/stretch_force_n: found"},
      {"/specimens/0/simulated_force_n", "/specimens/0/simulated_force_n: found"},
      {"/specimens/1/stretch_mm", "/specimens/1/stretch_mm: found"},
      {"/specimens/1/photographed_mean_signed_mm", "/specimens/1/photographed_mean_signed_mm: found"},
      {"/specimens/1/registration/rmse_mm", "/specimens/1/registration/rmse_mm: found"},
      {"/specimens/1/registration/scale", "/specimens/1/registration/scale: found"},
      {"/chosen/speed_mm_s", "/chosen/speed_mm_s: found"},
      {"/chosen/dullness", "/chosen/dullness: found"},
      {"/reference_step_s", "reference_step_s: found"}};
  for (const char* key :
       {"sd_mm", "correlation_deg", "reading_mm", "specimen_spread_mm", "placement_mm", "n_effective"})
    bounded.emplace_back(fmt::format("/residual/{}", key), fmt::format("/residual/{}: found", key));
  for (const auto& [pointer, place] : bounded) {
    for (const double value : {1e300, -1e9}) expect_bounded(pointer.c_str(), place.c_str(), value);
  }
}

TEST_F(CalibrationFileTest, AFailedCellIsARowOfTheTable) {
  const TextTable table = calibration_table(two_specimens());
  ASSERT_EQ(table.rows.size(), 2U);
  const auto cell = [&](std::size_t row, const std::string& column) {
    const auto at = std::find(table.header.begin(), table.header.end(), column) - table.header.begin();
    return table.rows[row].at(static_cast<std::size_t>(at));
  };
  EXPECT_EQ(cell(0, "failure"), "no");
  EXPECT_EQ(cell(0, "mean_mm"), "1.550000");
  EXPECT_EQ(cell(0, "score_percent"), "101.9231");  // (0.75 * 1.55 + 0.25 * 3.3) / 1.95
  EXPECT_EQ(cell(1, "failure"), "yes");
  EXPECT_EQ(cell(1, "s2_outcome"), "open_loop");
  EXPECT_EQ(cell(1, "s2_mean_mm"), "");
  EXPECT_EQ(cell(1, "score_percent"), "0.0000");
  EXPECT_EQ(cell(0, "inner_edge_specimens"), "2");
  EXPECT_EQ(cell(1, "inner_edge_specimens"), "1");
  EXPECT_EQ(cell(1, "inner_edge_score_percent"),
            cell(0, "inner_edge_score_percent"));  // the same two runs, the same photographs
  EXPECT_EQ(calibration_table_rounded(two_specimens()).rows[1][3], "Failure");
  EXPECT_THAT(csv_text(table), HasSubstr("speed_mm_s,dullness,drag_length_mm"));
}

class PhotographedCutTest : public CalibrationFileTest {
 protected:
  static nlohmann::ordered_json evaluation_json(const Contour& incision) {
    EvaluationSettings settings{.contour = ContourKind::InnerEdge};
    const Evaluation evaluation = evaluate(incision, testing::circle(10.0, 120), settings);
    nlohmann::ordered_json json = to_json(evaluation);
    json["points"] = points_json(evaluation);
    json["tumor_edge"] = contour_json(testing::circle(10.0, 120));
    json["approach"] = {0.0, 0.0, -1.0};
    return json;
  }
  void expect_cut_refused(const nlohmann::ordered_json& json, const char* place, const char* says) {
    write_json(path(), json);
    EXPECT_THAT([&] { static_cast<void>(read_photographed_cut(path())); },
                ThrowsMessage<DataError>(::testing::AllOf(HasSubstr(place), HasSubstr(says))));
  }
};

TEST_F(PhotographedCutTest, HoldsBothContoursAndTheCamerasDirection) {
  write_json(path(), evaluation_json(testing::circle(14.0, 360)));
  const PhotographedCut cut = read_photographed_cut(path());
  EXPECT_EQ(cut.tumor_edge.points, testing::circle(10.0, 120).points);
  EXPECT_NEAR(cut.incision.points[7].norm(), 14.0, 0.01);
  EXPECT_EQ(cut.approach, Vec3(0.0, 0.0, -1.0));
}

TEST_F(PhotographedCutTest, IsRefusedOpenOrAsAMidLineOrWithoutTheEdge) {
  Contour open = testing::circle(14.0, 360);
  open.is_closed = false;
  expect_cut_refused(evaluation_json(open), "closed_loop", "all round");
  nlohmann::ordered_json json = evaluation_json(testing::circle(14.0, 360));
  json["contour"] = "centerline";
  expect_cut_refused(json, "contour", "inner_edge");
  json = evaluation_json(testing::circle(14.0, 360));
  json.erase("tumor_edge");
  expect_cut_refused(json, "tumor_edge", "incise evaluate");
  json = evaluation_json(testing::circle(14.0, 360));
  json["tumor_edge"]["y_mm"].erase(3);
  expect_cut_refused(json, "/tumor_edge/y_mm", "119 numbers");
}

TEST_F(PhotographedCutTest, IsRefusedWhereNoPhotographCouldShowIt) {
  const nlohmann::ordered_json good = evaluation_json(testing::circle(14.0, 360));
  for (const double far : {1e300, -1e9}) {
    for (const char* axis : {"x_mm", "y_mm", "z_mm"}) {
      nlohmann::ordered_json json = good;
      json["points"][axis][5] = far;
      expect_cut_refused(json, fmt::format("/points/{}/5", axis).c_str(), "a number in [-100000, 100000]");
      json = good;
      json["tumor_edge"][axis][7] = far;
      expect_cut_refused(json, fmt::format("/tumor_edge/{}/7", axis).c_str(), "a number in [-100000, 100000]");
    }
  }
  nlohmann::ordered_json json = good;
  json["points"]["x_mm"][5] = 1500.0;
  expect_cut_refused(json, "points: found an incision", "2 to 200 mm");
  json = good;
  json["tumor_edge"]["y_mm"][5] = -150.0;
  expect_cut_refused(json, "tumor_edge: found a tumour", "2 to 100 mm");
  json = good;
  for (auto& x : json["tumor_edge"]["x_mm"]) x = x.get<double>() + 300.0;
  expect_cut_refused(json, "tumor_edge: found an incision with its tumour", "2 to 200 mm");
  for (const double part : {1e300, 1e-300, 0.0}) {
    json = good;
    json["approach"] = {part, 0.0, 0.0};
    expect_cut_refused(json, "approach", "a direction");
  }
  json["approach"] = {0.0, 0.0, -2.0};
  write_json(path(), json);
  EXPECT_EQ(read_photographed_cut(path()).approach, Vec3(0.0, 0.0, -1.0));
}

}  // namespace
}  // namespace incise
