#include <incise/storage/case_file.hpp>

namespace incise {
void describe(Visitor& v, CaseFile& file) {
  Case& c = file.settings;
  CaseInputs& in = file.inputs;
  constant(v, {"schema", "Format and version of this file."}, kCaseSchemaName);
  v("title", c.title, "Title of the report.");
  v("specimen_id", c.specimen_id,
    "Name of the specimen, 1 to 64 letters, digits, '.', '_' and '-'; travels with every result. By default it is "
    "derived from the scan or mesh.");
  static constexpr std::array<std::string_view, 2> kOrigins{"real", "virtual"};
  std::size_t origin = c.is_virtual ? 1 : 0;
  v.choice(
      {"specimen_is", "Whether the scan is of real tissue; a virtual one is labelled virtual wherever it appears."},
      origin, kOrigins);
  if (v.sets()) c.is_virtual = origin == 1;

  v.begin({"ct", "The scan of the specimen and which part of it is tissue."});
  v("volume", in.ct_volume, "The CT: DICOM folder, .nrrd/.nhdr, .nii[.gz], .mhd/.mha or a folder of PNG slices.");
  v("labels", in.ct_labels,
    "A label volume (.nrrd/.nhdr, .nii[.gz], .mhd/.mha) in place of thresholds: every label but 0 is tissue. With it "
    "the volume is used for pictures only, and may be left out; absent: window_hu finds the tissue.");
  describe(v, c.segmentation);
  describe(v, file.ct_reading);
  v.end();
  v("meshing", c.meshing, "The tetrahedral mesh made from the tissue.");

  v.begin({"specimen", "What the tissue is and how it is held."});
  v("mesh", in.specimen_mesh, "A tetrahedral mesh (mm, LPS) to use in place of a CT.");
  v.begin({"material", "The tissue's material law."});
  describe(v, c.material);
  describe(v, c.variation);
  v("elasticity_map", in.elasticity_map,
    "Young's modulus in kPa, voxel by voxel, as 32-bit floats (.nrrd/.nhdr, .nii[.gz], .mhd/.mha) in the frame of the "
    "scan; where the map is not above 0, youngs_modulus_kpa applies. Absent: youngs_modulus_kpa applies everywhere.");
  v.end();
  v({"constraints",
     "List of fixed, displaced, support and traction; absent: posterior 15 mm clamped, anterior 10 mm pulled 20 mm "
     "forward, underside on a platform.",
     "mm"},
    c.constraints);
  v({"gravity_mm_s2", "Acceleration of gravity.", "mm/s2"}, c.gravity_mm_s2);
  v({"time_since_stretch_s",
     "Time between the stretch and the cut, for viscous tissue; absent: the tissue has relaxed.", "s"},
    c.time_since_stretch_s, kNotNegative);
  v.end();

  v.begin({"tumor", "The tumour, whose edge a ring keeps clear of."});
  v("contour", in.tumor_contour, "The tumour's edge: .csv (x_mm,y_mm,z_mm), .vtp or Slicer .mrk.json closed curve.");
  v("surface", in.tumor_surface,
    "The tumour's closed surface (.stl, .ply, .vtp, .obj), for the deep margin; absent: only the edge is known.");
  v("configuration", c.tumor_configuration,
    "Whether the edge was marked on the stretched tissue or on the tissue as scanned.");
  v({"surface_tolerance_mm", "Greatest allowed distance of the edge from the surface, along the approach.", "mm"},
    c.surface_tolerance_mm, kPositive);
  v.end();

  v.begin({"plan", "The intended incision."});
  describe_kind(v, c.plan);
  v("line", in.line_contour, "The curve of an open cut, on the stretched tissue: .csv, .vtp or Slicer .mrk.json.");
  describe_course(v, c.plan);
  v({"close_margin_mm", "Clinical cut-off below which a negative margin is too close.", "mm"}, c.close_margin_mm,
    {0.0, 20.0, true});
  v.end();
  v("tool", c.tool, "The instrument.");

  v.begin({"cut", "How the simulated tool cuts; speed and dullness come from calibration."});
  describe_effect(v, c.cut);
  describe(v, c.toughness);
  describe_steps(v, c.cut);
  v("frames", c.frames, "Number of moments of the cut that are kept for pictures.", {0.0, 500.0});
  v.end();
  v("thermal", c.thermal,
    "How far beside the cut heat damages tissue, at plan.power_w and the speeds of the path. Not calibrated.");
  v("compensation", c.compensation, "How the path is corrected by the simulated error.");

  v("path", in.tool_path, "A path.json (frame sim_stretched) to follow in place of the planned path.");
  v.begin({"robot", "The arm, its tool, and where the specimen lies under it."});
  constant(v, {"model", "The arm."}, "ur10e");
  v({"T_robot_sim", "Rigid 4 x 4 transform, by rows, from simulation to robot coordinates; absent: no program is made.",
     "mm"},
    c.T_robot_sim);
  v({"T_flange_tool",
     "Rigid 4 x 4 transform, by rows, from the tool's coordinates (origin at the needle's tip, z along the "
     "needle) to those of the arm's flange; absent: the tip lies 150 mm straight in front of it.",
     "mm"},
    c.T_flange_tool);
  v.end();
}

}  // namespace incise
