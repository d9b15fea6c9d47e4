#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/storage/case_file.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cctype>
#include <fstream>
#include <map>
#include <string_view>

namespace incise {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// The least that a case has to say.
constexpr const char* kLeast = "schema: incise.case/1\nspecimen: {mesh: block.msh}\ntumor: {contour: tumor.csv}\n";

class CaseFileTest : public ::testing::Test {
 protected:
  CaseFile read(const std::string& text) {
    std::ofstream(folder_ / "case.yaml") << text;
    return read_case(folder_.path());
  }

  /// What read_case says against a text.
  template <class ErrorType = CaseError>
  std::string refusal(const std::string& text) {
    return testing::refusal_of<ErrorType>([&] { return read(text); });
  }

  /// As refusal, for one group added to the least case (which must not hold that group).
  std::string refusal_with(const std::string& lines) { return refusal(kLeast + lines); }

  testing::TemporaryFolder folder_;
};

std::map<std::string, std::string> settings_by_key(const CaseFile& file) {
  std::map<std::string, std::string> settings;
  for (const SettingLine& line : settings_of(file)) settings[line.key] = line.value;
  return settings;
}

TEST_F(CaseFileTest, TheLeastCaseHasTheDefaultsOfTheStructs) {
  const CaseFile file = read(kLeast);
  EXPECT_EQ(file.settings.material.youngs_modulus_kpa, 70.0);
  EXPECT_EQ(file.settings.material.poissons_ratio, 0.49);
  EXPECT_EQ(file.settings.plan.lateral_margin_mm, PlanSettings{}.lateral_margin_mm);
  EXPECT_EQ(file.settings.cut.dullness, CutSettings{}.dullness);
  EXPECT_EQ(file.settings.meshing.fine_mm, MeshingChoice{}.fine_mm);
  EXPECT_FALSE(file.settings.constraints.has_value());
  EXPECT_FALSE(file.settings.T_robot_sim.has_value());
  EXPECT_FALSE(file.settings.is_virtual);
}

TEST_F(CaseFileTest, ATextThatAnEscapeMakesOtherThanUtf8IsRefusedByLine) {
  for (const char* escape : {"\\N", "\\_", "\\L\\N"}) {
    SCOPED_TRACE(escape);
    const std::string said = refusal<DataError>(std::string(kLeast) + "title: \"a" + escape + "b\"\n");
    EXPECT_THAT(said, AllOf(HasSubstr("case.yaml: line "), HasSubstr("a text with a byte 0x")));
  }
  EXPECT_EQ(read(std::string(kLeast) + "title: \"a\\u00e4b\"\n").settings.title, "a\u00e4b");
}

TEST_F(CaseFileTest, StrokesAndLabelsAreListsOfAnyLength) {
  const CaseFile file = read(
      "schema: incise.case/1\ntumor: {contour: tumor.csv}\nspecimen: {mesh: block.msh}\nct:\n  label_values: [3, 5]\n"
      "  edits:\n    - {tissue: false, radius_mm: 2, path_mm: [[1, 2, 3], [4, 5, 6]]}\n"
      "    - {tissue: true, radius_mm: 1.5, path_mm: [[7, 8, 9]]}\n");
  const SegmentationSettings& found = file.settings.segmentation;
  EXPECT_EQ(found.label_values, (std::vector<std::int32_t>{3, 5}));
  ASSERT_TRUE(found.edits && found.edits->size() == 2);
  EXPECT_FALSE(found.edits->front().is_tissue);
  EXPECT_EQ(found.edits->front().path_mm, (Points{Vec3(1, 2, 3), Vec3(4, 5, 6)}));
  EXPECT_EQ(found.edits->back().path_mm, (Points{Vec3(7, 8, 9)}));
  auto settings = settings_by_key(file);
  EXPECT_EQ(settings["ct.label_values"], "[3, 5]");
  EXPECT_EQ(settings["ct.edits"],
            "[{tissue: false, radius_mm: 2, path_mm: [[1, 2, 3], [4, 5, 6]]}, {tissue: true, radius_mm: 1.5, path_mm: "
            "[[7, 8, 9]]}]");
  const auto schema = Json::parse(case_schema_json()).at("properties").at("ct").at("properties");
  EXPECT_EQ(schema.at("label_values").at("items").at("type"), "integer");
  EXPECT_EQ(schema.at("edits").at("items").at("properties").at("path_mm").at("items").at("maxItems"), 3);
  EXPECT_THAT(refusal_with("ct: {label_values: [1.5]}\n"), HasSubstr("ct.label_values[0]"));
  EXPECT_THAT(refusal_with("ct: {label_values: [256]}\n"), HasSubstr("ct.label_values[0]"));
  EXPECT_THAT(refusal_with("ct: {edits: [{tissue: true, radius_mm: 1, path_mm: [[1, 2]]}]}\n"), HasSubstr("path_mm"));
  EXPECT_THAT(refusal_with("ct: {edits: [{tissue: true, radius_mm: 1, path_mm: []}]}\n"), HasSubstr("path_mm"));
}

TEST_F(CaseFileTest, ASecondDocumentIsNotDropped) {
  EXPECT_THAT(refusal<DataError>(kLeast + std::string("---\nplan: {depth_mm: 4}\n")), HasSubstr("several documents"));
}

TEST_F(CaseFileTest, InputsAreRelativeToTheCaseFile) {
  const CaseFile file = read("schema: incise.case/1\nct: {volume: scans/../ct}\ntumor: {contour: /data/tumor.csv}\n");
  EXPECT_EQ(file.inputs.ct_volume, folder_ / "ct");
  EXPECT_EQ(file.inputs.tumor_contour, "/data/tumor.csv");
}

TEST_F(CaseFileTest, MissingInputFilesAreNamedWithTheFieldThatAsksForThem) {
  const CaseFile file = read(kLeast);
  std::ofstream(folder_ / "block.msh") << "present";
  EXPECT_THAT(testing::refusal_of<DataError>([&] { require_input_files(file); }),
              AllOf(HasSubstr("tumor.csv"), HasSubstr("tumor.contour"), HasSubstr("case.yaml")));
  std::ofstream(folder_ / "tumor.csv") << "present";
  EXPECT_NO_THROW(require_input_files(file));
}

TEST_F(CaseFileTest, ThePrintedDefaultsReadBackAsTheSameSettings) {
  std::string text = case_defaults_yaml();
  const auto replace = [&text](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("  # mesh:", "  mesh: block.msh");
  replace("  # contour:", "  contour: tumor.csv");
  EXPECT_EQ(settings_by_key(read(text)), settings_by_key(read(kLeast)));
}

TEST_F(CaseFileTest, SettingsJsonReadsBackAsTheSettings) {
  const CaseFile file = read(std::string(kLeast) + "plan: {depth_mm: 4.25}\n");
  const Json json = Json::parse(settings_json(file));
  EXPECT_EQ(json.at("plan.depth_mm"), "4.25");
  EXPECT_EQ(json.size(), settings_of(file).size());
}

TEST_F(CaseFileTest, JsonIsReadLikeYaml) {
  const CaseFile file =
      read(R"({"schema": "incise.case/1", "specimen": {"mesh": "block.msh"}, "tumor": {"contour": "tumor.csv"},
    "cut": {"dullness": 4}})");
  EXPECT_EQ(file.settings.cut.dullness, 4.0);
}

TEST_F(CaseFileTest, ABladeAndABallAreReadWithTheirOwnDimensions) {
  const CaseFile blade = read(std::string(kLeast) + "tool: {kind: blade, thickness_mm: 0.4, width_mm: 3, length_mm: 20}\n");
  const auto& made = std::get<Blade>(blade.settings.tool);
  EXPECT_EQ(made.thickness_mm, 0.4);
  EXPECT_EQ(made.width_mm, 3.0);
  EXPECT_EQ(made.length_mm, 20.0);
  const CaseFile ball = read(std::string(kLeast) + "tool: {kind: ball, diameter_mm: 3}\n");
  EXPECT_EQ(std::get<Ball>(ball.settings.tool).diameter_mm, 3.0);
  EXPECT_EQ(std::get<Needle>(read(kLeast).settings.tool).length_mm, Needle{}.length_mm);
}

TEST_F(CaseFileTest, ADimensionOfAnotherToolIsRefusedByName) {
  EXPECT_THAT(refusal_with("tool: {kind: ball, width_mm: 3}\n"), AllOf(HasSubstr("tool.width_mm"), HasSubstr("tool.kind: ball")));
  EXPECT_THAT(refusal_with("tool: {thickness_mm: 1}\n"), AllOf(HasSubstr("tool.thickness_mm"), HasSubstr("tool.kind: needle")));
}

TEST_F(CaseFileTest, EveryKeyOfTheLawOfCuttingIsRead) {
  const CaseFile file = read(std::string(kLeast) +
                             "cut:\n  reference_power_w: 30\n  power_exponent: 1.5\n  tear_energy_kpa: 20\n  slip_mm: 0.7\n"
                             "  toughness: [{label: 2, toughness: 3.5}]\n  toughness_from_mesh: true\n"
                             "thermal: {conductivity_w_m_k: 0.5, heat_capacity_mj_m3_k: 4, body_c: 20, damage_c: 65, absorbed_fraction: 0.25}\n");
  const Case& c = file.settings;
  EXPECT_EQ(c.cut.reference_power_w, 30.0);
  EXPECT_EQ(c.cut.power_exponent, 1.5);
  EXPECT_EQ(c.cut.tear_energy_kpa, 20.0);
  EXPECT_EQ(c.cut.slip_mm, 0.7);
  ASSERT_EQ(c.toughness.labels.size(), 1U);
  EXPECT_EQ(c.toughness.labels[0].label, 2);
  EXPECT_EQ(c.toughness.labels[0].toughness, 3.5);
  EXPECT_TRUE(c.toughness.from_mesh);
  EXPECT_EQ(c.thermal.conductivity_w_m_k, 0.5);
  EXPECT_EQ(c.thermal.heat_capacity_mj_m3_k, 4.0);
  EXPECT_EQ(c.thermal.body_c, 20.0);
  EXPECT_EQ(c.thermal.damage_c, 65.0);
  EXPECT_EQ(c.thermal.absorbed_fraction, 0.25);
  EXPECT_FALSE(read(kLeast).settings.cut.tear_energy_kpa.has_value());
  EXPECT_FALSE(read(kLeast).settings.cut.slip_mm.has_value());
}

TEST_F(CaseFileTest, ALawOfCuttingThatIsNoneIsRefusedNamingItsField) {
  EXPECT_THAT(refusal_with("cut: {tear_energy_kpa: 0}\n"), AllOf(HasSubstr("cut.tear_energy_kpa"), HasSubstr("found 0, expected")));
  EXPECT_THAT(refusal_with("cut: {slip_mm: -1}\n"), AllOf(HasSubstr("cut.slip_mm"), HasSubstr("above 0")));
  EXPECT_THAT(refusal_with("cut: {toughness: [{label: 1, toughness: 0}]}\n"), HasSubstr("cut.toughness[0].toughness"));
  EXPECT_THAT(refusal_with("cut: {toughness: [{label: 1, toughness: 2}, {label: 1, toughness: 3}]}\n"),
              AllOf(HasSubstr("cut.toughness[1]"), HasSubstr("label 1 again")));
  EXPECT_THAT(refusal_with("thermal: {body_c: 50, damage_c: 45}\n"), AllOf(HasSubstr("thermal"), HasSubstr("damage_c: found 45")));
  EXPECT_THAT(refusal_with("thermal: {body_c: 50, damage_c: 54.9}\n"),
              HasSubstr("thermal.damage_c: found 54.9, expected at least 5 K above body_c"));
  EXPECT_EQ(read(kLeast + std::string("thermal: {body_c: 50, damage_c: 55}\n")).settings.thermal.damage_c, 55.0);
  EXPECT_THAT(refusal_with("tool: {kind: blade, thickness_mm: 0.2}\n"), HasSubstr("advance_per_step_mm"));
}

// --- what is refused
// ---------------------------------------------------------------------------------------------------

TEST_F(CaseFileTest, AMissingFileIsADataError) {
  EXPECT_THROW(static_cast<void>(read_case(folder_ / "nowhere")), DataError);
}

TEST_F(CaseFileTest, TextThatIsNotYamlIsADataErrorWithItsLine) {
  EXPECT_THAT(refusal<DataError>("schema: incise.case/1\nplan: [1, 2\n"), AllOf(HasSubstr("line "), HasSubstr("YAML")));
}

TEST_F(CaseFileTest, AnEmptyFileIsRefused) {
  EXPECT_NE(refusal(""), "accepted");
}

TEST_F(CaseFileTest, AFileThatIsNoGroupIsRefused) {
  EXPECT_NE(refusal("- schema\n- incise.case/1\n"), "accepted");
}

TEST_F(CaseFileTest, AnUnknownKeyIsNamedWithItsLineAndTheNearestValidKey) {
  EXPECT_THAT(refusal_with("plan:\n  depht_mm: 5\n"), AllOf(HasSubstr("case.yaml line 5"), HasSubstr("plan.depht_mm"),
                                                            HasSubstr("unknown key"), HasSubstr("'depth_mm'")));
}

TEST_F(CaseFileTest, AnUnknownGroupIsNamedWithTheNearestValidOne) {
  EXPECT_THAT(refusal_with("tol: {diameter_mm: 1}\n"), AllOf(HasSubstr("line 4"), HasSubstr("'tool'")));
}

TEST_F(CaseFileTest, AKeyGivenTwiceIsRefused) {
  EXPECT_THAT(refusal_with("plan:\n  depth_mm: 5\n  depth_mm: 6\n"),
              AllOf(HasSubstr("line 6"), HasSubstr("'depth_mm' twice")));
  EXPECT_THAT(refusal_with("plan: {depth_mm: 5}\nplan: {depth_mm: 6}\n"),
              AllOf(HasSubstr("line 5"), HasSubstr("'plan' twice")));
}

TEST_F(CaseFileTest, AMissingSchemaIsRefused) {
  EXPECT_THAT(refusal("specimen: {mesh: block.msh}\ntumor: {contour: tumor.csv}\n"),
              AllOf(HasSubstr("schema"), HasSubstr("expected schema: incise.case/1")));
}

TEST_F(CaseFileTest, AnotherSchemaIsRefused) {
  EXPECT_THAT(refusal("schema: incise.case/9\nspecimen: {mesh: block.msh}\ntumor: {contour: tumor.csv}\n"),
              AllOf(HasSubstr("incise.case/9"), HasSubstr("incise.case/1")));
}

TEST_F(CaseFileTest, AValueOfTheWrongTypeIsToldWithWhatWasFoundAndExpected) {
  EXPECT_THAT(refusal_with("plan: {depth_mm: deep}\n"),
              AllOf(HasSubstr("plan.depth_mm"), HasSubstr("deep"), HasSubstr("expected a number")));
  EXPECT_THAT(refusal_with("plan: {depth_mm: [5]}\n"),
              AllOf(HasSubstr("plan.depth_mm"), HasSubstr("expected a number")));
  EXPECT_THAT(refusal_with("plan: {waypoints: 12.5}\n"),
              AllOf(HasSubstr("plan.waypoints"), HasSubstr("expected a whole number")));
  EXPECT_THAT(refusal_with("plan: 5\n"), AllOf(HasSubstr("plan"), HasSubstr("group")));
  EXPECT_THAT(refusal_with("title: [a, b]\n"), AllOf(HasSubstr("title"), HasSubstr("expected a text")));
  EXPECT_THAT(refusal_with("ct: {window_hu: [1, 2, 3]}\n"),
              AllOf(HasSubstr("ct.window_hu"), HasSubstr("3 numbers"), HasSubstr("2 numbers")));
  EXPECT_THAT(refusal_with("ct: {window_hu: 7}\n"), AllOf(HasSubstr("ct.window_hu"), HasSubstr("a list of 2 numbers")));
}

TEST_F(CaseFileTest, AChoiceThatThereIsNotIsToldWithTheNearestOne) {
  EXPECT_THAT(refusal_with("plan: {kind: rign}\n"),
              AllOf(HasSubstr("plan.kind"), HasSubstr("ring, line"), HasSubstr("'ring'")));
}

struct BadValue {
  const char* lines;
  const char* field;
};

/// Names the test by its lines, without the signs that CTest would stumble over.
void PrintTo(const BadValue& value, std::ostream* out) {
  for (const char c : std::string_view(value.lines)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_') *out << c;
    if (c == ':' || c == ',') *out << '_';
  }
}

class OutOfRange : public CaseFileTest, public ::testing::WithParamInterface<BadValue> {};

TEST_P(OutOfRange, IsRefusedNamingTheField) {
  const std::string text = GetParam().lines;
  const std::string least = text.find("specimen") == std::string::npos
                                ? kLeast
                                : "schema: incise.case/1\nct: {volume: ct}\ntumor: {contour: tumor.csv}\n";
  EXPECT_THAT(refusal(least + text), AllOf(HasSubstr("case.yaml"), HasSubstr(GetParam().field)));
}

INSTANTIATE_TEST_SUITE_P(
    Values, OutOfRange,
    ::testing::Values(
        BadValue{"specimen: {material: {youngs_modulus_kpa: -70}}", "specimen.material.youngs_modulus_kpa"},
        BadValue{"specimen: {material: {youngs_modulus_kpa: 0}}", "specimen.material.youngs_modulus_kpa"},
        BadValue{"specimen: {material: {youngs_modulus_kpa: .nan}}", "specimen.material.youngs_modulus_kpa"},
        BadValue{"specimen: {material: {youngs_modulus_kpa: .inf}}", "specimen.material"},
        BadValue{"specimen: {material: {poissons_ratio: 0.5}}", "specimen.material.poissons_ratio"},
        BadValue{"specimen: {material: {poissons_ratio: -0.1}}", "specimen.material.poissons_ratio"},
        BadValue{"specimen: {material: {density_kg_m3: 0}}", "specimen.material.density_kg_m3"},
        BadValue{"specimen: {material: {density_kg_m3: 1e10}}", "specimen.material.density_kg_m3"},
        BadValue{"specimen: {material: {youngs_modulus_kpa: 1e10}}", "specimen.material.youngs_modulus_kpa"},
        BadValue{"specimen: {gravity_mm_s2: [0, 0, .nan]}", "specimen.gravity_mm_s2"},
        BadValue{"cut: {speed_mm_s: 0}", "cut.speed_mm_s"}, BadValue{"cut: {dullness: -1}", "cut.dullness"},
        BadValue{"cut: {dullness: 0}", "cut.dullness"},
        BadValue{"cut: {advance_per_step_mm: 1.5}", "advance_per_step_mm"},
        BadValue{"cut: {residual_tolerance: 0.31}", "cut.residual_tolerance"},
        BadValue{"cut: {residual_tolerance: 9e-7}", "cut.residual_tolerance"},
        BadValue{"thermal: {body_c: 36, damage_c: 44.9}", "thermal.damage_c"},
        BadValue{"plan: {speed_mm_s: 0}", "plan.speed_mm_s"}, BadValue{"plan: {depth_mm: 30}", "plan.depth_mm"},
        BadValue{"plan: {waypoints: 4}", "waypoints"}, BadValue{"plan: {approach: [0, 0, 0]}", "plan.approach"},
        BadValue{"plan: {start_direction: superior}", "start_direction"},
        BadValue{"tool: {diameter_mm: 0}", "tool.diameter_mm"},
        BadValue{"meshing: {fine_mm: 5, coarse_mm: 3}", "meshing.fine_mm"},
        BadValue{"meshing: {tets: -5}", "meshing.tets"}, BadValue{"ct: {window_hu: [180, -20]}", "window_hu"},
        BadValue{"robot: {T_robot_sim: [[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}", "robot.T_robot_sim"},
        BadValue{"robot: {T_robot_sim: [[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}", "robot.T_robot_sim"},
        BadValue{"robot: {T_flange_tool: [[1,0,0,0],[0,1,0,0],[0,0,2,150],[0,0,0,1]]}", "robot.T_flange_tool"}));

TEST_F(CaseFileTest, ACtAndAMeshTogetherAreRefusedAndSoIsNeither) {
  EXPECT_THAT(refusal_with("ct: {volume: ct}\n"), AllOf(HasSubstr("specimen.mesh"), HasSubstr("either a mesh or")));
  EXPECT_THAT(refusal("schema: incise.case/1\ntumor: {contour: tumor.csv}\n"),
              HasSubstr("neither a CT nor labels nor a mesh"));
}

TEST_F(CaseFileTest, AnIncisionNeedsATumorEdgeOrACurveAndADeformationDoesNot) {
  const auto plan_refusal = [this](const std::string& text) {
    const CaseFile file = read(text);  // good enough to deform
    return testing::refusal_of<CaseError>([&] { require_plan_inputs(file); });
  };
  EXPECT_THAT(plan_refusal("schema: incise.case/1\nspecimen: {mesh: block.msh}\n"),
              AllOf(HasSubstr("case.yaml"), HasSubstr("tumor.contour")));
  EXPECT_THAT(plan_refusal("schema: incise.case/1\nspecimen: {mesh: block.msh}\nplan: {kind: line}\n"),
              HasSubstr("plan.line"));
  EXPECT_EQ(plan_refusal("schema: incise.case/1\nspecimen: {mesh: block.msh}\nplan: {kind: line, line: line.csv}\n"),
            "accepted");
  EXPECT_EQ(plan_refusal(kLeast), "accepted");
}

TEST_F(CaseFileTest, EveryKeyOfTheMaterialIsRead) {
  const CaseFile file = read(
      "schema: incise.case/1\ntumor: {contour: tumor.csv}\nspecimen:\n  mesh: block.msh\n  material:" + std::string(R"(
    model: stable_neo_hookean
    volume: averaged
    stiffening: 0.469
    fibre_modulus_kpa: 30
    fibre_stiffening: 2.5
    fibre_direction: [0, 3, 4]
    prony: [{shear_share: 0.5, time_s: 2}, {shear_share: 0.25, time_s: 20}]
    kelvin_voigt_time_s: 0.01
    from_mesh: true
    labels: [{label: 2, youngs_modulus_kpa: 700, poissons_ratio: 0.45}, {label: -3, youngs_modulus_kpa: 7}]
)"));
  const Material& m = file.settings.material;
  EXPECT_EQ(m.model, MaterialModel::StableNeoHookean);
  EXPECT_EQ(m.volume, VolumeTreatment::Averaged);
  EXPECT_EQ(m.stiffening, 0.469);
  EXPECT_EQ(m.fibre_modulus_kpa, 30.0);
  EXPECT_EQ(m.fibre_stiffening, 2.5);
  EXPECT_FALSE(file.settings.variation.fibre_field.has_value());
  EXPECT_LT((m.fibre_direction - Vec3(0.0, 0.6, 0.8)).norm(), 1e-15);
  ASSERT_EQ(m.prony.size(), 2U);
  EXPECT_EQ(m.prony[1].shear_share, 0.25);
  EXPECT_EQ(m.prony[1].time_s, 20.0);
  EXPECT_EQ(m.kelvin_voigt_time_s, 0.01);
  EXPECT_TRUE(file.settings.variation.from_mesh);
  const std::vector<LabelMaterial>& labels = file.settings.variation.labels;
  ASSERT_EQ(labels.size(), 2U);
  EXPECT_EQ(labels[0].label, 2);
  EXPECT_EQ(labels[0].youngs_modulus_kpa, 700.0);
  EXPECT_EQ(labels[0].poissons_ratio, 0.45);
  EXPECT_EQ(labels[1].label, -3);
  EXPECT_FALSE(labels[1].poissons_ratio.has_value());
  // What was read is listed, and reads back as the same.
  const auto settings = settings_by_key(file);
  EXPECT_EQ(settings.at("specimen.material.labels"),
            "[{label: 2, youngs_modulus_kpa: 700, poissons_ratio: 0.45}, {label: -3, youngs_modulus_kpa: 7}]");
  EXPECT_EQ(settings.at("specimen.material.prony"), "[{shear_share: 0.5, time_s: 2}, {shear_share: 0.25, time_s: 20}]");
  EXPECT_EQ(settings.at("specimen.material.from_mesh"), "true");
}

TEST_F(CaseFileTest, AMaterialThatIsNoneIsRefusedNamingItsField) {
  const auto with = [](const std::string& material) {
    return "schema: incise.case/1\ntumor: {contour: tumor.csv}\nspecimen: {mesh: block.msh, material: {" + material + "}}\n";
  };
  const BadValue bad[] = {
      {"model: neo_hookean", "'stable_neo_hookean'"},
      {"volume: mean", "specimen.material.volume"},
      {"fibre_modulus_kpa: -1", "specimen.material.fibre_modulus_kpa"},
      {"fibre_direction: [0, 0, 0]", "specimen.material.fibre_direction"},
      {"stiffening: 0.469", "specimen.material.stiffening: found 0.469 with model corotational"},
      {"model: stable_neo_hookean, stiffening: 101", "specimen.material.stiffening: found 101, expected a number in"},
      {"fibre_stiffening: 5", "specimen.material.fibre_stiffening: found 5 without fibres"},
      {"fibre_modulus_kpa: 9, fibre_stiffening: -1", "specimen.material.fibre_stiffening: found -1"},
      {"prony: {shear_share: 1, time_s: 1}", "specimen.material.prony"},
      {"prony: [{shear_share: 1}]", "no `time_s`"},
      {"prony: [{shear_share: 0, time_s: 1}]", "specimen.material.prony[0].shear_share"},
      {"prony: [{share: 1, time_s: 1}]", "'shear_share'"},
      {"kelvin_voigt_time_s: -1", "specimen.material.kelvin_voigt_time_s"},
      {"from_mesh: perhaps", "true or false"},
      {"labels: [{youngs_modulus_kpa: 7}]", "no `label`"},
      {"labels: [{label: 1.5, youngs_modulus_kpa: 7}]", "a whole number"},
      {"labels: [{label: 1, poissons_ratio: 0.5}]", "specimen.material.labels[0].poissons_ratio"},
      {"labels: [{label: 1}]", "label 1 without a value"},
      {"labels: [{label: 1, youngs_modulus_kpa: 7}, {label: 1, youngs_modulus_kpa: 8}]", "specimen.material.labels[1]"},
  };
  for (const auto& [text, words] : bad) EXPECT_THAT(refusal(with(text)), HasSubstr(words)) << text;
}

TEST_F(CaseFileTest, TheRegionsOfAFibreFieldAreReadAndListed) {
  const CaseFile file = read("schema: incise.case/1\ntumor: {contour: tumor.csv}\nspecimen:\n  mesh: block.msh\n" +
                             std::string(R"(  material:
    fibre_modulus_kpa: 30
    fibre_field:
      from: {end: {direction: posterior, within_mm: 6}}
      to: {patch: {path_mm: [[1, 2, 3], [4, 5, 6]], radius_mm: 2.5}}
)"));
  ASSERT_TRUE(file.settings.variation.fibre_field);
  const FibreField& field = *file.settings.variation.fibre_field;
  EXPECT_EQ(std::get<EndRegion>(field.from).direction, Vec3(0, 1, 0));
  EXPECT_EQ(std::get<EndRegion>(field.from).within_mm, 6.0);
  EXPECT_EQ(std::get<PatchRegion>(field.to).path_mm, (Points{Vec3(1, 2, 3), Vec3(4, 5, 6)}));
  EXPECT_EQ(std::get<PatchRegion>(field.to).radius_mm, 2.5);
  const auto settings = settings_by_key(file);
  EXPECT_EQ(settings.at("specimen.material.fibre_field.from.end.within_mm"), "6");
  EXPECT_EQ(settings.at("specimen.material.fibre_field.to.patch.radius_mm"), "2.5");
}

TEST_F(CaseFileTest, AFibreFieldThatIsNoneIsRefusedNamingItsField) {
  const auto with = [](const std::string& material) {
    return "schema: incise.case/1\ntumor: {contour: tumor.csv}\nspecimen: {mesh: block.msh, material: {" + material +
           "}}\n";
  };
  const std::string end = "{end: {direction: posterior, within_mm: 6}}";
  const std::pair<std::string, const char*> bad[] = {
      {"fibre_field: {from: " + end + ", to: " + end + "}", "specimen.material.fibre_modulus_kpa: found 0 kPa"},
      {"fibre_modulus_kpa: 9, fibre_field: {from: " + end + "}", "specimen.material.fibre_field: found no `to`"},
      {"fibre_modulus_kpa: 9, fibre_field: {to: " + end + "}", "expected the region where the fibres begin"},
      {"fibre_modulus_kpa: 9, fibre_field: {}", "specimen.material.fibre_field: found no `from`"},
      {"fibre_modulus_kpa: 9, fibre_field: along", "specimen.material.fibre_field: found 'along'"},
      {"fibre_modulus_kpa: 9, fibre_field: {from: {}, to: " + end + "}",
       "specimen.material.fibre_field.from: found an empty group"},
      {"fibre_modulus_kpa: 9, fibre_field: {from: {end: {direction: posterior}}, to: " + end + "}",
       "specimen.material.fibre_field.from.end: found no `within_mm`"},
      {"fibre_modulus_kpa: 9, fibre_field: {from: " + end + ", to: {end: {direction: up, within_mm: 6}}}",
       "specimen.material.fibre_field.to.end.direction: found 'up'"},
      {"fibre_modulus_kpa: 9, fibre_field: {from: " + end + ", to: " + end + ", via: " + end + "}", "an unknown key"},
  };
  for (const auto& [text, words] : bad) EXPECT_THAT(refusal(with(text)), HasSubstr(words)) << text;
}

// --- directions and constraints
// ----------------------------------------------------------------------------------------

TEST_F(CaseFileTest, DirectionsMayBeGivenByTheirAnatomicalNamesInLps) {
  const std::pair<const char*, Vec3> named[] = {{"anterior", -Vec3::UnitY()}, {"posterior", Vec3::UnitY()},
                                                {"left", Vec3::UnitX()},      {"right", -Vec3::UnitX()},
                                                {"superior", Vec3::UnitZ()},  {"inferior", -Vec3::UnitZ()}};
  for (const auto& [name, expected] : named) {
    // The start may not lie along the approach, so look from the side for those two.
    const bool is_upright = expected.z() != 0.0;
    const CaseFile file =
        read(std::string(kLeast) + "plan: {start_direction: " + name + (is_upright ? ", approach: right}\n" : "}\n"));
    EXPECT_EQ(file.settings.plan.start_direction, expected) << name;
  }
}

TEST_F(CaseFileTest, ADirectionGivenAsAVectorIsMadeUnit) {
  const CaseFile file = read(std::string(kLeast) + "plan: {approach: [0, 3, -4]}\n");
  EXPECT_LT((file.settings.plan.approach - Vec3(0.0, 0.6, -0.8)).norm(), 1e-15);
}

TEST_F(CaseFileTest, AWordThatIsNoDirectionIsRefused) {
  EXPECT_THAT(refusal_with("plan: {approach: down}\n"),
              AllOf(HasSubstr("plan.approach"), HasSubstr("superior, inferior")));
}

class ConstraintTest : public CaseFileTest {
 protected:
  static std::string with(const std::string& constraints) {
    return "schema: incise.case/1\ntumor: {contour: tumor.csv}\nspecimen:\n  mesh: block.msh\n  constraints:\n" +
           constraints;
  }
};

TEST_F(ConstraintTest, EveryKindAndEveryRegionIsRead) {
  const CaseFile file = read(with(R"(
    - {kind: fixed, where: {box_mm: [[-5, -40, -30], [5, 40, 30]]}, axes: xz}
    - {kind: fixed, where: {point_array: clamp=2}}
    - {kind: displaced, where: {sphere: {center_mm: [1, 2, 3], radius_mm: 4}}, displacement_mm: [20, 0, 0]}
    - {kind: support, plane: {point_mm: [0, 0, -12], normal: superior}}
    - {kind: traction, where: {end: {direction: anterior, within_mm: 7}}, traction_kpa: [0, 0, 1]}
    - {kind: fixed, where: {patch: {path_mm: [[1, 2, 3], [4, 5, 6]], radius_mm: 2.5}}}
)"));
  ASSERT_TRUE(file.settings.constraints);
  const std::vector<Constraint>& all = *file.settings.constraints;
  ASSERT_EQ(all.size(), 6U);
  const auto& clamp = std::get<FixedConstraint>(all[0]);
  EXPECT_EQ(std::get<BoxRegion>(clamp.where).box_mm.min(), Vec3(-5, -40, -30));
  EXPECT_EQ(std::get<BoxRegion>(clamp.where).box_mm.max(), Vec3(5, 40, 30));
  EXPECT_EQ(clamp.axes, (std::array<bool, 3>{true, false, true}));
  const auto& named = std::get<FixedConstraint>(all[1]);
  EXPECT_EQ(std::get<PointArrayRegion>(named.where).name, "clamp");
  EXPECT_EQ(std::get<PointArrayRegion>(named.where).value, 2.0);
  EXPECT_EQ(named.axes, (std::array<bool, 3>{true, true, true}));
  const auto& pull = std::get<DisplacedConstraint>(all[2]);
  EXPECT_EQ(std::get<SphereRegion>(pull.where).center_mm, Vec3(1, 2, 3));
  EXPECT_EQ(std::get<SphereRegion>(pull.where).radius_mm, 4.0);
  EXPECT_EQ(pull.displacement_mm, Vec3(20, 0, 0));
  const auto& platform = std::get<SupportConstraint>(all[3]);
  EXPECT_EQ(platform.point_mm, Vec3(0, 0, -12));
  EXPECT_EQ(platform.normal, Vec3(0, 0, 1));
  const auto& push = std::get<TractionConstraint>(all[4]);
  EXPECT_EQ(std::get<EndRegion>(push.where).direction, Vec3(0, -1, 0));
  EXPECT_EQ(std::get<EndRegion>(push.where).within_mm, 7.0);
  EXPECT_EQ(push.traction_kpa, Vec3(0, 0, 1));
  const auto& painted = std::get<PatchRegion>(std::get<FixedConstraint>(all[5]).where);
  EXPECT_EQ(painted.path_mm, (Points{Vec3(1, 2, 3), Vec3(4, 5, 6)}));
  EXPECT_EQ(painted.radius_mm, 2.5);
}

TEST_F(ConstraintTest, PlanesAndCellArraysAreRegionsToo) {
  const std::string constraints = R"(
    - {kind: fixed, where: {plane: {point_mm: [1, 2, 3], normal: [0, 0, 2], within_mm: 0.5}}}
    - {kind: fixed, where: {plane: {point_mm: [1, 2, 3], normal: posterior}}}
    - {kind: fixed, where: {cell_array: label=7}}
)";
  const CaseFile file = read(with(constraints));
  const std::vector<Constraint>& all = *file.settings.constraints;
  const auto& band = std::get<PlaneRegion>(std::get<FixedConstraint>(all[0]).where);
  EXPECT_EQ(band.point_mm, Vec3(1, 2, 3));
  EXPECT_EQ(band.normal, Vec3::UnitZ());
  EXPECT_EQ(band.within_mm, 0.5);
  EXPECT_FALSE(std::get<PlaneRegion>(std::get<FixedConstraint>(all[1]).where).within_mm.has_value());
  EXPECT_EQ(std::get<CellArrayRegion>(std::get<FixedConstraint>(all[2]).where).value, 7.0);
  const std::string shown = settings_by_key(file).at("specimen.constraints");
  EXPECT_EQ(settings_by_key(read("schema: incise.case/1\nspecimen: {mesh: block.msh, constraints: " + shown + "}\n"))
                .at("specimen.constraints"),
            shown);
  EXPECT_THAT(refusal(with("    - {kind: fixed, where: {plane: {point_mm: [0, 0, 0], normal: up}}}\n")),
              HasSubstr("specimen.constraints[0].where.plane.normal"));
  EXPECT_THAT(refusal(with("    - {kind: fixed, where: {plane: {point_mm: [0, 0, 0], normal: left, within_mm: -1}}}\n")),
              HasSubstr("specimen.constraints[0].where.plane.within_mm"));
}

TEST_F(ConstraintTest, ASupportMayBeTheSurfaceOfAHolder) {
  const std::string text = with("    - {kind: support, surface: parts/holder.stl}\n");
  EXPECT_THAT(refusal<DataError>(text), AllOf(HasSubstr("parts/holder.stl"), HasSubstr("no such file"),
                                              HasSubstr("specimen.constraints[0].surface")));
  std::filesystem::create_directories(folder_ / "parts");
  std::ofstream(folder_ / "parts" / "holder.stl") << "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\n"
                                                     "vertex 0 9 0\nendloop\nendfacet\nendsolid s\n";
  const CaseFile file = read(text);
  const auto& support = std::get<SupportConstraint>(file.settings.constraints->front());
  ASSERT_TRUE(support.holder);
  EXPECT_EQ(support.holder->surface.triangles.size(), 1U);
  EXPECT_EQ(file.inputs.holders, std::vector<std::filesystem::path>{folder_ / "parts" / "holder.stl"});
  EXPECT_EQ(settings_by_key(file).at("specimen.constraints"), "[{kind: support, surface: \"parts/holder.stl\"}]");
  EXPECT_THAT(refusal(with("    - {kind: support, surface: h.stl, plane: {point_mm: [0, 0, 0], normal: superior}}\n")),
              HasSubstr("only one of plane and surface"));
  EXPECT_THAT(refusal(with("    - {kind: support}\n")), HasSubstr("or surface: FILE"));
}

TEST_F(ConstraintTest, ConstraintsAppearInTheSettingsAndReadBack) {
  const std::string text =
      with("    - {kind: displaced, where: {box_mm: [[0, 0, 0], [1, 2, 3]]}, displacement_mm: [20, 0, 0]}\n");
  const std::string shown = settings_by_key(read(text)).at("specimen.constraints");
  const std::string again =
      "schema: incise.case/1\ntumor: {contour: tumor.csv}\nspecimen: {mesh: block.msh, constraints: " + shown + "}\n";
  EXPECT_EQ(settings_by_key(read(again)).at("specimen.constraints"), shown);
}

TEST_F(ConstraintTest, WhatDoesNotMakeAConstraintIsRefusedNamingItsPlace) {
  const BadValue bad[] = {
      {"    []\n", "specimen.constraints"},
      {"    - {kind: glued, where: {box_mm: [[0,0,0],[1,1,1]]}}\n", "specimen.constraints[0].kind"},
      {"    - {where: {box_mm: [[0,0,0],[1,1,1]]}}\n", "no `kind`"},
      {"    - {kind: fixed}\n", "no `where`"},
      {"    - {kind: fixed, where: {}}\n", "specimen.constraints[0].where"},
      {"    - {kind: fixed, where: {box: [[0,0,0],[1,1,1]]}}\n", "'box_mm'"},
      {"    - {kind: fixed, where: {box_mm: [[2,0,0],[1,1,1]]}}\n", "low corner above the high corner"},
      {"    - {kind: fixed, where: {box_mm: [[0,0,0],[1,1]]}}\n", "5 numbers"},
      {"    - {kind: fixed, where: {box_mm: [[0,0,0],[1,1,1]], sphere: {center_mm: [0,0,0], radius_mm: 1}}}\n",
       "2 regions"},
      {"    - {kind: fixed, where: {sphere: {center_mm: [0,0,0], radius_mm: 0}}}\n", "radius_mm"},
      {"    - {kind: fixed, where: {sphere: {center_mm: [0,0,0]}}}\n", "no `radius_mm`"},
      {"    - {kind: fixed, where: {end: {direction: up, within_mm: 3}}}\n",
       "specimen.constraints[0].where.end.direction"},
      {"    - {kind: fixed, where: {point_array: clamp}}\n", "NAME=VALUE"},
      {"    - {kind: fixed, where: {box_mm: [[0,0,0],[1,1,1]]}, axes: xw}\n", "specimen.constraints[0].axes"},
      {"    - {kind: fixed, where: {box_mm: [[0,0,0],[1,1,1]]}, axis: x}\n", "'axes'"},
      {"    - {kind: displaced, where: {box_mm: [[0,0,0],[1,1,1]]}}\n", "no `displacement_mm`"},
      {"    - {kind: displaced, where: {box_mm: [[0,0,0],[1,1,1]]}, displacement_mm: [1, .nan, 0]}\n",
       "displacement_mm[1]"},
      {"    - {kind: support, where: {box_mm: [[0,0,0],[1,1,1]]}}\n", "unknown key"},
      {"    - {kind: support, plane: {point_mm: [0,0,0], normal: [0,0,0]}}\n", "plane.normal"},
      {"    - {kind: traction, where: {box_mm: [[0,0,0],[1,1,1]]}}\n", "no `traction_kpa`"},
  };
  for (const BadValue& value : bad) {
    EXPECT_THAT(refusal(with(value.lines)), AllOf(HasSubstr("case.yaml line "), HasSubstr(value.field))) << value.lines;
  }
}

// --- the schema
// --------------------------------------------------------------------------------------------------------

/// Schema of a dotted key, or nullptr.
const Json* schema_of(const Json& root, const std::string& key) {
  const Json* at = &root;
  for (std::size_t start = 0; start <= key.size();) {
    const std::size_t end = std::min(key.find('.', start), key.size());
    const std::string name = key.substr(start, end - start);
    if (!at->contains("properties") || !at->at("properties").contains(name)) return nullptr;
    at = &at->at("properties").at(name);
    start = end + 1;
  }
  return at;
}

TEST(CaseSchema, HoldsEverySettingWithTheSameUnitAndAMeaning) {
  const Json schema = Json::parse(case_schema_json());
  EXPECT_EQ(schema.at("title"), "incise.case/1");
  EXPECT_FALSE(schema.at("additionalProperties").get<bool>());
  for (const SettingLine& line : settings_of(CaseFile{})) {
    const Json* field = schema_of(schema, line.key);
    ASSERT_NE(field, nullptr) << line.key;
    EXPECT_GE(field->at("description").get<std::string>().size(), 5U) << line.key;
    EXPECT_EQ(field->value("x-unit", ""), line.unit) << line.key;
    EXPECT_TRUE(field->contains("type") || field->contains("enum") || field->contains("oneOf")) << line.key;
  }
}

TEST(CaseSchema, AKeyThatNamesAUnitHasOne) {
  const std::pair<const char*, const char*> endings[] = {
      {"_mm", "mm"}, {"_mm_s", "mm/s"}, {"_kpa", "kPa"}, {"_hu", "HU"}, {"_s", "s"}};
  for (const SettingLine& line : settings_of(CaseFile{})) {
    for (const auto& [ending, unit] : endings) {
      if (line.key.ends_with(ending) &&
          !(std::string(ending) == "_s" && (line.key.ends_with("_mm_s") || line.key.ends_with("_slices")))) {
        EXPECT_EQ(line.unit, unit) << line.key;
      }
    }
  }
}

TEST(CaseSchema, DefaultsLieInTheirRanges) {
  const Json schema = Json::parse(case_schema_json());
  for (const SettingLine& line : settings_of(CaseFile{})) {
    const Json& field = *schema_of(schema, line.key);
    if (!field.contains("default") || !field.at("default").is_number()) continue;
    const double value = field.at("default");
    EXPECT_GE(value, field.value("minimum", value)) << line.key;
    EXPECT_LE(value, field.value("maximum", value)) << line.key;
    EXPECT_GT(value, field.value("exclusiveMinimum", value - 1.0)) << line.key;
    EXPECT_LT(value, field.value("exclusiveMaximum", value + 1.0)) << line.key;
  }
}

TEST(CaseSchema, DefaultsHaveTheShapeThatTheSchemaAsksFor) {
  const Json schema = Json::parse(case_schema_json());
  for (const SettingLine& line : settings_of(CaseFile{})) {
    const Json& field = *schema_of(schema, line.key);
    if (!field.contains("default") || !field.contains("type")) continue;
    const std::string type = field.at("type");
    const Json& value = field.at("default");
    if (type == "array") {
      EXPECT_TRUE(value.is_array()) << line.key;
      EXPECT_EQ(value.size(), field.at("minItems").get<std::size_t>()) << line.key;
    }
    if (type == "number") {
      EXPECT_TRUE(value.is_number()) << line.key;
    }
    if (type == "integer") {
      EXPECT_TRUE(value.is_number_integer()) << line.key;
    }
    if (type == "string") {
      EXPECT_TRUE(value.is_string()) << line.key;
    }
  }
}

TEST(CaseSchema, AFibreFieldNeedsBothOfItsRegionsAndHasNoDefaults) {
  const Json schema = Json::parse(case_schema_json());
  const Json& field = *schema_of(schema, "specimen.material.fibre_field");
  EXPECT_EQ(field.at("required"), Json({"from", "to"}));
  EXPECT_EQ(field.dump().find("default"), std::string::npos);
  EXPECT_EQ(field.dump().find("null"), std::string::npos);
  const Json& end = field.at("properties").at("to").at("properties").at("end");
  EXPECT_EQ(end.at("required"), Json({"direction", "within_mm"}));
  const Json& material = *schema_of(schema, "specimen.material");
  EXPECT_FALSE(material.contains("required")) << "a case may be without";
}

}  // namespace
}  // namespace incise
