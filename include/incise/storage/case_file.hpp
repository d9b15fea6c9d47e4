#pragma once

#include <incise/io/volume_io.hpp>
#include <incise/workflow/case.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace incise {

/// The files that a case names, as absolute paths; empty: not named.
struct CaseInputs {
  std::filesystem::path ct_volume;
  std::filesystem::path ct_labels;  ///< in place of thresholds
  std::filesystem::path specimen_mesh;
  std::filesystem::path tumor_contour;
  std::filesystem::path tumor_surface;    ///< closed, in the configuration of the contour
  std::filesystem::path line_contour;     ///< the curve of an open cut
  std::filesystem::path elasticity_map;   ///< Young's modulus, kPa, in the frame of the scan
  std::filesystem::path tool_path;        ///< a path to follow in place of the planned one
  std::vector<std::filesystem::path> holders;  ///< surfaces of supports, in the order of the constraints that name them
};

/// One setting in full, for manifests, reports and cache keys.
struct SettingLine {
  std::string key;    ///< dotted: plan.depth_mm
  std::string value;  ///< as in the file
  std::string unit;
};

/// A case file (incise.case/1) as read.
struct CaseFile {
  std::filesystem::path file;
  std::filesystem::path folder;           ///< paths in the file are relative to it
  Case settings;
  CtReadSettings ct_reading;
  CaseInputs inputs;
};

inline constexpr std::string_view kCaseSchemaName = "incise.case/1";

/// The case file: its groups, in the order in which they are written, and what the descriptions of the settings say of
/// each field. Reading, the list of settings, the schema and the printed defaults are visitors of it.
void describe(Visitor& v, CaseFile& file);

/// Reads `case.yaml` (YAML or JSON), or the file of that name in a folder. Unknown keys, wrong types and values out of range are refused.
/// @throws CaseError with line, field, found, expected and the nearest valid key; DataError if the file is missing or not YAML, or the
///         surface of a holder cannot be read.
[[nodiscard]] CaseFile read_case(const std::filesystem::path& file_or_folder);

/// The same from a text that is, or is to be, that file's. @param case_path  of the file: names in it are
/// relative to its folder.
[[nodiscard]] CaseFile parse_case(const std::string& text, const std::filesystem::path& case_path);

/// What laying a path needs, and so what meshing around it does; a mere deformation of a given mesh goes without.
/// @throws CaseError when neither a tumour edge (ring) nor a curve (line) is named.
void require_plan_inputs(const CaseFile& file);

/// Looks for the files that a case names, before a long computation needs them.
/// @throws DataError naming the first file that is missing and the field that asks for it.
void require_input_files(const CaseFile& file);

/// The tetrahedra that a case names, sound and in one piece; a Notice says so where all had to be turned over.
/// @pre a mesh is named.
/// @throws DataError naming the file and its first problem: an inverted, flat or duplicate tet, more than one body, and the like.
[[nodiscard]] TetMesh read_specimen_mesh(const CaseFile& file, Monitor& monitor);

/// Which specimen the case is of: what it says, else what its mesh's file says, else an id from the data of its scan or
/// mesh; empty: it names neither. @param digest  SHA-256 of an input, hexadecimal. @throws DataError where that cannot
/// be read.
[[nodiscard]] std::string specimen_id_of_case(const CaseFile& file,
                                              const std::function<std::string(const std::filesystem::path&)>& digest);
/// The same; reads the scan or mesh.
[[nodiscard]] std::string specimen_id_of_case(const CaseFile& file);

/// All settings of a case, defaults included, in the file's order.
[[nodiscard]] std::vector<SettingLine> settings_of(const CaseFile& file);
/// The same as JSON text, groups as objects.
[[nodiscard]] std::string settings_json(const CaseFile& file);

/// JSON Schema (draft 2020-12) of the case file: type, default, range, unit and meaning of every field.
[[nodiscard]] std::string case_schema_json();
/// A case file with every default, each with unit and meaning as a comment.
[[nodiscard]] std::string case_defaults_yaml();

}  // namespace incise
