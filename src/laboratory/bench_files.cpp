#include <incise/core/error.hpp>
#include <incise/core/nearest_name.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/mesh_io.hpp>
#include <incise/io/picture_io.hpp>
#include <incise/io/surface_io.hpp>
#include <incise/io/volume_io.hpp>
#include <incise/laboratory/bench_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace incise {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kSpecimenSchema = "incise.specimen/1";
constexpr const char* kVirtual = "Virtual: computed by incise's bench, no real tissue.";

Json matrix(const Mat4& T) {
  Json rows = Json::array();
  for (int r = 0; r < 4; ++r) rows.push_back({T(r, 0), T(r, 1), T(r, 2), T(r, 3)});
  return rows;
}

std::string spread_text(const ParameterSpec& spec) {
  switch (spec.drawn_as) {
    case DrawnAs::Uniform:
      return fmt::format("uniform in [{}, {}]", spec.a, spec.b);
    case DrawnAs::Normal:
      return fmt::format("normal, mean {}, sd {}", spec.a, spec.b);
    case DrawnAs::LogNormal:
      return fmt::format("lognormal, median {}, sd of the logarithm {}", spec.a, spec.b);
  }
  return "";
}

void require_schema(const Json& document, const char* expected, const std::filesystem::path& file) {
  if (!document.is_object()) throw DataError(file, "", document.type_name(), "an object");
  const auto found = document.find("schema");
  if (found == document.end() || *found != expected)
    throw DataError(file, "schema", found == document.end() ? "nothing" : found->dump(),
                    fmt::format("\"{}\"", expected));
}

double number_in(const Json& object, const std::string& key, const std::filesystem::path& file) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number() || !std::isfinite(found->get<double>()))
    throw DataError(file, key, found == object.end() ? "nothing" : found->dump(), "a finite number");
  return found->get<double>();
}

}  // namespace

std::string bench_schema_json() {
  Json schema;
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = kSpecimenSchema;
  schema["description"] =
      "A virtual specimen: all that is hidden from the planner. Parameters that are not given are drawn from the "
      "seed.";
  schema["type"] = "object";
  Json& properties = schema["properties"];
  properties["schema"] = {{"const", kSpecimenSchema}};
  properties["seed"] = {
      {"type", "integer"},
      {"minimum", 0},
      {"description", "Of the shape, of the fields inside, of all noise and of every parameter that is not given"}};
  const Specimen defaults;
  for (const ParameterSpec& spec : parameter_specs()) {
    properties[std::string(spec.name)] = {{"type", "number"},
                                          {"minimum", spec.low},
                                          {"maximum", spec.high},
                                          {"default", defaults.*spec.member},
                                          {"description", spec.meaning},
                                          {"x-spread", spread_text(spec)},
                                          {"x-source", spec.source},
                                          {"x-shows-in", spec.shows_in}};
  }
  schema["required"] = {"schema", "seed"};
  schema["additionalProperties"] = false;
  return json_text(schema);
}

Json specimen_json(const Specimen& specimen) {
  Json json;
  json["schema"] = kSpecimenSchema;
  json["seed"] = specimen.seed;
  for (const ParameterSpec& spec : parameter_specs()) json[std::string(spec.name)] = specimen.*spec.member;
  return json;
}

Specimen read_specimen(const std::filesystem::path& file) {
  const Json document = read_json(file);
  require_schema(document, kSpecimenSchema, file);
  const auto seed = document.find("seed");
  if (seed == document.end() || !seed->is_number_unsigned())
    throw DataError(file, "seed", seed == document.end() ? "nothing" : seed->dump(), "a whole number, 0 or above");
  Specimen specimen = draw_specimen(seed->get<std::uint64_t>());
  std::vector<std::string> names{"schema", "seed"};
  for (const ParameterSpec& spec : parameter_specs()) names.emplace_back(spec.name);
  for (const auto& [key, value] : document.items()) {
    if (key == "schema" || key == "seed") continue;
    const auto specs = parameter_specs();
    const auto spec =
        std::find_if(specs.begin(), specs.end(), [&key = key](const ParameterSpec& s) { return s.name == key; });
    if (spec == specs.end())
      throw DataError(file, key, "an unknown key", "a parameter of a specimen",
                      fmt::format("Did you mean '{}'? `incise schema bench` lists all.", nearest_name(key, names)));
    const double number = number_in(document, key, file);
    if (number < spec->low || number > spec->high)
      throw DataError(file, key, fmt::format("{}", number), fmt::format("a number in [{}, {}]", spec->low, spec->high));
    specimen.*spec->member = number;
  }
  return specimen;
}

void write_picture(const std::filesystem::path& file, const ColorPicture& picture) {
  write_atomically(file, [&picture](std::ostream& out) { out << encode_png(picture); });
}

void write_readings(const std::filesystem::path& folder, const Readings& readings, const std::string& name) {
  DicomTags tags;
  tags.patient_id = name;
  tags.series_description = "CT of a virtual specimen";
  write_dicom_series(folder / "ct", readings.ct, tags);
  TriMesh cloud;
  cloud.vertices = readings.cloud_mm;
  write_ply(folder / "scan.ply", cloud);
  const FrameShot& frame = readings.frame;
  write_picture(folder / "rgb.png", frame.color);
  write_atomically(folder / "depth.png", [&frame](std::ostream& out) { out << encode_png(frame.depth); });
  Json camera;
  camera["width"] = frame.camera.width;
  camera["height"] = frame.camera.height;
  camera["fx"] = camera["fy"] = frame.camera.focal_px;
  camera["cx"] = frame.camera.cx;
  camera["cy"] = frame.camera.cy;
  camera["depth_scale"] = frame.depth_unit_mm / 1000.0;
  camera["T_robot_camera"] = matrix(readings.T_robot_camera);
  write_json(folder / "camera.json", camera);
  Json json;
  json["note"] = kVirtual;
  json["specimen"] = name;
  json["ct"] = "ct";
  json["scan"] = "scan.ply";
  json["scan_frame"] = "camera, mm; after clamping and stretching";
  json["rgb"] = "rgb.png";
  json["depth"] = "depth.png";
  json["camera"] = "camera.json";
  json["stretch_mm"] = 20.0;
  json["stretch_force_n"] = readings.stretch_force_n;
  json["stretch_force_noise_percent"] = 5.0;
  if (readings.elasticity_kpa) {
    write_gray(folder / "elasticity.nrrd", *readings.elasticity_kpa);
    json["elasticity_kpa"] = "elasticity.nrrd";
    json["elasticity_noise_percent"] = 20.0;
  }
  write_json(folder / "readings.json", json);
}

void write_truth(const std::filesystem::path& folder, const BenchBody& body) {
  write_json(folder / "specimen.json", specimen_json(body.specimen));
  write_contour_csv(folder / "tumor_edge_rest.csv", body.tumor_edge_rest);
  write_contour_csv(folder / "tumor_edge_stretched.csv", tumor_edge_at(body, body.stretched.positions));
  TetMesh stretched;
  stretched.vertices = body.stretched.positions;
  stretched.tets = body.tissue->mesh.tets;
  stretched.cell_data["toughness_kpa"] = {1, body.toughness_kpa};
  write_vtu(folder / "stretched.vtu", stretched);
  Json json;
  json["note"] = "The truth about a virtual specimen, for tests: nothing of this may reach a planner.";
  json["stretch_force_n"] = body.stretch_force_n;
  json["T_robot_specimen"] = matrix(T_robot_specimen(placement_of(body.specimen)));
  json["T_robot_camera"] = matrix(T_robot_camera(placement_of(body.specimen)));
  write_json(folder / "truth.json", json);
}

}  // namespace incise
