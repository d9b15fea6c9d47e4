#include "verification/check.hpp"

namespace incise {
namespace {

struct NamedLaw {
  const char* name;
  MaterialModel model;
  VolumeTreatment volume;
};
constexpr std::array<NamedLaw, 4> kLaws{
    {{"corotational", MaterialModel::Corotational, VolumeTreatment::PerTet},
     {"corotational_averaged", MaterialModel::Corotational, VolumeTreatment::Averaged},
     {"neo_hookean", MaterialModel::StableNeoHookean, VolumeTreatment::PerTet},
     {"neo_hookean_averaged", MaterialModel::StableNeoHookean, VolumeTreatment::Averaged}}};

/// Adds one entry per law, "patch_corotational" and so on.
template <class Check>
void add_for_each_law(std::vector<CheckEntry>& table, const std::string& name, double poissons_ratio, Check check) {
  for (const NamedLaw& named : kLaws) {
    const Material material{.model = named.model, .volume = named.volume, .poissons_ratio = poissons_ratio};
    table.push_back({name + "_" + named.name, [=](const CheckContext& context) { return check(context, material); }});
  }
}

/// Returns tissue with fibres along x of twice its Young's modulus.
Material with_fibres() {
  Material material{.poissons_ratio = 0.45};
  material.fibre_modulus_kpa = 2.0 * material.youngs_modulus_kpa;
  material.fibre_direction = Vec3::UnitX();
  return material;
}

std::vector<CheckEntry> make_table() {
  std::vector<CheckEntry> table;
  add_for_each_law(table, "patch", 0.45, patch_test);
  table.push_back({"patch_fibres", [](const CheckContext& context) { return patch_test(context, with_fibres()); }});
  add_for_each_law(table, "uniaxial", 0.49, uniaxial_stretch);
  add_for_each_law(table, "equibiaxial", 0.3, equibiaxial_stretch);
  add_for_each_law(table, "shear", 0.49, simple_shear);
  table.push_back(
      {"fibres_uniaxial", [](const CheckContext& context) { return uniaxial_stretch(context, with_fibres()); }});
  table.push_back({"cantilever_rate", cantilever_rate});
  table.push_back({"cantilever_tip", cantilever_tip});
  table.push_back({"cooks_membrane_rate", cooks_membrane_rate});
  const std::array<std::pair<const char*, MaterialModel>, 2> models{
      {{"corotational", MaterialModel::Corotational}, {"neo_hookean", MaterialModel::StableNeoHookean}}};
  for (const auto& [name, model] : models) {
    table.push_back({std::string("locking_standard_") + name,
                     [=](const CheckContext& context) { return locking_of_the_standard_tet(context, model); }});
    table.push_back({std::string("locking_averaged_") + name,
                     [=](const CheckContext& context) { return no_locking_when_averaged(context, model); }});
  }
  table.push_back({"thick_sphere_rate", thick_sphere_rate});
  table.push_back({"thick_sphere_displacement", thick_sphere_displacement});
  table.push_back({"elastica_tip", elastica_tip});
  table.push_back({"vibration_period", vibration_period});
  table.push_back({"relaxation_prony", relaxation_of_one_prony_term});
  table.push_back({"vertex_order", vertex_order});
  table.push_back({"support_penetration", support_penetration});
  table.push_back({"support_balance", support_balance});
  table.push_back({"support_pull", support_pull});
  return table;
}

}  // namespace

const std::vector<CheckEntry>& check_table() {
  static const std::vector<CheckEntry> table = make_table();
  return table;
}

}  // namespace incise
