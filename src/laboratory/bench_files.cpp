#include <incise/core/described_json.hpp>
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
constexpr const char* kFirstSchema = "incise.specimen/1";
constexpr const char* kSecondSchema = "incise.specimen/2";
constexpr const char* kTruth = "The truth about a virtual specimen, for tests. No part of it may reach a planner.";
constexpr const char* kVirtual = "Virtual: computed by incise's bench, no real tissue.";

template <class S>
std::string spread_text(const HiddenParameter<S>& spec) {
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

/// A key of a specimen file beside its parameters.
struct WholeNumber {
  const char* key;
  const char* meaning;
};
constexpr WholeNumber kSeed{
    "seed", "Seed of the shape, of the fields inside, of all noise and of every parameter that is not given."};
constexpr WholeNumber kSeries{"series", "Seed of the hand-eye error, which the specimens of a series share."};

template <class Specimen, class Parameters>
std::string schema_text(const char* name, const std::vector<WholeNumber>& numbers, const Parameters& parameters) {
  const Specimen defaults{};
  Json schema;
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = name;
  schema["description"] =
      "A virtual specimen: all that is hidden from the planner. Parameters that are not given are drawn from the "
      "seed.";
  schema["type"] = "object";
  Json& properties = schema["properties"];
  properties["schema"] = {{"const", name}};
  schema["required"] = {"schema"};
  for (const WholeNumber& number : numbers) {
    properties[number.key] = {{"type", "integer"}, {"minimum", 0}, {"description", number.meaning}};
    schema["required"].push_back(number.key);
  }
  for (const auto& spec : parameters) {
    properties[std::string(spec.name)] = {{"type", "number"},
                                          {"minimum", spec.low},
                                          {"maximum", spec.high},
                                          {"default", defaults.*spec.member},
                                          {"description", spec.meaning},
                                          {"x-spread", spread_text(spec)},
                                          {"x-source", spec.source},
                                          {"x-shows-in", spec.shows_in}};
    if constexpr (requires { spec.factor; })
      properties[std::string(spec.name)]["x-factor"] = spec.factor ? Json(to_string(*spec.factor)) : Json(nullptr);
  }
  schema["additionalProperties"] = false;
  return json_text(schema);
}

std::uint64_t whole_number_in(const Json& document, const char* key, const std::filesystem::path& file) {
  const auto found = document.find(key);
  if (found == document.end() || !found->is_number_unsigned())
    throw DataError(file, key, found == document.end() ? "nothing" : found->dump(), "a whole number, 0 or above");
  return found->get<std::uint64_t>();
}

/// Sets the parameters that a file gives.
/// @param schema  name of such a file for `incise schema`. @param names  its other keys.
template <class Specimen, class Parameters>
void read_parameters(const Json& document, const char* schema, std::vector<std::string> names,
                     const Parameters& parameters, const std::filesystem::path& file, Specimen& specimen) {
  const std::size_t known = names.size();
  for (const auto& spec : parameters) names.emplace_back(spec.name);
  for (const auto& [key, value] : document.items()) {
    const auto found = std::find(names.begin(), names.end(), key);
    if (found == names.end()) {
      const std::string meant = did_you_mean(key, names);
      throw DataError(file, key, "an unknown key", "a parameter of a specimen",
                      fmt::format("{}{}`incise schema {}` lists all.", meant, meant.empty() ? "" : " ", schema));
    }
    const auto place = static_cast<std::size_t>(found - names.begin());
    if (place < known) continue;
    const auto& spec = parameters[place - known];
    if (!value.is_number() || !std::isfinite(value.template get<double>()))
      throw DataError(file, key, value.dump(), "a finite number");
    const double number = value.template get<double>();
    if (number < spec.low || number > spec.high)
      throw DataError(file, key, fmt::format("{}", number), fmt::format("a number in [{}, {}]", spec.low, spec.high));
    specimen.*spec.member = number;
  }
}

/// Writes what the truths of both laboratories have in common.
template <class Body>
void write_common_truth(const std::filesystem::path& folder, const Body& body, const Contour& edge_rest,
                        const Contour& edge_stretched) {
  write_json(folder / "specimen.json", specimen_json(body.specimen));
  write_contour_csv(folder / "tumor_edge_rest.csv", edge_rest);
  write_contour_csv(folder / "tumor_edge_stretched.csv", edge_stretched);
  const Placement placement = placement_of(body.specimen);
  write_json(folder / "truth.json", {{"note", kTruth},
                                     {"stretch_force_n", body.stretch_force_n},
                                     {"T_robot_specimen", to_json(T_robot_specimen(placement))},
                                     {"T_robot_camera", to_json(T_robot_camera(placement))}});
}

}  // namespace

std::string bench_schema_json() {
  return schema_text<Specimen>(kFirstSchema, {kSeed}, parameter_specs());
}

std::string second_bench_schema_json() {
  return schema_text<second_bench::Specimen>(kSecondSchema, {kSeed, kSeries}, second_bench::parameters());
}

Json specimen_json(const Specimen& specimen) {
  Json json;
  json["schema"] = kFirstSchema;
  json["seed"] = specimen.seed;
  for (const ParameterSpec& spec : parameter_specs()) json[std::string(spec.name)] = specimen.*spec.member;
  return json;
}

Json specimen_json(const second_bench::Specimen& specimen) {
  Json json;
  json["schema"] = kSecondSchema;
  json["seed"] = specimen.seed;
  json["series"] = specimen.series;
  for (const auto& spec : second_bench::parameters()) json[std::string(spec.name)] = specimen.*spec.member;
  return json;
}

Specimen read_specimen(const std::filesystem::path& file) {
  const Json document = read_json(file);
  require_schema(document, kFirstSchema, file);
  Specimen specimen = draw_specimen(whole_number_in(document, kSeed.key, file));
  read_parameters(document, "bench", {"schema", kSeed.key}, parameter_specs(), file, specimen);
  return specimen;
}

second_bench::Specimen read_second_specimen(const std::filesystem::path& file) {
  const Json document = read_json(file);
  require_schema(document, kSecondSchema, file);
  second_bench::Specimen specimen =
      second_bench::draw_specimen(whole_number_in(document, kSeed.key, file),
                                  whole_number_in(document, kSeries.key, file), second_bench::all_factors());
  read_parameters(document, "bench2", {"schema", kSeed.key, kSeries.key}, second_bench::parameters(), file, specimen);
  return specimen;
}

int bench_of(const std::filesystem::path& file) {
  const Json document = read_json(file);
  if (document.is_object() && document.value("schema", Json()) == kSecondSchema) return 2;
  if (document.is_object() && document.value("schema", Json()) == kFirstSchema) return 1;
  throw DataError(file, "schema", document.is_object() ? document.value("schema", Json()).dump() : document.type_name(),
                  fmt::format("\"{}\" or \"{}\"", kFirstSchema, kSecondSchema));
}

void write_picture(const std::filesystem::path& file, const ColorPicture& picture) {
  write_atomically(file, [&picture](std::ostream& out) { out << encode_png(picture); });
}

void write_readings(const std::filesystem::path& folder, const Readings& readings, const std::string& name,
                    const nlohmann::ordered_json& prescription) {
  write_dicom_series(folder / "ct", readings.ct,
                     {.patient_id = name, .series_description = "CT of a virtual specimen"});
  write_ply(folder / "scan.ply", TriMesh{.vertices = readings.cloud_mm});
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
  camera["T_robot_camera"] = to_json(readings.T_robot_camera);
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
  json["stretch_mm"] = kDrawnMm;
  json["stretch_force_n"] = readings.stretch_force_n;
  if (readings.stretch_force_noise_percent) json["stretch_force_noise_percent"] = *readings.stretch_force_noise_percent;
  if (readings.elasticity_kpa) {
    write_gray(folder / "elasticity.nrrd", *readings.elasticity_kpa);
    json["elasticity_kpa"] = "elasticity.nrrd";
    json["elasticity_noise_percent"] = 20.0;
  }
  if (!prescription.is_null()) json["prescription"] = prescription;
  write_json(folder / "readings.json", json);
}

void write_truth(const std::filesystem::path& folder, const BenchBody& body) {
  write_common_truth(folder, body, body.tumor_edge_rest, tumor_edge_at(body, body.stretched.positions));
  TetMesh stretched;
  stretched.vertices = body.stretched.positions;
  stretched.tets = body.tissue->mesh.tets;
  stretched.cell_data["toughness_kpa"] = {1, body.toughness_kpa};
  write_vtu(folder / "stretched.vtu", stretched);
}

void write_truth(const std::filesystem::path& folder, const second_bench::Body& body) {
  write_common_truth(folder, body, second_bench::tumor_edge_rest_of(*body.state),
                     second_bench::tumor_edge_of(*body.state));
}

}  // namespace incise
