#include "describe_case.hpp"

#include <incise/core/error.hpp>

#include <fmt/format.h>

#include <array>

namespace incise {
namespace {

constexpr Range kHu{-1024.0, 32767.0, false, false};
constexpr Range kYoungsModulus{kLeastYoungsModulusKpa, kMostYoungsModulusKpa};
constexpr Range kDensity{0.0, kMostDensityKgM3, true, false};

/// Visits an optional vector, box or matrix through plain numbers; `load` and `store` translate.
template <std::size_t N, class Value, class Load, class Store>
void optional_numbers(FieldVisitor& v, const FieldInfo& info, std::optional<Value>& value, const Range& range, Load load, Store store) {
  std::array<double, N> numbers{};
  bool is_given = value.has_value();
  if (is_given) load(*value, numbers);
  v.numbers(info, numbers, is_given, range);
  if (is_given) value = store(numbers);
}

template <Named E>
void choice(FieldVisitor& v, const FieldInfo& info, E& value) {
  auto position = static_cast<std::size_t>(value);
  v.choice(info, position, names_of(value));
  value = static_cast<E>(position);
}

void vector(FieldVisitor& v, const FieldInfo& info, Vec3& value, const Range& range = kAny) {
  bool is_given = true;
  v.numbers(info, {value.data(), 3}, is_given, range);
}

void optional_vector(FieldVisitor& v, const FieldInfo& info, std::optional<Vec3>& value, const Range& range) {
  optional_numbers<3>(
      v, info, value, range,
      [](const Vec3& from, auto& to) { to = {from.x(), from.y(), from.z()}; },
      [](const auto& from) { return Vec3(from[0], from[1], from[2]); });
}

void describe_ct(CaseFile& file, FieldVisitor& v) {
  SegmentationSettings& s = file.settings.segmentation;
  v.begin_group({"ct", "", "The scan of the specimen and which part of it is tissue."});
  v.path({"volume", "", "DICOM folder, .nrrd, .nii[.gz], .mhd/.mha or a folder of PNG slices."}, file.inputs.ct_volume);
  std::array<double, 2> window{s.window_low_hu, s.window_high_hu};
  bool is_given = true;
  v.numbers({"window_hu", "HU", "Least and greatest value of tissue."}, window, is_given, kHu);
  s.window_low_hu = window[0];
  s.window_high_hu = window[1];
  optional_numbers<6>(
      v, {"roi_box_mm", "mm", "Low and high corner (LPS) of the box that holds the specimen; absent: the whole volume."},
      s.roi_box_mm, kAny,
      [](const Box3& from, auto& to) {
        for (int i = 0; i < 3; ++i) {
          to[static_cast<std::size_t>(i)] = from.min()[i];
          to[static_cast<std::size_t>(i) + 3] = from.max()[i];
        }
      },
      [](const auto& from) { return Box3(Vec3(from[0], from[1], from[2]), Vec3(from[3], from[4], from[5])); });
  std::optional<Vec3> seed;
  if (!s.seeds_mm.empty()) seed = s.seeds_mm.front();
  optional_vector(v, {"seed_mm", "mm", "A point inside the specimen (LPS); absent: the largest piece is taken."}, seed, kAny);
  s.seeds_mm.clear();
  if (seed) s.seeds_mm.push_back(*seed);
  v.number({"opening_radius_mm", "mm", "Pieces joined only by bridges thinner than twice this are separated."},
           s.opening_radius_mm, {0.0, 20.0});
  v.optional_number({"smoothing_mm", "mm", "Standard deviation of the Gaussian that smooths the tissue's surface; absent: 0.6, or 1.2 voxels where that is less."},
                    s.smoothing_mm, {0.0, 5.0});
  v.text({"series_uid", "", "DICOM: which series to read, where a folder holds several."}, file.ct_reading.series_uid);
  choice(v, {"irregular_slices", "", "What to do with a tilted or unevenly spaced series."}, file.ct_reading.irregular);
  choice(v, {"missing_slices", "", "What to do with holes in a series."}, file.ct_reading.missing);
  optional_vector(v, {"spacing_mm", "mm", "PNG slices only: column, row and slice spacing."}, file.ct_reading.spacing_mm, kPositive);
  // The group `hu` belongs to pictures only, so it is absent unless both numbers are given.
  std::optional<GrayToHu>& hu = file.ct_reading.hu;
  std::optional<std::array<double, 2>> slope_intercept;
  if (hu) slope_intercept = {hu->slope, hu->intercept};
  optional_numbers<2>(
      v, {"hu", "HU", "PNG slices only: [slope, intercept] with HU = slope * gray + intercept."}, slope_intercept, kAny,
      [](const auto& from, auto& to) { to = from; }, [](const auto& from) { return from; });
  if (slope_intercept) hu = GrayToHu{(*slope_intercept)[0], (*slope_intercept)[1]};
  v.end_group();
}

void describe_meshing(MeshingChoice& m, FieldVisitor& v) {
  v.begin_group({"meshing", "", "The tetrahedral mesh made from the tissue."});
  v.optional_number({"fine_mm", "mm", "Edge length where the needle and its neighbourhood pass; absent: 0.8, in proportion for a body shorter than 40 mm."}, m.fine_mm,
                    {0.1, 20.0});
  v.optional_number({"coarse_mm", "mm", "Longest edge length, far from the cut; absent: 4, in proportion for a body shorter than 40 mm."}, m.coarse_mm, {0.1, 50.0});
  v.integer({"tets", "", "Count to aim for by scaling both lengths; 0: as the lengths give."}, m.tets, {0.0, 5e6});
  v.optional_number({"survey_mm", "mm",
                     "Edge length of the coarse mesh with which the planned cut is found in the unstretched body; absent: 4, in proportion for a body shorter than 40 mm."},
                    m.survey_mm, {0.5, 20.0});
  v.end_group();
}

void describe_viscosity(Material& m, FieldVisitor& v) {
  static constexpr std::array<Column, 2> kColumns{{
      {{"shear_share", "", "Shear modulus of the branch over the long-time one."}, kPositive},
      {{"time_s", "s", "Relaxation time."}, kPositive},
  }};
  std::vector<Row> rows;
  for (const PronyTerm& term : m.prony) rows.push_back({term.shear_share, term.time_s});
  v.table({"prony", "", "Branches that relax with time, in steps of time only; absent: none."}, kColumns, rows);
  m.prony.clear();
  for (const Row& row : rows) m.prony.push_back({*row[0], *row[1]});
  v.number({"kelvin_voigt_time_s", "s", "Shear viscosity over long-time shear modulus, in steps of time only; 0: none."},
           m.kelvin_voigt_time_s, kNotNegative);
}

void describe_labels(std::vector<LabelMaterial>& labels, FieldVisitor& v) {
  static constexpr std::array<Column, 3> kColumns{{
      {{"label", "", "Value of the mesh's cell array 'label'."}, {-1e9, 1e9}, true, true},
      {{"youngs_modulus_kpa", "kPa", "Young's modulus there; absent: as elsewhere."}, kYoungsModulus, false},
      {{"poissons_ratio", "", "Poisson's ratio there; absent: as elsewhere."}, {0.0, 0.5, false, true}, false},
  }};
  std::vector<Row> rows;
  for (const LabelMaterial& l : labels) rows.push_back({static_cast<double>(l.label), l.youngs_modulus_kpa, l.poissons_ratio});
  v.table({"labels", "", "Parts of the mesh with another stiffness, by the cell array 'label'; absent: none."}, kColumns, rows);
  labels.clear();
  for (const Row& row : rows) labels.push_back({static_cast<int>(*row[0]), row[1], row[2]});
}

void describe_specimen(CaseFile& file, FieldVisitor& v) {
  Case& c = file.settings;
  v.begin_group({"specimen", "", "What the tissue is and how it is held."});
  v.path({"mesh", "", "A tetrahedral mesh (mm, LPS) to use in place of a CT."}, file.inputs.specimen_mesh);
  v.begin_group({"material", "", "The tissue's law."});
  choice(
      v,
      {"model", "", "Linear elasticity in a frame that turns with each tet, as in the paper; or a hyperelastic law."},
      c.material.model);
  choice(v,
         {"volume", "",
          "How volume change is resisted: tet by tet (locks as Poisson's ratio nears 0.5), or as a mean about each "
          "vertex."},
         c.material.volume);
  v.number({"youngs_modulus_kpa", "kPa", "Young's modulus; the paper's 70 is about ten times published tongue stiffness."},
           c.material.youngs_modulus_kpa, kYoungsModulus);
  v.number({"poissons_ratio", "", "Poisson's ratio."}, c.material.poissons_ratio, {0.0, 0.5, false, true});
  v.number({"density_kg_m3", "kg/m3", "Density."}, c.material.density_kg_m3, kDensity);
  v.number({"fibre_modulus_kpa", "kPa", "Stiffness added along the fibres; 0: none."}, c.material.fibre_modulus_kpa, kNotNegative);
  v.direction({"fibre_direction", "", "Of the fibres at rest, where the mesh gives none."}, c.material.fibre_direction);
  describe_viscosity(c.material, v);
  v.flag({"from_mesh", "", "Whether the mesh's cell data youngs_modulus_kpa, poissons_ratio and fibre_direction hold, as far as they are there."},
         c.variation.from_mesh);
  describe_labels(c.variation.labels, v);
  v.end_group();
  v.constraints({"constraints", "mm",
                 "List of fixed, displaced, support and traction; absent: posterior 15 mm clamped, anterior 10 mm pulled 20 mm "
                 "forward, underside on a platform."}, c.constraints);
  vector(v, {"gravity_mm_s2", "mm/s2", "Acceleration of gravity."}, c.gravity_mm_s2);
  v.end_group();
}

void describe_tumor(CaseFile& file, FieldVisitor& v) {
  v.begin_group({"tumor", "", "The edge that a ring keeps clear of."});
  v.path({"contour", "", ".csv (x_mm,y_mm,z_mm), .vtp or Slicer .mrk.json closed curve."}, file.inputs.tumor_contour);
  v.path({"surface", "",
          "The tumour's closed surface (.stl, .ply, .vtp, .obj), for the deep margin; absent: only the edge is known."},
         file.inputs.tumor_surface);
  choice(v, {"configuration", "", "Whether the edge was marked on the stretched tissue or on the tissue as scanned."},
         file.settings.tumor_configuration);
  v.number({"surface_tolerance_mm", "mm", "Farthest that the edge may lie off the surface along the approach."},
           file.settings.surface_tolerance_mm, kPositive);
  v.end_group();
}

void describe_plan(CaseFile& file, FieldVisitor& v) {
  PlanSettings& p = file.settings.plan;
  v.begin_group({"plan", "", "The intended incision."});
  choice(v, {"kind", "", "A ring around the tumour edge, or an open cut along a drawn curve."}, p.kind);
  v.path({"line", "", "The curve of an open cut, on the stretched tissue: .csv, .vtp or Slicer .mrk.json."}, file.inputs.line_contour);
  v.number({"lateral_margin_mm", "mm", "From the tumour edge to the kerf's mid-line."}, p.lateral_margin_mm, {0.5, 50.0});
  v.number({"depth_mm", "mm", "Of the tool's tip below the surface."}, p.depth_mm, {0.5, 50.0});
  v.number({"speed_mm_s", "mm/s", "Of the real tool."}, p.speed_mm_s, {0.1, 50.0});
  v.number({"power_w", "W", "Electrosurgical power: how fast contact cuts (cut.power_exponent), and how far beside the cut heat reaches."}, p.power_w, {0.0, 120.0, true, false});
  v.direction({"approach", "", "Into the tissue, as camera and surgeon look."}, p.approach);
  v.direction({"start_direction", "", "A ring starts at its waypoint farthest along this; the start decides where the error falls."},
              p.start_direction);
  v.integer({"waypoints", "", "Evenly spaced along the path."}, p.waypoints, {2.0, 2000.0});
  choice(v, {"tool_axis", "", "How the tool is held at a waypoint."}, p.axis_mode);
  v.number({"close_margin_mm", "mm", "Clinical cut-off below which a negative margin is too close."}, file.settings.close_margin_mm,
           {0.0, 20.0, true, false});
  v.end_group();
}

/// The dimensions of the three tools; each has some of them.
struct ToolDimensions {
  std::optional<double> diameter_mm, length_mm, thickness_mm, width_mm;
};

ToolDimensions dimensions_of(const Tool& tool) {
  struct Read {
    ToolDimensions operator()(const Needle& t) const { return {t.diameter_mm, t.length_mm, {}, {}}; }
    ToolDimensions operator()(const Blade& t) const { return {{}, t.length_mm, t.thickness_mm, t.width_mm}; }
    ToolDimensions operator()(const Ball& t) const { return {t.diameter_mm, {}, {}, {}}; }
  };
  return std::visit(Read{}, tool);
}

/// @pre all dimensions that the tool has are there.
Tool tool_with(const Tool& kind, const ToolDimensions& d) {
  if (std::holds_alternative<Needle>(kind)) return Needle{*d.diameter_mm, *d.length_mm};
  if (std::holds_alternative<Blade>(kind)) return Blade{*d.thickness_mm, *d.width_mm, *d.length_mm};
  return Ball{*d.diameter_mm};
}

void describe_tool(CaseFile& file, FieldVisitor& v) {
  // In the order of the alternatives of Tool.
  static constexpr std::array<std::string_view, 3> kTools{"needle", "blade", "ball"};
  Tool& tool = file.settings.tool;
  v.begin_group({"tool", "", "The instrument."});
  std::size_t kind = tool.index();
  v.choice({"kind", "", "A needle, a blade that is led edge first, or a ball."}, kind, kTools);
  if (kind != tool.index()) tool = std::array<Tool, 3>{Needle{}, Blade{}, Ball{}}[kind];
  const ToolDimensions own = dimensions_of(tool);
  ToolDimensions given = own;
  struct Field {
    FieldInfo info;
    std::optional<double> ToolDimensions::*dimension;
    Range range;
  };
  static constexpr std::array<Field, 4> kFields{{
      {{"diameter_mm", "mm", "Of needle or ball."}, &ToolDimensions::diameter_mm, {0.05, 10.0}},
      {{"length_mm", "mm", "Of needle or blade, from its tip."}, &ToolDimensions::length_mm, {0.0, 200.0, true, false}},
      {{"thickness_mm", "mm", "Of a blade; 0.5 unless given."}, &ToolDimensions::thickness_mm, {0.05, 10.0}},
      {{"width_mm", "mm", "Of a blade, in the direction of travel; 2.4 unless given."}, &ToolDimensions::width_mm, {0.05, 50.0}},
  }};
  for (const Field& field : kFields) {
    v.optional_number(field.info, given.*field.dimension, field.range);
    if ((given.*field.dimension).has_value() && !(own.*field.dimension).has_value()) {
      throw CaseError(file.file.string(), fmt::format("tool.{}", field.info.name), "a dimension of another tool",
                      fmt::format("no such key for tool.kind: {}", kTools[kind]));
    }
  }
  v.end_group();
  tool = tool_with(tool, given);
}

void describe_toughness(ToughnessVariation& toughness, FieldVisitor& v) {
  static constexpr std::array<Column, 2> kColumns{{
      {{"label", "", "Value of the mesh's cell array 'label'."}, {-1e9, 1e9}, true, true},
      {{"toughness", "", "There; the reference tissue has 1."}, {1e-3, 1e3}},
  }};
  std::vector<Row> rows;
  for (const LabelToughness& l : toughness.labels) rows.push_back({static_cast<double>(l.label), l.toughness});
  v.table({"toughness", "", "Parts of the mesh that take more or less dose to cut, by the cell array 'label'; absent: 1 everywhere."}, kColumns, rows);
  toughness.labels.clear();
  for (const Row& row : rows) toughness.labels.push_back({static_cast<int>(*row[0]), *row[1]});
  v.flag({"toughness_from_mesh", "", "Whether the mesh's cell data toughness hold."}, toughness.from_mesh);
}

void describe_cut(Case& c, FieldVisitor& v) {
  v.begin_group({"cut", "", "How the simulated tool cuts; speed and dullness come from calibration."});
  v.number({"speed_mm_s", "mm/s", "Of the simulated tool."}, c.cut.speed_mm_s, {0.01, 100.0});
  v.number({"dullness", "steps", "Contact needed before a tetrahedron goes, in reference steps."}, c.cut.dullness, {0.0, 1000.0, true, false});
  v.number({"reference_step_s", "s", "The time that one unit of dullness stands for."}, c.cut.reference_step_s, {0.0, 1.0, true, false});
  v.number({"reference_power_w", "W", "Power for which dullness holds."}, c.cut.reference_power_w, {0.0, 120.0, true, false});
  v.number({"power_exponent", "", "Contact cuts (plan.power_w / reference_power_w) to this times as fast; 0: power has no effect."},
           c.cut.power_exponent, {0.0, 10.0});
  v.optional_number({"tear_energy_kpa", "kPa", "Work of the tool per volume at which held tissue tears; absent: it does not."},
                    c.cut.tear_energy_kpa, {1e-3, 1e6});
  v.optional_number({"slip_mm", "mm", "Tissue that the tool has left this far behind slips; absent: never."}, c.cut.slip_mm, kPositive);
  describe_toughness(c.toughness, v);
  v.number({"advance_per_step_mm", "mm", "Tool travel in one simulation step, at most the tool's diameter or thickness."},
           c.cut.advance_per_step_mm, {0.01, 10.0});
  v.number({"reach_mm", "mm", "Tissue is in contact within the tool's radius plus this of its core."}, c.cut.reach_mm, {0.0, 5.0});
  v.number({"bond_stiffness_kpa_mm2", "kPa/mm2", "Pull of the tool on tissue that it holds, per volume and offset; 0: no drag."},
           c.cut.bond_stiffness_kpa_mm2, {0.0, 1e6});
  v.number({"overlap_mm", "mm", "A ring is cut this far beyond its start, less than once round."}, c.cut.overlap_mm, {0.0, 50.0});
  v.number({"residual_tolerance", "", "Of each step's linear solve, relative to the contact force."}, c.cut.residual_tolerance,
           {1e-6, 0.3});
  v.integer({"frames", "", "Moments of the cut that are kept for pictures."}, c.frames, {0.0, 500.0});
  v.end_group();
}

void describe_thermal(ThermalSettings& t, FieldVisitor& v) {
  v.begin_group({"thermal", "", "How far beside the cut heat damages tissue, at plan.power_w and the speeds of the path. Not calibrated."});
  v.number({"conductivity_w_m_k", "W/(m K)", "Of heat in tissue; muscle in the IT'IS database."}, t.conductivity_w_m_k, {0.01, 100.0});
  v.number({"heat_capacity_mj_m3_k", "MJ/(m3 K)", "Per volume; muscle in the IT'IS database."}, t.heat_capacity_mj_m3_k, {0.01, 100.0});
  v.number({"body_c", "°C", "Temperature of the tissue before the cut."}, t.body_c, {-20.0, 60.0});
  v.number({"damage_c", "°C", "Temperature at which tissue counts as damaged (Thomsen 1991: coagulation); at least 5 K above body_c."}, t.damage_c, {45.0, 200.0});
  v.number({"absorbed_fraction", "", "Share of the power that heats the tissue beside the kerf; 1: an upper bound."}, t.absorbed_fraction,
           {0.001, 1.0});
  v.end_group();
}

void describe_compensation(CompensationChoice& c, FieldVisitor& v) {
  v.begin_group({"compensation", "", "How the path is corrected by the simulated error."});
  choice(v, {"method", "", "Pass by pass until the cut lies where it was intended, or the paper's one pass."},
         c.method);
  choice(v, {"observable", "", "Which line of the cut is brought to its target; the paper's method: the mid-line."},
         c.observable);
  v.number({"bias_mm", "mm", "Expected error of the real cut less that of the simulated one, positive: farther out; default method only."},
           c.bias_mm, {-10.0, 10.0});
  v.end_group();
}

void describe_robot(CaseFile& file, FieldVisitor& v) {
  v.path({"path", "", "A path.json (frame sim_stretched) to follow in place of the planned one."}, file.inputs.tool_path);
  v.begin_group({"robot", "", "The arm, its tool, and where the specimen lies under it."});
  static constexpr std::array<std::string_view, 1> kModels{"ur10e"};
  std::size_t model = 0;
  v.choice({"model", "", "The arm."}, model, kModels);
  const auto transform = [&v](const FieldInfo& info, std::optional<Mat4>& value) {
    optional_numbers<16>(
        v, info, value, kAny,
        [](const Mat4& from, auto& to) { Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(to.data()) = from; },
        [](const auto& from) { return Mat4(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(from.data())); });
  };
  transform({"T_robot_sim", "mm", "Rigid 4 x 4 transform, rows, from simulation to robot coordinates; absent: no program is made."},
            file.settings.T_robot_sim);
  transform({"T_flange_tool", "mm",
             "Rigid 4 x 4 transform, rows, from the tool's coordinates (origin at the needle's tip, z along the needle) to those of the arm's "
             "flange; absent: the tip lies 150 mm straight in front of it."},
            file.settings.T_flange_tool);
  v.end_group();
}

}  // namespace

void describe_case(CaseFile& file, FieldVisitor& v) {
  static constexpr std::array<std::string_view, 1> kSchemas{kCaseSchemaName};
  std::size_t schema = 0;
  v.choice({"schema", "", "Format and version of this file."}, schema, kSchemas);
  v.text({"title", "", "Shown on the report."}, file.settings.title);
  v.text({"specimen_id", "",
          "Name of the specimen, 1 to 64 letters, digits, '.', '_' and '-'; travels with every result. By default it "
          "follows from the scan or mesh."},
         file.settings.specimen_id);
  static constexpr std::array<std::string_view, 2> kOrigins{"real", "virtual"};
  std::size_t origin = file.settings.is_virtual ? 1 : 0;
  v.choice({"specimen_is", "", "Whether the scan is of real tissue; a virtual one is said to be virtual wherever it appears."}, origin,
           kOrigins);
  file.settings.is_virtual = origin == 1;
  describe_ct(file, v);
  describe_meshing(file.settings.meshing, v);
  describe_specimen(file, v);
  describe_tumor(file, v);
  describe_plan(file, v);
  describe_tool(file, v);
  describe_cut(file.settings, v);
  describe_thermal(file.settings.thermal, v);
  describe_compensation(file.settings.compensation, v);
  describe_robot(file, v);
}

}  // namespace incise
