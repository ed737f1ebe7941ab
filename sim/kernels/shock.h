#pragma once
/// Artificial viscosity of snow that is being compressed. A shock is thinner than a cell: without
/// viscosity the snow behind it rings, and plasticity keeps every swing, so that impacts pack snow
/// 2 to 14 % further than the jump conditions allow.
/// Sources: von Neumann, Richtmyer 1950, A method for the numerical calculation of hydrodynamic
/// shocks, J. Appl. Phys. 21 (quadratic); Landshoff 1955, LA-1930 (linear).

#include "sim/kernels/kernels.h"
#include "sim/kernels/particle_lanes.h"

namespace neve::sim::kernels {

/// Pressure that is taken from the diagonal of tau where D = tr grad v < 0, in Pa:
///   q = rho0 h (c_q^2 h D^2 + c_l c |D|),  c the hardened speed of sound.
/// It is explicit in every step: nu dt/h^2 = c_q^2 |D| dt + c_l c dt/h has to leave room for sound.
/// The shortest waves of the grid have k h = 1.67 (sound is stable up to c dt/h = 1.2), and a
/// damped wave is stable while 2 nu dt k^2 + (c dt k)^2 < 4; seven tenths of that are used. Steps
/// that cross many cells with sound, which only semi-implicit ones can, have no viscosity.
/// @param sound_squared  c^2, m2/s2
template <class V, class I>
NEVE_INLINE V shock_pressure(const Record<V, I>& p, const V* grad_v, const V& sound_squared,
                             const StepConstants<ElementOf<V>>& c) {
  using Real = ElementOf<V>;
  const V D = smaller_lanes(grad_v[0] + grad_v[4] + grad_v[8], V{});
  const V crossed = square_root_lanes(sound_squared) * c.dt_over_h;
  const V room =
      larger_lanes(fused(all<V>(Real(-0.35)), crossed * crossed, all<V>(Real(0.5))), V{});
  const V wanted = fused(all<V>(-c.shock_quadratic * c.dt), D, c.shock_linear * crossed);
  // A particle has no stress without a volume, where that stage is skipped.
  const V density = p.V0 > V{} ? p.m / p.V0 : V{};
  return density * (c.h / c.dt_over_h) * smaller_lanes(wanted, room) * -D;
}

}  // namespace neve::sim::kernels
