#include "cloud_input.hpp"

#include <incise/core/isa.hpp>
#include <incise/core/version.hpp>
#include <incise/io/surface_io.hpp>

#include <fmt/format.h>

namespace incise::cli {

PointCloud read_points(const std::filesystem::path& path, std::size_t fewest) {
  PointCloud cloud = cloud_of(read_cloud(path));
  if (cloud.points.size() < fewest) {
    throw DataError(path, "points", fmt::format("{}", cloud.points.size()),
                    fmt::format("at least {} of a surface", fewest));
  }
  return cloud;
}

Vec3 direction_of(const std::vector<double>& numbers, const char* option) {
  const Vec3 direction(numbers.data());
  if (!(direction.norm() > 0.0)) throw CaseError("command line", option, "0 0 0", "a direction");
  return direction;
}

Manifest manifest_of(const CommonOptions& options, std::string settings_json,
                     const std::vector<std::filesystem::path>& inputs, double wall_s) {
  Manifest manifest;
  manifest.version = version();
  manifest.commit = source_commit();
  manifest.command = options.command_line;
  manifest.settings_json = std::move(settings_json);
  manifest.seed = options.seed;
  manifest.threads = options.context().threads;
  manifest.instruction_set = to_string(active_isa());
  for (const std::filesystem::path& path : inputs) {
    manifest.inputs.push_back(
        {path.string(), std::filesystem::is_directory(path) ? sha256_of_folder(path) : sha256_of_file(path)});
  }
  manifest.wall_s = wall_s;
  manifest.machine = machine_description();
  return manifest;
}

}  // namespace incise::cli
