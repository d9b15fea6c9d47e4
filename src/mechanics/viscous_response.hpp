#pragma once

#include <incise/mechanics/tissue.hpp>

namespace incise {

/// Returns the viscous memory of a body at rest; empty without viscosity.
[[nodiscard]] ViscousMemory rest_memory(const Material& material, std::size_t tets);

}  // namespace incise
