#include "second_bench/brick_tissue.hpp"

#include <algorithm>
#include <cmath>

namespace incise::second_bench {
namespace {

/// Replaces eight corner values by their modes: entry m is the sum over corners, signed by the corner's side along each
/// axis whose bit is in m (bit 0: x). Entries 1, 2, 4 are gradients; 3, 5, 6, 7 are bending modes.
inline void mix(std::array<Lanes, 8>& value) {
  for (std::size_t bit = 1; bit < 8; bit *= 2)
    for (std::size_t c = 0; c < 8; ++c) {
      if ((c & bit) != 0) continue;
      const Lanes low = value[c], high = value[c | bit];
      value[c] = low + high;
      value[c | bit] = high - low;
    }
}
/// Replaces eight values of modes by corner values: the transpose of mix().
inline void spread(std::array<Lanes, 8>& value) {
  for (std::size_t bit = 1; bit < 8; bit *= 2)
    for (std::size_t c = 0; c < 8; ++c) {
      if ((c & bit) != 0) continue;
      const Lanes sum = value[c], difference = value[c | bit];
      value[c] = sum - difference;
      value[c | bit] = sum + difference;
    }
}

inline Lanes larger(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}
inline Lanes size_of(const Lanes& a) {
  return a < 0.0F ? -a : a;
}

/// Deformation and the quantities derived from it.
struct Strain {
  std::array<std::array<Lanes, 8>, 3> modes;  // of the positions
  std::array<std::array<Lanes, 3>, 3> f;      // deformation gradient [component][axis at rest]
  std::array<std::array<Lanes, 3>, 3> cofactor;
  std::array<Lanes, 3> fibre;    // F a
  Lanes i1, j, i4, shape, pull;  // shape: 2 dW/dI1; pull: 2 dW/dI4
};

inline void find_strain(const BrickTissue& tissue, const Octet& octet, Strain& s) {
  for (std::size_t c = 0; c < 8; ++c)
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto& p = tissue.position[static_cast<std::size_t>(octet.node[c][static_cast<std::size_t>(lane)])];
      s.modes[0][c][lane] = p[0];
      s.modes[1][c][lane] = p[1];
      s.modes[2][c][lane] = p[2];
    }
  for (std::size_t i = 0; i < 3; ++i) {
    mix(s.modes[i]);
    for (std::size_t a = 0; a < 3; ++a) s.f[i][a] = 0.25F * octet.inverse_size[a] * s.modes[i][1U << a];
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, a1 = (a + 1) % 3, a2 = (a + 2) % 3;
      s.cofactor[i][a] = s.f[i1][a1] * s.f[i2][a2] - s.f[i1][a2] * s.f[i2][a1];
    }
  s.j = s.f[0][0] * s.cofactor[0][0] + s.f[0][1] * s.cofactor[0][1] + s.f[0][2] * s.cofactor[0][2];
  s.i1 = s.j * 0.0F;
  s.i4 = s.i1;
  for (std::size_t i = 0; i < 3; ++i) {
    s.fibre[i] = s.f[i][0] * octet.fibre_axis[0] + s.f[i][1] * octet.fibre_axis[1] + s.f[i][2] * octet.fibre_axis[2];
    s.i4 += s.fibre[i] * s.fibre[i];
    for (std::size_t a = 0; a < 3; ++a) s.i1 += s.f[i][a] * s.f[i][a];
  }
  s.shape = 2.0F * octet.c1 + 4.0F * octet.c2 * (s.i1 - 3.0F);
  s.pull = 2.0F * octet.fibre * (s.i4 - 1.0F);
  s.pull = s.pull > 0.0F ? s.pull : s.pull * 0.0F;
}

constexpr std::array<std::array<std::size_t, 3>, 3> kAt{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};  // place in Octet::past

/// Second Piola-Kirchhoff stress that a sudden change of shape adds, divided by the viscous ratio: 2 c1 (C - I) and the
/// terms of stiffening and fibres.
inline std::array<Lanes, 6> sudden_stress(const Octet& octet, const Strain& s) {
  const auto& a = octet.fibre_axis;
  const Lanes more = s.shape - 4.0F * octet.c1;  // 2 dW/dI1 - 2 c1, less the 2 c1 of I
  std::array<Lanes, 6> stress;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j) {
      const Lanes c = s.f[0][i] * s.f[0][j] + s.f[1][i] * s.f[1][j] + s.f[2][i] * s.f[2][j];
      Lanes value = 2.0F * octet.c1 * c + s.pull * a[i] * a[j];
      if (i == j) value += more;
      stress[kAt[i][j]] = value;
    }
  return stress;
}

template <class Visit>
void for_each_octet(BrickTissue& tissue, Visit visit) {
  for (Octet& octet : tissue.octets) {
    Strain strain;
    find_strain(tissue, octet, strain);
    visit(octet, strain);
  }
}

}  // namespace

void set_tissue_forces(BrickTissue& tissue, float viscous_gain, float weight_mn_mm3) {
  std::fill(tissue.force.begin(), tissue.force.end(), std::array<float, 4>{});
  for_each_octet(tissue, [&](const Octet& octet, Strain& s) {
    // First Piola-Kirchhoff stress: F S + volumetric part.
    const auto& axis = octet.fibre_axis;
    std::array<Lanes, 6> t = sudden_stress(octet, s);
    for (std::size_t n = 0; n < 6; ++n) t[n] = viscous_gain * t[n] + octet.past[n];
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a; b < 3; ++b) t[kAt[a][b]] += s.pull * axis[a] * axis[b];
    for (std::size_t a = 0; a < 3; ++a) t[a] += s.shape;
    const Lanes pressure = octet.lambda * (s.j - 1.0F) - 2.0F * octet.c1;
    const Lanes bend = -octet.hourglass * s.shape;
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<Lanes, 8>& g = s.modes[i];
      for (std::size_t a = 0; a < 3; ++a) {
        const Lanes stress = s.f[i][0] * t[kAt[0][a]] + s.f[i][1] * t[kAt[1][a]] + s.f[i][2] * t[kAt[2][a]] +
                             pressure * s.cofactor[i][a];
        g[1U << a] = -0.25F * octet.volume * octet.inverse_size[a] * stress;
      }
      for (const std::size_t m : {3U, 5U, 6U, 7U}) g[m] *= bend;
      g[0] = i == 2 ? -0.125F * weight_mn_mm3 * octet.volume : octet.volume * 0.0F;
      spread(g);
    }
    for (std::size_t c = 0; c < 8; ++c)
      for (int lane = 0; lane < kLanes; ++lane) {
        auto& f = tissue.force[static_cast<std::size_t>(octet.node[c][static_cast<std::size_t>(lane)])];
        f[0] += s.modes[0][c][lane];
        f[1] += s.modes[1][c][lane];
        f[2] += s.modes[2][c][lane];
      }
  });
}

void bound_masses(BrickTissue& tissue, float viscous_gain) {
  std::fill(tissue.mass.begin(), tissue.mass.end(), 0.0F);
  for_each_octet(tissue, [&](const Octet& octet, const Strain& s) {
    Lanes cofactor = s.j * 0.0F;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t a = 0; a < 3; ++a) cofactor += s.cofactor[i][a] * s.cofactor[i][a];
    Lanes past = s.j * 0.0F;
    for (const Lanes& stress : octet.past) past += size_of(stress);
    const Lanes pressure = size_of(octet.lambda * (s.j - 1.0F) - 2.0F * octet.c1);
    const Lanes bound =
        octet.lambda * cofactor +
        (1.0F + viscous_gain) * (s.shape + 8.0F * octet.c2 * s.i1 + 4.0F * octet.fibre * s.i4 + s.pull) +
        viscous_gain * 8.0F * octet.c1 * s.i1 + pressure * (1.0F + 0.5F * s.i1) + past;
    const Lanes fine = larger(larger(octet.inverse_size[0], octet.inverse_size[1]), octet.inverse_size[2]);
    const Lanes mass = kMassShare * (0.5F * bound * octet.volume * fine * fine + 8.0F * octet.hourglass * s.shape);
    for (std::size_t c = 0; c < 8; ++c)
      for (int lane = 0; lane < kLanes; ++lane)
        tissue.mass[static_cast<std::size_t>(octet.node[c][static_cast<std::size_t>(lane)])] += mass[lane];
  });
}

float begin_step(BrickTissue& tissue, float ratio, float time_s, float step_s) {
  const float share = step_s / time_s;
  const float decay = std::exp(-share);
  const float gain = ratio * (1.0F - decay) / share;
  for_each_octet(tissue, [&](Octet& octet, const Strain& s) {
    // Between steps `past` is Q; within a step it is decay * Q - gain * S, with S at the beginning of the step.
    const std::array<Lanes, 6> sudden = sudden_stress(octet, s);
    for (std::size_t n = 0; n < 6; ++n) {
      octet.past[n] = decay * octet.past[n] - gain * sudden[n];
    }
  });
  return gain;
}

void end_step(BrickTissue& tissue, float gain) {
  for_each_octet(tissue, [&](Octet& octet, const Strain& s) {
    const std::array<Lanes, 6> sudden = sudden_stress(octet, s);
    for (std::size_t n = 0; n < 6; ++n) octet.past[n] += gain * sudden[n];
  });
}

void set_viscous_since(BrickTissue& tissue, float ratio, float time_s, float elapsed_s) {
  const float left = ratio * std::exp(-elapsed_s / time_s);
  for_each_octet(tissue, [&](Octet& octet, const Strain& s) {
    const std::array<Lanes, 6> sudden = sudden_stress(octet, s);
    for (std::size_t n = 0; n < 6; ++n) octet.past[n] = left * sudden[n];
  });
}

}  // namespace incise::second_bench
