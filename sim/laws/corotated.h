#pragma once
/// The energy of the paper's snow without its thresholds: elastic.

#include "sim/laws/stretches.h"

namespace neve::sim::laws::corotated {

struct NoProjection {
  static constexpr bool yields = false;
  template <class V>
  NEVE_INLINE static V clamp_stretch(MaterialLanes<V>&, V s, V&) {
    return s;
  }
  template <class V>
  NEVE_INLINE static void move_J_P(MaterialLanes<V>&, V, MaskOf<V>) {}
};

struct InLanes : StretchesInLanes {
  static constexpr bool is_plastic = false;
  template <class Real, class Set>
  using Update = StretchUpdate<Real, Set, NoProjection>;
};

#ifndef NEVE_LANES_ALONE
inline constexpr Parameter parameters[] = {parameter::hardening};

inline constexpr Law law{.kind = "elastic",
                         .hardens = true,
                         .is_plastic = InLanes::is_plastic,
                         .parameters = parameters,
                         .rate = &parameters[0],
                         .caption = "elastic, hardening {}",
                         .energy_density = energy_of_stretches,
                         .first_piola = piola_of_stretches,
                         .wave_modulus = stretched_wave_modulus,
                         .response = response_of_stretches,
                         .energies = energies_of_stretches,
                         .scale = scale_of_thresholds};
#endif

}  // namespace neve::sim::laws::corotated
