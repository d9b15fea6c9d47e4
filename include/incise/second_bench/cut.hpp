#pragma once

#include <incise/bench_kit/pictures.hpp>
#include <incise/bench_kit/tip_course.hpp>
#include <incise/second_bench/body.hpp>

namespace incise::second_bench {

struct Cut {
  Outcome outcome = Outcome::Success;
  std::shared_ptr<const BodyState> after;
  double mean_force_mn = 0.0;
  double max_force_mn = 0.0;
  std::size_t parted_by_heat = 0;
  std::size_t parted_by_force = 0;
  std::size_t loose = 0;
  double residual = 0.0;
  int steps = 0;
  int iterations = 0;
  double wall_s = 0.0;
};

[[nodiscard]] Cut cut_specimen(const Body& body, const std::vector<TipPose>& course, double power_w, Monitor& monitor);

/// What is seen of tissue from above: the skin, and what a kerf lets see.
[[nodiscard]] SeenTissue seen_from_above(const BodyState& state);
[[nodiscard]] Contour tumor_edge_of(const BodyState& state);

/// The inner edge of a kerf as a person follows it in a picture from straight above: from the tumour's middle outwards
/// to where the skin ends or jumps, one radius a degree, evened over 8 degrees. Bridges of skin narrower than 1 mm do
/// not count. nullopt: the skin inside is not parted from that outside, or it ends more than 16 mm from the tumour.
[[nodiscard]] std::optional<Contour> inner_edge_of(const SeenTissue& seen);

}  // namespace incise::second_bench
