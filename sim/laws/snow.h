#pragma once
/// The paper's snow: it yields where a stretch leaves [1 - theta_c, 1 + theta_s], stiffens as it
/// packs, softens as it is torn.

#include "sim/laws/stretches.h"

namespace neve::sim::laws::snow {

struct Projection {
  static constexpr bool yields = true;

  /// One stretch, clamped to [1 - theta_c, 1 + theta_s]; what is cut off goes into J_P (the paper,
  /// section 7, equations 11 and 12). A negative stretch, of a particle turned inside out, is
  /// turned back: it counts by its size, so that J_P stays positive.
  template <class V>
  NEVE_INLINE static V clamp_stretch(MaterialLanes<V>& m, V s, V& cut) {
    const V clamped = smaller_lanes(larger_lanes(s, m.lo()), m.hi());
    cut = s != clamped ? cut * (absolute_lanes(s) / clamped) : cut;
    return clamped;
  }

  /// J_P after a projection that cut off `cut`, where it did: J_P' = J_P |s1 s2 s3| / (s1' s2'
  /// s3'), held in the range of the material. Beyond the range F_P is forgotten, F_E and its stress
  /// are not: snow yields on at constant stiffness. NaN stays NaN.
  template <class V>
  NEVE_INLINE static void move_J_P(MaterialLanes<V>& m, V cut, MaskOf<V> is_cut) {
    using M = MaterialLanes<V>;
    const V least = m.word[M::word_min_J_P], most = m.word[M::word_max_J_P];
    V moved = m.J_P() * cut;
    moved = moved < least ? least : moved;
    moved = moved > most ? most : moved;
    m.J_P() = is_cut ? moved : m.J_P();
  }
};

struct InLanes : StretchesInLanes {
  static constexpr bool is_plastic = true;
  template <class Real, class Set>
  using Update = StretchUpdate<Real, Set, Projection>;
};

#ifndef NEVE_LANES_ALONE
/// The largest stretch over its threshold.
inline double nearness_to_yield(const Material& material, const Mat3d& F_E, double) {
  const Vec3d s = Stretches(F_E).s;
  constexpr double least = 1e-9;
  return std::max((s.maxCoeff() - 1) / std::max(material.critical_stretch, least),
                  (1 - s.minCoeff()) / std::max(material.critical_compression, least));
}

/// Scales thresholds. critical_compression takes the root by measurement: docs/prediction.md.
inline void refine(Material& material, double factor) {
  material.critical_stretch *= factor;
  material.critical_compression *= std::sqrt(factor);
}

inline constexpr Parameter parameters[] = {
    parameter::hardening,
    {.key = "critical_compression",
     .member = &Material::critical_compression,
     .bounds = {.min = 0, .max = 1, .is_max_open = true},
     .help = "The paper's theta_c: compression at which snow yields."},
    {.key = "critical_stretch",
     .member = &Material::critical_stretch,
     .bounds = {0, 100},
     .help = "The paper's theta_s: stretch at which snow breaks."}};

inline constexpr Law law{.kind = "the paper's",
                         .is_snow = true,
                         .hardens = true,
                         .is_plastic = InLanes::is_plastic,
                         .parameters = parameters,
                         .rate = &parameters[0],
                         .caption = "hardening {}, theta {} and {}",
                         .energy_density = energy_of_stretches,
                         .first_piola = piola_of_stretches,
                         .wave_modulus = stretched_wave_modulus,
                         .nearness_to_yield = nearness_to_yield,
                         .response = response_of_stretches,
                         .energies = energies_of_stretches,
                         .refine = refine,
                         .scale = scale_of_thresholds};
#endif

}  // namespace neve::sim::laws::snow
