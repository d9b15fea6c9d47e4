#pragma once

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
/// A specimen file in full; with the specimen of all defaults it is what `schema bench --defaults` prints.
[[nodiscard]] nlohmann::ordered_json specimen_json(const Specimen& specimen);

/// Reads a specimen file: `schema` and `seed`, and any parameters that are not to be drawn from the seed.
/// @throws DataError naming the key: not there, unknown (with the nearest valid one), not a number, out of range.
[[nodiscard]] Specimen read_specimen(const std::filesystem::path& file);

/// Writes what a laboratory has of a specimen into an existing folder: ct/ (DICOM), scan.ply, rgb.png, depth.png,
/// camera.json, readings.json and, where taken, elasticity.nrrd. Nothing in it tells a hidden parameter.
/// @throws DataError where a file cannot be written.
void write_readings(const std::filesystem::path& folder, const Readings& readings, const std::string& name);

/// Writes the truth about a specimen: specimen.json, tumor_edge_rest.csv, tumor_edge_stretched.csv, stretched.vtu,
/// truth.json (transforms, pull).
void write_truth(const std::filesystem::path& folder, const BenchBody& body);

/// Writes a photograph as PNG, all or nothing.
void write_picture(const std::filesystem::path& file, const ColorPicture& picture);

}  // namespace incise
