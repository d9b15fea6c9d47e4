#include "interchange/specimen_text.hpp"

#include <incise/core/error.hpp>
#include <incise/interchange/interchange.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace incise {

std::vector<HeldSet> held_sets(const TissueModel& model) {
  std::map<std::pair<std::size_t, std::array<bool, 3>>, std::vector<std::size_t>> found;
  for (std::size_t v = 0; v < model.holder.size(); ++v) {
    std::map<std::size_t, std::array<bool, 3>> axes_of;
    for (std::size_t i = 0; i < 3; ++i) {
      if (model.is_fixed[v][i]) axes_of[static_cast<std::size_t>(model.holder[v][i])][i] = true;
    }
    for (const auto& [constraint, axes] : axes_of) found[{constraint, axes}].push_back(v);
  }
  std::vector<HeldSet> sets;
  for (auto& [key, vertices] : found) {
    HeldSet set{key.first, key.second, std::move(vertices), Vec3::Zero()};
    if (const auto* displaced = std::get_if<DisplacedConstraint>(&model.constraints[key.first])) {
      set.displacement_mm = displaced->displacement_mm;
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

std::string letters(const std::array<bool, 3>& axes) {
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    if (axes[i]) text += "xyz"[i];
  }
  return text;
}

Stiffness stiffness_of(const TissueModel& model) {
  const auto is_like_first = [&](const LameParameters& l) {
    return l.lambda_kpa == model.lame.front().lambda_kpa && l.mu_kpa == model.lame.front().mu_kpa;
  };
  const LameParameters common = lame_parameters(model.material.youngs_modulus_kpa, model.material.poissons_ratio);
  const bool is_uniform = std::ranges::all_of(model.lame, is_like_first);
  if (is_uniform && is_like_first(common))
    return {{model.material.youngs_modulus_kpa}, {model.material.poissons_ratio}};
  Stiffness stiffness;
  for (const LameParameters& l : model.lame) {
    stiffness.youngs_modulus_kpa.push_back(l.mu_kpa * (3.0 * l.lambda_kpa + 2.0 * l.mu_kpa) /
                                           (l.lambda_kpa + l.mu_kpa));
    stiffness.poissons_ratio.push_back(0.5 * l.lambda_kpa / (l.lambda_kpa + l.mu_kpa));
    if (is_uniform) break;
  }
  return stiffness;
}

std::string text_of(const Vec3& v, const char* separator) {
  return fmt::format("{}{}{}{}{}", v[0], separator, v[1], separator, v[2]);
}

void require_known_law(const TissueModel& model, const char* format) {
  if (model.material.stiffening > 0.0) {
    throw CaseError("case", "specimen.material.stiffening", fmt::format("{}", model.material.stiffening),
                    fmt::format("0 for an export as {}", format),
                    "Neither format has a law that stiffens like this one");
  }
  if (model.fibres.empty()) return;
  throw CaseError("case", "specimen.material.fibre_modulus_kpa",
                  fmt::format("{} kPa", model.material.fibre_modulus_kpa), fmt::format("0 for an export as {}", format),
                  "Neither format has a law with fibres like these");
}

pugi::xml_node with(pugi::xml_node node, std::initializer_list<std::pair<const char*, std::string>> attributes) {
  for (const auto& [name, text] : attributes) node.append_attribute(name) = text.c_str();
  return node;
}

void add_comment(pugi::xml_node parent, const std::string& text) {
  // Two hyphens would end a comment early; titles come from outside.
  std::string safe = text;
  // XML 1.0 allows no control characters except tab, line feed and carriage return.
  std::erase_if(safe,
                [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r'; });
  for (std::size_t at = safe.find("--"); at != std::string::npos; at = safe.find("--")) safe.replace(at, 2, "- -");
  parent.append_child(pugi::node_comment).set_value((" " + safe + " ").c_str());
}

pugi::xml_node add_text(pugi::xml_node parent, const char* name, const std::string& text) {
  pugi::xml_node node = parent.append_child(name);
  node.text().set(text.c_str());
  return node;
}

std::string xml_text(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}

}  // namespace incise
