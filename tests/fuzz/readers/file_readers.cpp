// Readers of meshes, surfaces, contours, tables, paths, programs, and of volumes' headers.

#include "io/volume_dicom.hpp"
#include "io/volume_dicom_file.hpp"
#include "io/volume_pictures.hpp"
#include "reader.hpp"

#include <incise/core/described_json.hpp>
#include <incise/core/monitor.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/input_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/path_io.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/io/pvd_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/table_io.hpp>
#include <incise/io/transform_json.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/robot/program_audit.hpp>
#include <incise/robot/program_reading.hpp>

#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>

namespace incise::fuzz {
namespace {

namespace fs = std::filesystem;

void tet_mesh(const fs::path& file) { static_cast<void>(read_tet_mesh(file)); }
void cloud(const fs::path& file) { static_cast<void>(read_cloud(file)); }
void contour(const fs::path& file) { static_cast<void>(read_contour(file, true)); }
void volume(const fs::path& file) {
  Monitor monitor;
  static_cast<void>(read_ct(file, {}, monitor));
}

void table(const fs::path& file) {
  static_cast<void>(csv_text(read_csv_text(file)));
  static_cast<void>(read_csv_columns(file, {"x_mm", "mean"}));
}

void path(const fs::path& file) {
  static_cast<void>(read_tool_path(file));
  static_cast<void>(read_path_verdict(file));
}

void program(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  static_cast<void>(program_from_text(text, file));
}

void json(const fs::path& file) {
  const auto document = read_json(file);
  static_cast<void>(document.dump());
  static_cast<void>(transform_in(document, "T_robot_camera", file));
}

/// All files that a header names, as keys of results are made from them.
void named_files(const fs::path& file) { static_cast<void>(input_files(file)); }

void dicom_header(const fs::path& file) {
  static_cast<void>(read_dicom_identity(file));
  static_cast<void>(read_dicom_header(file));
}

/// A folder of two slices: the parts of one input.
void dicom_folder(const fs::path& file) {
  CtReadSettings settings;
  Monitor monitor;
  static_cast<void>(read_ct(file.parent_path(), settings, monitor));
}

std::vector<Reader> all_readers() {
  constexpr double kWithAProcess = 0.05;  // ITK and GDCM read in a process of their own
  return {
      {"ply", "ply", {"a.ply"}, cloud},
      {"obj", "obj", {"a.obj"}, cloud},
      {"stl", "stl", {"a.stl"}, cloud},
      {"vtp", "xml", {"a.vtp"}, cloud},
      {"vtu", "xml", {"a.vtu"}, tet_mesh},
      {"vtk", "vtk", {"a.vtk"}, tet_mesh},
      {"msh", "msh", {"a.msh"}, tet_mesh},
      {"tetgen", "tetgen", {"a.node", "a.ele"}, tet_mesh},
      {"pvd", "xml", {"a.pvd"}, [](const fs::path& file) { static_cast<void>(read_pvd(file)); }},
      {"contour_csv", "csv", {"a.csv"}, contour},
      {"contour_vtp", "xml", {"a.vtp"}, contour},
      {"contour_json", "json", {"a.mrk.json"}, contour},
      {"table", "csv", {"a.csv"}, table},
      {"json", "json", {"a.json"}, json},
      {"path", "path", {"path.json"}, path},
      {"urscript", "script", {"a.script"}, program},
      {"joint_csv", "script", {"a.csv"}, program},
      {"program_json", "program_json", {"a.json"}, program},
      {"nrrd_header", "nrrd", {"a.nhdr"}, named_files},
      {"meta_header", "meta", {"a.mhd"}, named_files},
      {"png", "png", {"a.png"}, [](const fs::path& file) { static_cast<void>(read_gray_png(file)); }},
      {"picture",
       "picture",
       {"a.png"},
       [](const fs::path& file) { static_cast<void>(decode_picture(read_text(file), file)); }},
      {"depth",
       "picture",
       {"a.png"},
       [](const fs::path& file) { static_cast<void>(decode_depth(read_text(file), file)); }},
      {"dicom_header", "dicom", {"a.dcm"}, dicom_header},
      {"dicom", "dicom", {"a.dcm", "b.dcm"}, dicom_folder, kWithAProcess},
      {"nrrd", "nrrd", {"a.nrrd"}, volume, kWithAProcess},
      {"nhdr", "nrrd", {"a.nhdr", "a.raw"}, volume, kWithAProcess},
      {"mha", "meta", {"a.mha"}, volume, kWithAProcess},
      {"mhd", "meta", {"a.mhd", "a.raw"}, volume, kWithAProcess},
      {"nifti", "nifti", {"a.nii"}, volume, kWithAProcess},
  };
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = all_readers();
  return all;
}

}  // namespace incise::fuzz
