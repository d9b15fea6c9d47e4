#include "verification/sofa_state.hpp"

#include <zlib.h>

#include <sstream>
#include <stdexcept>
#include <string>

namespace incise::testing {
namespace {

std::string unpacked(const std::filesystem::path& path) {
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) throw std::runtime_error("cannot read " + path.string());
  std::string text;
  char buffer[65536];
  for (int count = gzread(file, buffer, sizeof buffer); count > 0; count = gzread(file, buffer, sizeof buffer)) {
    text.append(buffer, static_cast<std::size_t>(count));
  }
  gzclose(file);
  return text;
}

Points points_of(const std::string& line) {
  std::istringstream in(line);
  Points points;
  for (Vec3 p; in >> p[0] >> p[1] >> p[2];) points.push_back(p);
  return points;
}

}  // namespace

SofaState read_sofa_state(const std::filesystem::path& path) {
  std::istringstream in(unpacked(path));
  SofaState state;
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find("X=");
    if (at == std::string::npos) continue;
    (state.first.empty() ? state.first : state.last) = points_of(line.substr(at + 2));
  }
  if (state.first.empty() || state.first.size() != state.last.size()) {
    throw std::runtime_error("expected two lines of positions in " + path.string());
  }
  return state;
}

}  // namespace incise::testing
