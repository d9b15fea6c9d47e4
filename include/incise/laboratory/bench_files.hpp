#pragma once

#include <incise/second_bench/readings.hpp>
#include <incise/virtual_bench/pictures.hpp>
#include <incise/virtual_bench/readings.hpp>
#include <incise/virtual_bench/specimen.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace incise {

/// The JSON Schema of a specimen file (`incise.specimen/1`): every hidden parameter with unit, spread, source and the
/// reading through which it shows (`x-spread`, `x-source`, `x-shows-in`).
[[nodiscard]] std::string bench_schema_json();
/// The same of the second laboratory (`incise.specimen/2`), with the factor of each parameter (`x-factor`).
[[nodiscard]] std::string second_bench_schema_json();
/// A specimen file in full; with the specimen of all defaults it is what `schema bench --defaults` prints.
[[nodiscard]] nlohmann::ordered_json specimen_json(const Specimen& specimen);
[[nodiscard]] nlohmann::ordered_json specimen_json(const second_bench::Specimen& specimen);

/// Reads a specimen file: `schema` and `seed`, and any parameters that are not to be drawn from the seed.
/// @throws DataError naming the key: not there, unknown (with the nearest valid one), not a number, out of range.
[[nodiscard]] Specimen read_specimen(const std::filesystem::path& file);
/// The same of the second laboratory; `series`, too. Parameters that are not given are drawn, every factor varying.
[[nodiscard]] second_bench::Specimen read_second_specimen(const std::filesystem::path& file);
/// Which laboratory's specimen a file holds: 1 or 2. @throws DataError for another schema.
[[nodiscard]] int bench_of(const std::filesystem::path& file);

/// Writes what a laboratory has of a specimen into an existing folder: ct/ (DICOM), scan.ply, rgb.png, depth.png,
/// camera.json, readings.json and, where taken, elasticity.nrrd. Nothing in it tells a hidden parameter.
/// @throws DataError where a file cannot be written.
/// @param prescription  what the surgeon asks for: plan fields of a case and the power; null: nothing is said.
void write_readings(const std::filesystem::path& folder, const Readings& readings, const std::string& name,
                    const nlohmann::ordered_json& prescription);

/// Writes the truth about a specimen: specimen.json, tumor_edge_rest.csv, tumor_edge_stretched.csv, stretched.vtu,
/// truth.json (transforms, pull).
void write_truth(const std::filesystem::path& folder, const BenchBody& body);
/// The same of the second laboratory, without stretched.vtu.
void write_truth(const std::filesystem::path& folder, const second_bench::Body& body);

/// Writes a photograph as PNG, all or nothing.
void write_picture(const std::filesystem::path& file, const ColorPicture& picture);

}  // namespace incise
