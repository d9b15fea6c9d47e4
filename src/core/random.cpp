#include <incise/core/error.hpp>
#include <incise/core/random.hpp>

#include <cmath>

namespace incise {

double Random::uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0.0;
  double v = 0.0;
  double s = 0.0;
  do {
    u = uniform(-1.0, 1.0);
    v = uniform(-1.0, 1.0);
    s = u * u + v * v;
  } while (s >= 1.0 || s == 0.0);
  const double scale = std::sqrt(-2.0 * std::log(s) / s);
  spare_ = v * scale;
  has_spare_ = true;
  return u * scale;
}

std::uint64_t Random::below(std::uint64_t count) {
  INCISE_REQUIRE(count > 0, "expected a count above 0, found 0");
  // Draws above the largest multiple of count are rejected, so that every value is equally likely.
  const std::uint64_t limit = engine_.max() - engine_.max() % count;
  std::uint64_t draw = 0;
  do {
    draw = engine_();
  } while (draw >= limit);
  return draw % count;
}

}  // namespace incise
