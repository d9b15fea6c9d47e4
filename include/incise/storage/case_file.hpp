#pragma once

#include <incise/io/input_file.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/workflow/case.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace incise {

/// The files that a case names, as absolute paths; an empty path is not named.
struct CaseInputs {
  std::filesystem::path ct_volume;
  std::filesystem::path ct_labels;  ///< label volume, used in place of thresholds
  std::filesystem::path specimen_mesh;
  std::filesystem::path tumor_contour;
  std::filesystem::path tumor_surface;    ///< closed, in the configuration of the contour
  std::filesystem::path line_contour;     ///< the curve of an open cut
  std::filesystem::path elasticity_map;   ///< volume of Young's modulus, kPa, in the frame of the scan
  std::filesystem::path tool_path;        ///< a path to follow in place of the planned one
  std::vector<std::filesystem::path> holders;  ///< surfaces of supports, in the order of the constraints that name them
};

/// One setting with its full key, for manifests, reports and cache keys.
struct SettingLine {
  std::string key;    ///< dotted: plan.depth_mm
  std::string value;  ///< as in the file
  std::string unit;
};

/// Content of a case file (incise.case/1).
struct CaseFile {
  std::filesystem::path file;
  std::filesystem::path folder;           ///< paths in the file are relative to it
  Case settings;
  CtReadSettings ct_reading;
  CaseInputs inputs;
};

inline constexpr std::string_view kCaseSchemaName = "incise.case/1";

/// Describes the case file: its groups in the order of the file, with the fields of the settings in them. The reader,
/// the list of settings, the schema and the printed defaults are visitors of this description.
void describe(Visitor& v, CaseFile& file);

/// Reads a case file (YAML or JSON), or `case.yaml` in a folder, and the holders' surfaces that it names. Other files
/// that it names are not opened. Refuses unknown keys, wrong types and values out of range.
/// @throws CaseError with line, field, found, expected and the nearest valid key; DataError if the file is missing,
///         larger than kLargestCaseBytes or not YAML, or if a holder's surface cannot be read.
[[nodiscard]] CaseFile read_case(const std::filesystem::path& file_or_folder);

/// As read_case, from the text of a case file that need not exist.
/// @param case_path  path of the file; names in the text are relative to its folder
[[nodiscard]] CaseFile parse_case(const std::string& text, const std::filesystem::path& case_path);

/// Checks that the case names the contour from which the path is planned and round which the mesh is refined. Deforming
/// a given mesh does not need it. @throws CaseError if a ring has no tumour edge, or a line no curve.
void require_plan_inputs(const CaseFile& file);

/// Checks, before a long computation, that the files that a case names exist.
/// @throws DataError naming the first missing file and its field.
void require_input_files(const CaseFile& file);

/// Reads the tetrahedral mesh that a case names, mm, LPS, and checks that it is valid and in one piece. If all tets had
/// to be turned over, a Notice reports it.
/// @pre the case names a mesh (InvalidArgument).
/// @throws DataError naming the file and its first problem: an inverted, flat or duplicate tet, more than one body, a
///         longest side outside kSmallestBodyMm to kLargestBodyMm, and the like.
[[nodiscard]] TetMesh read_specimen_mesh(const CaseFile& file, Monitor& monitor);

/// Returns the specimen id of a case: its own `specimen_id`, or else the id in its mesh's file, or else one made from
/// the digest of its scan or mesh; empty if it names neither.
/// @param digest  returns the SHA-256 of an input, hexadecimal  @throws DataError if the input cannot be read.
[[nodiscard]] std::string specimen_id_of_case(
    const CaseFile& file, const std::function<std::string(const std::filesystem::path&)>& digest = sha256_of_input);

/// Returns all settings of a case, defaults included, in the order of the file.
[[nodiscard]] std::vector<SettingLine> settings_of(const CaseFile& file);
/// Returns the same as the text of one JSON object: dotted keys, values as text.
[[nodiscard]] std::string settings_json(const CaseFile& file);

/// Returns the JSON Schema (draft 2020-12) of the case file: type, default, range, unit and meaning of every field.
[[nodiscard]] std::string case_schema_json();
/// Returns a case file with every default, and with unit and meaning of each field as a comment.
[[nodiscard]] std::string case_defaults_yaml();

}  // namespace incise
