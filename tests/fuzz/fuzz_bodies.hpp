#pragma once

#include <incise/mechanics/tissue.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace incise::testing {

struct FuzzBody {
  std::string name;
  TissueModel model;
};

/// Blocks regular, irregular, with slivers, thin, long, hollow, of two stiffnesses; with a data folder also SOFA's liver and the tongues of ArtiSynth and of
/// Quadros' simulation. All are held at their lowest end along x.
std::vector<FuzzBody> fuzz_bodies(const std::filesystem::path& data_dir);

/// A block of 30 x 20 x 10 mm on a platform, held at x = 0: what the random paths cut.
TissueModel fuzz_block();

}  // namespace incise::testing
