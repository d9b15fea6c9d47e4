#include <incise/workflow/study.hpp>

#include <fmt/format.h>

namespace incise {

std::string explain_stretch(const StaticResult& stretched) {
  if (stretched.outcome == Outcome::Success) return "";
  if (stretched.outcome == Outcome::Cancelled) return "stopped: the stretch was interrupted";
  const std::string found =
      stretched.outcome == Outcome::ElementInverted
          ? fmt::format(
                "the tissue came to rest, but {} of its tets turned inside out: it is stretched farther than the mesh "
                "can follow",
                stretched.inverted_tets)
          : fmt::format("no equilibrium of the held tissue was found in {} iterations", stretched.iterations);
  return fmt::format(
      "stopped: {}. A smaller displacement_mm, wider held regions (specimen.constraints) or a finer mesh may help",
      found);
}

}  // namespace incise
