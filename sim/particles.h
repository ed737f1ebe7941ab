#pragma once
/// What a particle carries.

#include <cstdint>

namespace neve::sim {

enum ParticleFlag : std::uint8_t {
  needs_volume = 1,  ///< V0 is to be estimated in the next step
};

/// One record, read whole by every sweep. Neither dt nor material constants are baked into it.
/// Position is the cell (lattice units) and the offset in it, in [0, 1) cells, so that accuracy
/// does not fade away from the origin.
template <class Real>
struct Particle {
  std::int32_t cell[3];
  Real offset[3];
  Real v[3];    ///< m/s
  Real m;       ///< kg
  Real V0;      ///< m3
  Real F_E[9];  ///< row by row
  Real J_P;     ///< det F_P
  Real C[9];    ///< 1/s, affine velocity of APIC and MLS
  Real tau[6];  ///< Kirchhoff stress, Pa: xx yy zz xy xz yz; derived from F_E and J_P
  std::uint32_t id;
  std::uint16_t material;
  std::uint8_t model;
  std::uint8_t flags;
  Real stiffness;  ///< factor on mu and lambda
  Real threshold;  ///< factor on theta_c and theta_s
};
static_assert(sizeof(Particle<float>) == 160);

}  // namespace neve::sim
