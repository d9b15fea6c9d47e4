#pragma once

#include <incise/bench_kit/readings.hpp>
#include <incise/core/monitor.hpp>
#include <incise/virtual_bench/body.hpp>

namespace incise {

/// Returns the hidden placement of the specimen and of the camera over it.
[[nodiscard]] Placement placement_of(const Specimen& specimen);

/// Takes all readings of a specimen in its holder. The same body gives the same bits.
/// @param has_elasticity  whether to include the elasticity map.
/// @throws Cancelled.
[[nodiscard]] Readings take_readings(const BenchBody& body, bool has_elasticity, Monitor& monitor);

}  // namespace incise
