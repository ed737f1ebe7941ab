#pragma once
/// Layout of a particle record and of the material table.

#include <cstdint>

#include "sim/base/lanes.h"
#include "sim/types/model.h"

namespace neve::sim::kernels {

enum ParticleFlag : std::uint8_t {
  needs_volume = 1,  ///< V0 is to be estimated in the next step
};

/// One record, read whole by every sweep; with R and I lanes, a batch of records word by word.
/// Neither dt nor material constants are baked into it. Position is the cell (lattice units) and
/// the offset in it, in [0, 1) cells, so that accuracy does not fade away from the origin. Words
/// are in groups of four: those that a step writes come first.
template <class R, class I>
struct Record {
  R offset[3];
  R J_P;     ///< det F_P
  R v[3];    ///< m/s
  R m;       ///< kg
  R F_E[9];  ///< row by row
  R V0;      ///< m3
  R tau[6];  ///< Kirchhoff stress, Pa: xx yy zz xy xz yz; derived from F_E and J_P
  I cell[3];
  I kind;       ///< material | model << 16 | flags << 24
  R stiffness;  ///< factor on mu and lambda
  R threshold;  ///< factor on theta_c and theta_s, or on the strength of other laws
  I id;
  R C[9];  ///< 1/s, affine velocity of all transfers but FLIP, row by row

  NEVE_INLINE I material() const { return kind & 0xffff; }
  NEVE_INLINE I model() const { return (kind >> 16) & 0xff; }
  NEVE_INLINE I flags() const { return (kind >> 24) & 0xff; }
};

/// @param material index into the material table
template <class Real>
NEVE_INLINE Integer<Real> kind_of(std::uint16_t material, Model model, unsigned flags) {
  return static_cast<Integer<Real>>(material | static_cast<unsigned>(model) << 16 | flags << 24);
}

template <class Real>
using Particle = Record<Real, Integer<Real>>;
static_assert(sizeof(Particle<float>) == 160 && sizeof(Particle<double>) == 320);

/// No bound on a number, in float and in double.
inline constexpr double no_bound = 3e38;

/// Constants of a material that its law alone knows.
inline constexpr int own_constants = 6;

/// A row of the material table. By default J_P and hardening have no bounds.
template <class Real>
struct MaterialConstants {
  Real mu0, lambda0;  ///< Pa
  Real xi;
  Real theta_c, theta_s;
  Real min_J_P = 0, max_J_P = Real(no_bound), max_hardening = Real(no_bound);
  Real own[own_constants] = {};  ///< of the law: its file says which
};

}  // namespace neve::sim::kernels
