#pragma once

#include <incise/interchange/interchange.hpp>

#include <pugixml.hpp>

#include <array>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace incise {

/// Vertices that one constraint holds along the same axes. An axis held by two constraints belongs to the first, so no
/// axis of a vertex occurs twice.
struct HeldSet {
  std::size_t constraint = 0;         ///< index in TissueModel::constraints
  std::array<bool, 3> axes{};         ///< whether x, y and z are held
  std::vector<std::size_t> vertices;  ///< ascending
  Vec3 displacement_mm = Vec3::Zero();
};
[[nodiscard]] std::vector<HeldSet> held_sets(const TissueModel& model);

/// Returns the names of the axes set, such as "xz" for {true, false, true}.
[[nodiscard]] std::string letters(const std::array<bool, 3>& axes);

/// Young's modulus (kPa) and Poisson's ratio of each tet; one value each if all tets are alike.
struct Stiffness {
  std::vector<double> youngs_modulus_kpa;
  std::vector<double> poissons_ratio;
  [[nodiscard]] bool varies() const { return youngs_modulus_kpa.size() > 1; }
};
[[nodiscard]] Stiffness stiffness_of(const TissueModel& model);

/// Returns text such as "1.5 -2 0", with the fewest digits that read back as the same doubles.
[[nodiscard]] std::string text_of(const Vec3& v, const char* separator = " ");

/// Refuses laws that neither format has: fibres, and Yeoh's stiffening. @throws CaseError
void require_known_law(const TissueModel& model, const char* format);

/// Gives a node attributes, in this order. @returns the node.
pugi::xml_node with(pugi::xml_node node, std::initializer_list<std::pair<const char*, std::string>> attributes);
void add_comment(pugi::xml_node parent, const std::string& text);
/// Appends an element that contains a text.
pugi::xml_node add_text(pugi::xml_node parent, const char* name, const std::string& text);
[[nodiscard]] std::string xml_text(const pugi::xml_document& document);

}  // namespace incise
