#pragma once
/// Layout of a particle record.

#include <cstdint>

#include "sim/base/lanes.h"

namespace neve::sim::kernels {

enum class ModelKind : std::uint8_t { snow = 0, corotated = 1, neo_hookean = 2 };

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
  R threshold;  ///< factor on theta_c and theta_s
  I id;
  R C[9];  ///< 1/s, affine velocity of all transfers but FLIP, row by row

  NEVE_INLINE I material() const { return kind & 0xffff; }
  NEVE_INLINE I model() const { return (kind >> 16) & 0xff; }
  NEVE_INLINE I flags() const { return (kind >> 24) & 0xff; }
};

/// @param material index into the material table
template <class Real>
NEVE_INLINE Integer<Real> kind_of(std::uint16_t material, ModelKind model, unsigned flags) {
  return static_cast<Integer<Real>>(material | static_cast<unsigned>(model) << 16 | flags << 24);
}

template <class Real>
using Particle = Record<Real, Integer<Real>>;
static_assert(sizeof(Particle<float>) == 160 && sizeof(Particle<double>) == 320);

}  // namespace neve::sim::kernels
