#include <incise/mechanics/statics.hpp>
#include <incise/storage/case_file.hpp>

#include <iostream>

// Clamps a block of tissue at its back and pulls its front forward by 5 mm.
int main() {
  using namespace incise;
  const TissueModel model = make_tissue_model(make_block(Vec3(20, 60, 20), {2, 6, 2}), Material{},
                                              {FixedConstraint{EndRegion{Vec3::UnitY(), 5.0}, {true, true, true}},
                                               DisplacedConstraint{EndRegion{-Vec3::UnitY(), 5.0}, Vec3(0, -5, 0)}});
  Workers workers;
  Monitor quiet;
  const StaticResult result = solve_static(model, StaticSettings{}, workers, quiet);
  std::cout << to_string(result.outcome) << ": greatest displacement " << result.max_displacement_mm
            << " mm; a case file has " << settings_of(CaseFile{}).size() << " settings\n";
  return result.outcome == Outcome::Success ? 0 : 1;
}
