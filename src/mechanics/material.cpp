#include "mechanics/vector_text.hpp"

#include <incise/core/error.hpp>
#include <incise/core/expect.hpp>
#include <incise/mechanics/material.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace incise {

namespace {

bool is_direction(const Vec3& v) { return v.allFinite() && v.norm() > 1e-12; }
bool is_youngs_modulus(double kpa) { return kpa >= kLeastYoungsModulusKpa && kpa <= kMostYoungsModulusKpa; }
constexpr const char* kYoungsModulusRange = "a number in [1e-6, 1e9] kPa";

}  // namespace

std::vector<Problem> validate(const Material& m) {
  std::vector<Problem> violations = problems_of(m);
  if (m.stiffening > 0.0 && m.model != MaterialModel::StableNeoHookean) {
    violations.push_back({"stiffening", fmt::format("{} with model {}", m.stiffening, to_string(m.model)),
                          "0, or model: stable_neo_hookean", "The corotational law is linear"});
  }
  if (m.fibre_stiffening > 0.0 && m.fibre_modulus_kpa == 0.0) {
    violations.push_back(
        {"fibre_stiffening", fmt::format("{} without fibres", m.fibre_stiffening), "0, or fibre_modulus_kpa above 0"});
  }
  return violations;
}

std::vector<Problem> validate(const MaterialField& field, std::size_t tets) {
  std::vector<Problem> violations;
  const auto check = [&](const char* name, const auto& values, const auto& is_good, const auto& text, const char* expected) {
    if (values.empty()) return;
    if (values.size() != tets) {
      violations.push_back(
          {name, fmt::format("{} items", values.size()), fmt::format("one for each of {} tets", tets)});
      return;
    }
    const auto bad = std::find_if_not(values.begin(), values.end(), is_good);
    if (bad == values.end()) return;
    violations.push_back({name, fmt::format("{} at tet {}", text(*bad), bad - values.begin()), expected});
  };
  const auto number = [](double value) { return fmt::format("{}", value); };
  check("youngs_modulus_kpa", field.youngs_modulus_kpa, is_youngs_modulus, number, kYoungsModulusRange);
  check("poissons_ratio", field.poissons_ratio, [](double nu) { return nu >= 0.0 && nu < 0.5; }, number,
        "a number in [0, 0.5)");
  check("toughness", field.toughness, [](double toughness) { return std::isfinite(toughness) && toughness > 0.0; }, number,
        "a finite number above 0");
  check("fibre_direction", field.fibre_directions, is_direction, text_of, "a finite direction");
  return violations;
}

std::optional<Problem> malformed_material_array(const TetMesh& mesh) {
  const std::pair<const char*, int> arrays[] = {
      {"youngs_modulus_kpa", 1}, {"poissons_ratio", 1}, {"fibre_direction", 3}};
  for (const auto& [name, components] : arrays) {
    const auto found = mesh.cell_data.find(name);
    if (found == mesh.cell_data.end() || found->second.components == components) continue;
    return Problem{name, fmt::format("{}", found->second.components),
                   fmt::format("cell data \"{}\" with {} component{}", name, components, components == 1 ? "" : "s")};
  }
  return std::nullopt;
}

MaterialField material_field_of(const TetMesh& mesh) {
  const std::optional<Problem> malformed = malformed_material_array(mesh);
  if (malformed) {
    core_detail::throw_invalid_argument("material_field_of",
                                        fmt::format("expected {}, found {}", malformed->expected, malformed->found));
  }
  MaterialField field;
  const auto find = [&](const char* name) -> const DataArray* {
    const auto found = mesh.cell_data.find(name);
    return found == mesh.cell_data.end() ? nullptr : &found->second;
  };
  if (const DataArray* values = find("youngs_modulus_kpa")) field.youngs_modulus_kpa = values->values;
  if (const DataArray* values = find("poissons_ratio")) field.poissons_ratio = values->values;
  if (const DataArray* values = find("fibre_direction")) {
    for (std::size_t i = 0; i + 2 < values->values.size(); i += 3) {
      field.fibre_directions.emplace_back(values->values[i], values->values[i + 1], values->values[i + 2]);
    }
  }
  return field;
}

LameParameters lame_parameters(double youngs_modulus_kpa, double poissons_ratio) {
  INCISE_REQUIRE(std::isfinite(youngs_modulus_kpa) && youngs_modulus_kpa > 0.0,
                 fmt::format("expected a Young's modulus above 0 kPa, found {}", youngs_modulus_kpa));
  INCISE_REQUIRE(poissons_ratio >= 0.0 && poissons_ratio < 0.5,
                 fmt::format("expected a Poisson's ratio in [0, 0.5), found {}", poissons_ratio));
  LameParameters lame;
  lame.lambda_kpa = youngs_modulus_kpa * poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio));
  lame.mu_kpa = youngs_modulus_kpa / (2.0 * (1.0 + poissons_ratio));
  return lame;
}

}  // namespace incise
