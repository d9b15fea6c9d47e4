#pragma once

#include <incise/interchange/interchange.hpp>

#include <pugixml.hpp>

#include <array>
#include <string>
#include <vector>

namespace incise {

/// Vertices that one constraint holds along the same axes. An axis that two constraints hold belongs to the first, so
/// no axis of a vertex occurs twice.
struct HeldSet {
  std::size_t constraint = 0;
  std::array<bool, 3> axes{};
  std::vector<std::size_t> vertices;  ///< ascending
  Vec3 displacement_mm = Vec3::Zero();
};
[[nodiscard]] std::vector<HeldSet> held_sets(const TissueModel& model);

/// "xz" of {true, false, true}.
[[nodiscard]] std::string letters(const std::array<bool, 3>& axes);

/// Young's modulus (kPa) and Poisson's ratio of each tet; one item where all are alike.
struct Stiffness {
  std::vector<double> youngs_modulus_kpa;
  std::vector<double> poissons_ratio;
  [[nodiscard]] bool varies() const { return youngs_modulus_kpa.size() > 1; }
};
[[nodiscard]] Stiffness stiffness_of(const TissueModel& model);

/// "1.5 -2 0" with the fewest digits that read back as the same doubles.
[[nodiscard]] std::string text_of(const Vec3& v, const char* separator = " ");

/// @throws CaseError for what neither format has: fibres, and Yeoh's stiffening.
void require_known_law(const TissueModel& model, const char* format);

void add_comment(pugi::xml_node parent, const std::string& text);
/// An element with a text.
pugi::xml_node add_text(pugi::xml_node parent, const char* name, const std::string& text);
[[nodiscard]] std::string xml_text(const pugi::xml_document& document);

}  // namespace incise
