#pragma once
/// Contact found at particles and acting through the grid, and the sweeps that it is made of.
///
/// Nodes are a cell apart, so snow held at nodes rests up to a cell above what it lies on. Here
/// every particle that comes too near to a surface gets an impulse j_p, along the normal and by
/// friction, that is scattered to its nodes as the stress is: v_i += sum w_ip j_p / m_i. Each is
/// such that the velocity v_p that the particle will move with closes its gap and no more. FLIP
/// particles keep alpha (v_p - sum w_ip v_i) of before the step beside what the grid gives them,
/// ASFLIP particles move with beta of that, AFLIP particles with nothing of it.
/// A collider that holds on to a particle takes what it holds of the particle's own velocity: the
/// grid does not see that velocity, and an answer to it would strain snow by what it does not feel,
/// again and again. Each of several takes from the rest that the others left. The impulses are
/// found by a projected Jacobi iteration
///   j_p <- project(j_p + (wanted - v_p) / D_p),  D_p = sum_i w_ip c_i / m_i,  c_i = sum_q w_iq
/// with c over the particles in contact. D is the sum of a row of the system, not its diagonal: a
/// step never goes too far, however many particles share a node, and one is enough where all of
/// them want the same.
///
/// It begins with the impulses of the last step, projected.
///
/// A body that moves by itself answers between the passes: its surface has another velocity then.
/// To each contact it shows an equal part of its mass, `give` is what that part gives way by: then
/// the passes go as far as they should and no further, for a feather as for an anvil (Tonge,
/// Benevolenski and Voroshilov, Mass splitting for jitter-free parallel rigid body simulation,
/// SIGGRAPH 2012).
///
/// In the semi-implicit solve, elasticity answers too. Each contact that acts is a spring of
/// stiffness `hold` / D_p there, between v_p and the velocity that it wants: along the normal, and
/// along the surface where friction or the collider holds on to it. Its impulse adds to that of the
/// last step, with which the solve begins (an augmented Lagrangian). If the solution asks for other
/// contacts to act, or springs gave way, the impulses are projected and it is solved again; the
/// passes above close what is left.
///
/// Plain data, as in kernels.h.

#include "sim/kernels/kernels.h"

namespace neve::sim::kernels {

/// Snow touches a surface where its particles are this share of half their spacing away: seeded
/// particles are not all in the middle of their part of the body.
inline constexpr double touching_share = 0.75;
/// No particle touches at more than this, cells, however few there are in a cell.
inline constexpr double max_touching = 0.5;
/// A particle counts as touching up to this distance beyond, cells. A surface that holds on to snow
/// holds what was seeded within it where it is.
inline constexpr double touching_slack = 0.1;

/// A particle in contact with a collider; numbers, or lanes.
template <class R, class I>
struct ContactRecord {
  R offset[3];  ///< of the particle in its cell
  R least;      ///< m/s: it may not be slower than this along the normal, relative to the surface
  R normal[3];
  R impulse;     ///< kg m/s, along the normal
  R surface[3];  ///< m/s, velocity of the surface
  R friction;    ///< bound on the impulse along the surface: times the one along the normal, or,
                 ///< where the collider holds on to the particle, in kg m/s
  R sliding[3];  ///< kg m/s, impulse along the surface
  R row;         ///< D_p, 1/kg
  R own[3];      ///< m/s, what the particle keeps beside the velocity of the grid
  R holds;       ///< in the solve: holds_normal, holds_surface, their sum or 0
  I cell[3];
  I collider;    ///< its index; negative (-1 - index) if it holds on to the particle
  R touches;     ///< m: distance from the surface at which they touch
  R is_seeded;   ///< 1: that is where it was seeded, not where others touch
  I particle;    ///< storage index
  I list;        ///< number of the collider in the list of the run
  R lost[3];     ///< m/s, of the particle's own velocity: the collider takes it
  R mass;        ///< kg, of the particle
  R give;        ///< 1/kg: a body gives way by so much to an impulse along the normal; 0 of others
  R give_along;  ///< along the surface
  R unused[2];
};
inline constexpr int holds_normal = 1, holds_surface = 2;
template <class Real>
using Contact = ContactRecord<Real, Integer<Real>>;
inline constexpr int contact_quads = 9;
static_assert(sizeof(Contact<float>) == 16 * contact_quads);

/// The contact that a particle and a collider remember until the next step: its impulse is where
/// the iteration begins, so that a load that stays is carried whole, and one that changes is met by
/// a few passes.
template <class Real>
struct KeptContact {
  Real impulse, sliding[3], touches;  ///< see ContactRecord
  std::uint32_t particle;             ///< storage index
  std::int32_t collider;              ///< number in the list of the run
  std::uint32_t next;                 ///< another one of the same particle, or no_contact
};
inline constexpr std::uint32_t no_contact = ~std::uint32_t(0);

/// True if a particle's head leads to its first contact. Heads of particles that have none left may
/// lead anywhere.
template <class Real>
NEVE_INLINE bool is_contact_of(const KeptContact<Real>* kept, std::uint32_t count,
                               std::uint32_t head, std::uint32_t particle) {
  return head < count && kept[head].particle == particle;
}

/// A block of nodes while impulses are found.
template <class Real>
struct alignas(64) ContactNodes {
  Quad<Real> velocity[block_nodes];  ///< v, and c / m in the fourth number
};

template <class Real>
struct ContactArgs {
  SweepArgs<Real> step;       ///< nodes have v_free and get v_star
  const ColliderPose* poses;  ///< those of `step`, which the solve does not show to the nodes
  const Real* half_spacing;   ///< per material: of particles of 1 kg, m
  Real max_touching_gap;      ///< m: no particle touches at more
  Real max_speed;             ///< m/s, of all particles before the step
  Real apart;  ///< 1/s: share of what a particle outside is too near by that it moves away by
  std::uint32_t* candidates;    ///< per sorted position: those of a block come first in its range
  std::uint32_t* near_counts;   ///< per particle block: candidates
  std::uint32_t* counts;        ///< per particle block: contacts; until `start`, the most there are
  const std::uint32_t* blocks;  ///< particle blocks with contacts
  const std::uint64_t* first;   ///< per particle block: its first contact
  const std::uint32_t* node_blocks;  ///< those that they reach
  Contact<Real>* contacts;
  // Contacts that are remembered.
  const KeptContact<Real>* kept;  ///< of the last step
  std::uint32_t kept_count;
  Real carried;             ///< length of this step over that of the last
  std::uint32_t* head;      ///< per storage index: its first contact in `kept`, and then in `keep`
  KeptContact<Real>* keep;  ///< of this step: as many as there are contacts
  const std::uint32_t* first_to_keep;  ///< per particle block
  ContactNodes<Real>* nodes;           ///< per node block
  bool is_last;                        ///< of the passes
  bool only_closes;                    ///< the passes follow a solution
  // These serve the semi-implicit solve.
  bool is_before_solve;  ///< and the nodes get v_star from `weigh`
  bool is_first;         ///< u are velocities, otherwise a change of them
  const Quad<Real>* u;   ///< per node block, `u_stride` apart
  std::size_t u_stride;
  Real hold;  ///< stiffness of contacts, as a share of 1 / D_p
  Real beta_dt_squared;
  double* sums;                         ///< per block with contacts: ContactSums of `measure`
  Real per_impulse[3], per_contact[3];  ///< `book`: momentum that none of the springs gave
};

/// Sums over the contacts of a block at the solution.
struct ContactSums {
  double missing;    ///< J, of the impulses that would still be needed
  double spring[3];  ///< kg m/s, of the springs
};
inline constexpr int contact_sums = 4;

template <class Real>
using ContactSweep = void (*)(const ContactArgs<Real>&, std::uint32_t begin, std::uint32_t end);

/// Sweeps over blocks of particles and of nodes in turn.
template <class Real>
struct ContactSweeps {
  ContactSweep<Real> find;   ///< all particle blocks: candidates
  ContactSweep<Real> start;  ///< contacts of candidates, c into the tiles
  ContactSweep<Real> weigh;  ///< nodes: velocities and c / m
  ContactSweep<Real> press;  ///< change of the impulses into the tiles
  ContactSweep<Real> yield;  ///< nodes: velocities after it, after the last pass those of the step
  // These serve the semi-implicit solve.
  ContactSweep<Real> rows;     ///< D_p
  ContactSweep<Real> hold;     ///< adds the springs' part of H u to the tiles
  ContactSweep<Real> measure;  ///< ContactSums of the solution u
  ContactSweep<Real> renew;    ///< projects impulses at u, their change into the tiles
  ContactSweep<Real> settle;   ///< adds the springs' impulses at u
  ContactSweep<Real> take;     ///< nodes: velocities of the step
  ContactSweep<Real> book;     ///< loads and work of the impulses, which are remembered
};

/// The sweeps of an instruction set.
const ContactSweeps<float>& contact_sweeps_for(SimdLevel level, int nodes, float);
const ContactSweeps<double>& contact_sweeps_for(SimdLevel level, int nodes, double);

/// One file per instruction set defines its own.
template <class Set>
struct ContactKernelSet {
  static const ContactSweeps<float>& sweeps(int nodes, float);
  static const ContactSweeps<double>& sweeps(int nodes, double);
};

}  // namespace neve::sim::kernels
