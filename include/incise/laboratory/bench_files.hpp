#pragma once

#include <incise/second_bench/readings.hpp>
#include <incise/virtual_bench/pictures.hpp>
#include <incise/virtual_bench/readings.hpp>
#include <incise/virtual_bench/specimen.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// Returns the JSON Schema of a specimen file (`incise.specimen/1`): every hidden parameter with unit, spread, source
/// and the reading that reveals it (`x-spread`, `x-source`, `x-shows-in`).
[[nodiscard]] std::string bench_schema_json();
/// As bench_schema_json for the second laboratory (`incise.specimen/2`), with the factor of each parameter
/// (`x-factor`).
[[nodiscard]] std::string second_bench_schema_json();
/// Returns a complete specimen file; for a specimen with all defaults, the output of `schema bench --defaults`.
[[nodiscard]] nlohmann::ordered_json specimen_json(const Specimen& specimen);
[[nodiscard]] nlohmann::ordered_json specimen_json(const second_bench::Specimen& specimen);

/// Reads a specimen file: `schema`, `seed`, and the parameters that are given instead of drawn from the seed.
/// @throws DataError naming the key: missing, unknown (with the nearest valid one), not a number, out of range.
[[nodiscard]] Specimen read_specimen(const std::filesystem::path& file);
/// As read_specimen for the second laboratory; the file also has `series`. All factors vary for the drawn parameters.
[[nodiscard]] second_bench::Specimen read_second_specimen(const std::filesystem::path& file);
/// Returns the laboratory of the specimen in a file: 1 or 2. @throws DataError for another schema.
[[nodiscard]] int bench_of(const std::filesystem::path& file);

/// Writes the readings of a specimen into an existing folder: ct/ (DICOM), scan.ply, rgb.png, depth.png, camera.json,
/// readings.json and, where taken, elasticity.nrrd. They contain no hidden parameter.
/// @param prescription  the surgeon's: plan fields of a case and the power; null: none is written.
/// @throws DataError where a file cannot be written.
void write_readings(const std::filesystem::path& folder, const Readings& readings, const std::string& name,
                    const nlohmann::ordered_json& prescription);

/// Writes the truth about a specimen into an existing folder: specimen.json, tumor_edge_rest.csv,
/// tumor_edge_stretched.csv, stretched.vtu, truth.json (transforms, pull).
void write_truth(const std::filesystem::path& folder, const BenchBody& body);
/// As above for the second laboratory, without stretched.vtu.
void write_truth(const std::filesystem::path& folder, const second_bench::Body& body);

/// Writes a photograph as PNG, all or nothing.
void write_picture(const std::filesystem::path& file, const ColorPicture& picture);

}  // namespace incise
