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

}  // namespace incise::cli
