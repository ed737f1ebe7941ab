#pragma once
/// A batch of particles, one per lane.

#include "sim/kernels/particles.h"

namespace neve::sim::kernels {

template <class Real, int W>
using ParticleLanes = Record<Lanes<Real, W>, Lanes<Integer<Real>, W>>;

/// Reads parts of the records, four words at a time.
template <class V, class I>
class RecordReader {
 public:
  using Real = ElementOf<V>;

  NEVE_INLINE RecordReader(const Particle<Real>* const* records, Record<V, I>& batch)
      : records_(records), batch_(batch) {}

  NEVE_INLINE void place() {
    const FourWords<V> a = words(0), b = words(24);
    for (int axis = 0; axis < 3; ++axis) {
      batch_.offset[axis] = a.w[axis];
      batch_.cell[axis] = reinterpret_cast<I>(b.w[axis]);
    }
    batch_.J_P = a.w[3];
    batch_.kind = reinterpret_cast<I>(b.w[3]);
  }
  NEVE_INLINE void motion() {
    const FourWords<V> a = words(4);
    for (int axis = 0; axis < 3; ++axis) batch_.v[axis] = a.w[axis];
    batch_.m = a.w[3];
  }
  NEVE_INLINE void deformation() {
    const FourWords<V> a = words(8), b = words(12);
    for (int k = 0; k < 4; ++k) {
      batch_.F_E[k] = a.w[k];
      batch_.F_E[4 + k] = b.w[k];
    }
  }
  /// Reads V0, and beside it the last word of F_E and the first two of tau.
  NEVE_INLINE void volume() {
    const FourWords<V> a = words(16);
    batch_.F_E[8] = a.w[0];
    batch_.V0 = a.w[1];
    batch_.tau[0] = a.w[2];
    batch_.tau[1] = a.w[3];
  }
  NEVE_INLINE void stress() {
    const FourWords<V> a = words(20);
    for (int k = 0; k < 4; ++k) batch_.tau[2 + k] = a.w[k];
  }
  /// Reads the factors and id, and beside them the first word of C.
  NEVE_INLINE void factors() {
    const FourWords<V> a = words(28);
    batch_.stiffness = a.w[0];
    batch_.threshold = a.w[1];
    batch_.id = reinterpret_cast<I>(a.w[2]);
    batch_.C[0] = a.w[3];
  }
  NEVE_INLINE void affine() {
    const FourWords<V> a = words(32), b = words(36);
    for (int k = 0; k < 4; ++k) {
      batch_.C[1 + k] = a.w[k];
      batch_.C[5 + k] = b.w[k];
    }
  }

 private:
  NEVE_INLINE FourWords<V> words(int first) const {
    return load_words<V>(records_, first * static_cast<int>(sizeof(Real)));
  }
  const Particle<Real>* const* records_;
  Record<V, I>& batch_;
};

/// Reads what steps 7 to 10 need; they write tau and C.
template <class V, class I>
NEVE_INLINE void load(Record<V, I>& batch, const Particle<ElementOf<V>>* const* records) {
  RecordReader<V, I> read(records, batch);
  read.place();
  read.motion();
  read.deformation();
  read.volume();
  read.factors();
}
/// Reads what steps 1 and 3 need.
template <bool with_C, bool with_tau, class V, class I>
NEVE_INLINE void load_for_scatter(Record<V, I>& batch,
                                  const Particle<ElementOf<V>>* const* records) {
  RecordReader<V, I> read(records, batch);
  read.place();
  read.motion();
  if constexpr (with_tau) {
    read.volume();
    read.stress();
  }
  if constexpr (with_C) {
    read.factors();
    read.affine();
  }
}
template <class V, class I>
NEVE_INLINE void load_whole(Record<V, I>& batch, const Particle<ElementOf<V>>* const* records) {
  load(batch, records);
  RecordReader<V, I> read(records, batch);
  read.stress();
  read.affine();
}

/// Writes what a step changes to the first `count` records; C only where the transfer has one.
template <bool with_C, class V, class I>
NEVE_INLINE void store(const Record<V, I>& lanes, Particle<ElementOf<V>>* const* records,
                       int count) {
  using Real = ElementOf<V>;
  const auto put = [&](int first, V a, V b, V c, V d) NEVE_INLINE_BODY {
    store_words(FourWords<V>{{a, b, c, d}}, records, first * static_cast<int>(sizeof(Real)), count);
  };
  const V* F = lanes.F_E;
  const V* tau = lanes.tau;
  put(0, lanes.offset[0], lanes.offset[1], lanes.offset[2], lanes.J_P);
  put(4, lanes.v[0], lanes.v[1], lanes.v[2], lanes.m);
  put(8, F[0], F[1], F[2], F[3]);
  put(12, F[4], F[5], F[6], F[7]);
  put(16, F[8], lanes.V0, tau[0], tau[1]);
  put(20, tau[2], tau[3], tau[4], tau[5]);
  put(24, reinterpret_cast<V>(lanes.cell[0]), reinterpret_cast<V>(lanes.cell[1]),
      reinterpret_cast<V>(lanes.cell[2]), reinterpret_cast<V>(lanes.kind));
  if constexpr (with_C) {
    const V* C = lanes.C;
    put(28, lanes.stiffness, lanes.threshold, reinterpret_cast<V>(lanes.id), C[0]);
    put(32, C[1], C[2], C[3], C[4]);
    put(36, C[5], C[6], C[7], C[8]);
  }
}

}  // namespace neve::sim::kernels
