#pragma once
/// The semi-implicit step's solve for v_new, and the sweeps that it is made of:
///   (I + beta dt^2 M^-1 H) v_new = v_star                                  (the paper, equation 9)
/// with H the Hessian of the elastic energy at the start of the step, never put together. Solved
/// for y = M^1/2 v_new, where the system is symmetric:
///   A y = M^1/2 v_star,  A = I + beta dt^2 M^-1/2 H M^-1/2.
/// A collider is a wall and not an initial velocity: nodes that touch one keep v_star in the
/// directions that it holds. With P the part along the others, v_new = (I - P) v_star + M^-1/2 y:
///   P A P y = P M^1/2 v_star - beta dt^2 P M^-1/2 H (I - P) v_star,  y = P y.
/// Plain data, as in kernels.h.

#include "sim/kernels/kernels.h"

namespace neve::sim::kernels {

/// Vectors of a node during a solve. u is the displacement that particles gather next, M^-1/2 times
/// the vector that A is applied to; its fourth number is m^-1/2, 0 where there is no mass.
enum SolveVector {
  solve_y,
  solve_r,
  solve_q,
  solve_Ar,
  solve_Aq,
  solve_u,
  solve_held,  ///< see held.h
  solve_vectors
};

/// Numbers that a sweep sums over a block of nodes, at most.
inline constexpr int solve_sums = 5;

/// Quads that a particle keeps, in the order of the blocks: Elasticity.
inline constexpr int elasticity_quads = 2;

template <class Real>
struct SolveArgs {
  SweepArgs<Real> step;    ///< nodes have v_free and get v_star, then v_new
  Real beta_dt_squared;    ///< s2
  Real along, turn;        ///< the step's length and the share of the last direction
  Real hold;               ///< stiffness of contacts at particles, see particle_contact.h
  Real per_impulse[3];     ///< `react`: momentum that nothing held gave, per impulse of what did
  bool collides;           ///< nodes meet colliders again
  Quad<Real>* elasticity;  ///< per sorted position
  Quad<Real>* vectors;     ///< per node block: solve_vectors x 64
  const Quad<Real>* u;     ///< of the nodes, that H is applied to; per node block, u_stride apart
  std::size_t u_stride;
  double* sums;           ///< per node block: solve_sums, its part of what a sweep sums
  std::uint8_t* is_held;  ///< per node block: some of its nodes are
};

template <class Real>
using SolveSweep = void (*)(const SolveArgs<Real>&, std::uint32_t begin, std::uint32_t end);

/// keep_elasticity and apply (H u into the tiles) sweep particle blocks, the others node blocks.
template <class Real>
struct SolveSweeps {
  SolveSweep<Real> keep_elasticity, apply;
  SolveSweep<Real> start;     ///< v_star and what is held, y = P M^1/2 v_star
  SolveSweep<Real> motion;    ///< sums m v_star^2, m v_star (three), m
  SolveSweep<Real> show;      ///< u, of y: the velocities that it stands for
  SolveSweep<Real> residual;  ///< r, of y and its u; sums r^2
  SolveSweep<Real> image;     ///< P A r; sums r . A r, (A r)^2, A r . A q
  SolveSweep<Real> advance;   ///< q = r + turn q, y += along q, r -= along A q; sums r^2
  SolveSweep<Real> size;      ///< sums y^2; no number where a velocity is none
  SolveSweep<Real> finish;    ///< v_new, collisions if asked for, and the change for FLIP; sums
                              ///< m (v_new - v_star), three
  // From H v_new, over blocks that have held nodes:
  SolveSweep<Real> reaction;  ///< sums impulses of what holds the nodes (three), and their sizes
  SolveSweep<Real> react;     ///< loads and work of these impulses
};

/// The sweeps of an instruction set. MLS has its own gradient, the others share one.
const SolveSweeps<float>& solve_sweeps_for(SimdLevel level, int nodes, bool is_mls, float);
const SolveSweeps<double>& solve_sweeps_for(SimdLevel level, int nodes, bool is_mls, double);

/// One file per instruction set defines its own.
template <class Set>
struct SolveKernelSet {
  static const SolveSweeps<float>& sweeps(int nodes, bool is_mls, float);
  static const SolveSweeps<double>& sweeps(int nodes, bool is_mls, double);
};

}  // namespace neve::sim::kernels
