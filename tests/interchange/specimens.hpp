#pragma once

#include "support/refusal.hpp"

#include <incise/core/error.hpp>
#include <incise/interchange/interchange.hpp>

#include <pugixml.hpp>

#include <cctype>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace incise::testing {

inline constexpr double kGravity = -9810.0;

inline Region slab_x(double at) {
  return BoxRegion{Box3(Vec3(at - 1e-3, -1e3, -1e3), Vec3(at + 1e-3, 1e3, 1e3))};
}

/// A block with coordinates that no short decimal is equal to.
inline TetMesh odd_block() {
  TetMesh mesh = make_block(Vec3(30, 20, 10), {3, 2, 2});
  for (Vec3& p : mesh.vertices) p = p * (1.0 / 3.0) + Vec3(0.1, 1e-7 / 7.0, -2.0 / 3.0);
  return mesh;
}

/// Every kind of constraint that both formats have: the block lies along x from 0.1 to 10.1.
inline std::vector<Constraint> every_kind() {
  SupportConstraint platform{Vec3(0, 0, -0.7), Vec3(0, 0, 2)};
  return {FixedConstraint{slab_x(0.1), {true, true, true}},
          FixedConstraint{slab_x(0.1 + 10.0 / 3.0), {true, false, true}},
          DisplacedConstraint{slab_x(10.1), Vec3(1.5, -0.25, 0.0)}, platform,
          TractionConstraint{PlaneRegion{Vec3(0, 0, 8.0 / 3.0 - 1e-6), Vec3::UnitZ(), {}}, Vec3(0.0, 0.1, 0.3)}};
}

inline TissueModel specimen(const Material& material = {}, std::vector<Constraint> constraints = every_kind(),
                            const MaterialField& field = {}) {
  return make_tissue_model(odd_block(), material, std::move(constraints), Vec3(0, 0, kGravity), field);
}

/// A sheet under the block, as a holder.
inline SupportConstraint holder() {
  TriMesh sheet;
  sheet.vertices = {Vec3(-50, -50, -1), Vec3(50, -50, -1), Vec3(50, 50, -1.25), Vec3(-50, 50, -1.25)};
  sheet.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{0}, VertexId{2}, VertexId{3}}};
  SupportConstraint support{.holder = std::make_shared<HolderSurface>(HolderSurface{"holder.stl", sheet})};
  return support;
}

/// All numbers of a text, whatever stands between them; @throws on anything else.
inline std::vector<double> numbers(const std::string& text) {
  std::vector<double> found;
  const char* at = text.c_str();
  while (*at != '\0') {
    if (std::isspace(static_cast<unsigned char>(*at)) != 0 || *at == ',') {
      ++at;
      continue;
    }
    char* end = nullptr;
    found.push_back(std::strtod(at, &end));
    if (end == at) throw std::runtime_error("not a number: " + std::string(at).substr(0, 20));
    at = end;
  }
  return found;
}

inline void parse(const std::string& text, pugi::xml_document& document) {
  const pugi::xml_parse_result result = document.load_string(text.c_str(), pugi::parse_default | pugi::parse_comments);
  if (!result) throw std::runtime_error(result.description());
}

/// All comments of a document in one text.
inline std::string comments(pugi::xml_node node) {
  std::string text;
  for (pugi::xml_node child : node.children()) {
    if (child.type() == pugi::node_comment) text += child.value();
    text += comments(child);
  }
  return text;
}

template <class Make>
std::string refused_field(const Make& make) {
  const auto error = error_of<CaseError>(make);
  return error ? error->field() : "accepted";
}

}  // namespace incise::testing
