#pragma once
/// The table of sweeps that one instruction set provides, and what they read and write. Plain data:
/// the files that implement the sweeps are compiled for their instruction set and include no
/// standard library beyond <cstdint>.

#include <cstdint>

#include "sim/kernels/blocks.h"
#include "sim/kernels/contact.h"
#include "sim/kernels/law.h"
#include "sim/kernels/loads.h"
#include "sim/kernels/particles.h"

namespace neve::sim::kernels {

/// Channels of a tile: one Quad per node and channel.
enum TileChannel { channel_momentum = 0, channel_force = 1 };
inline constexpr int all_channels = 2;

/// Particles that are taken through steps 1 to 3 together, so that those of a cell reach its nodes
/// together.
inline constexpr int scatter_group = 32;

/// ASFLIP and AFLIP are one: the second moves by the grid alone.
enum class TransferKind : int { flip, apic, mls, aflip };

/// True if particles have an affine velocity C.
constexpr bool has_affine(TransferKind transfer) {
  return transfer != TransferKind::flip;
}
/// True if particles keep a velocity of their own, and gather how much that of the grid changed.
constexpr bool keeps_own(TransferKind transfer) {
  return transfer == TransferKind::flip || transfer == TransferKind::aflip;
}

/// Everything a step needs besides particles and nodes.
template <class Real>
struct StepConstants {
  Real h, inv_h;  ///< m, 1/m
  Real dt;        ///< s
  Real dt_over_h;
  Real alpha;  ///< FLIP share of this step
  /// Shares beta of what a particle keeps of its own velocity that it moves with: compressed, and
  /// from separating_J_E on. FLIP's are equal.
  Real beta_min, beta_max;
  Real separating_J_E;
  /// Bits of the laws of which no piece comes off: their beta is 0, or F and places part ways. None
  /// where all keep theirs, as FLIP's do.
  Integer<Real> whole_laws;
  Real shock_quadratic, shock_linear;  ///< coefficients of the shock viscosity, see shock_pressure
  Real gravity[3];
  bool moves_with_grid;  ///< advect = pic
  double h_double;       ///< for placing colliders exactly
  const MaterialConstants<Real>* materials;
  const ColliderPose* colliders;
  int collider_count;
};

/// Results of the update of one block of particles. All combine by max, min and sums of integers,
/// or are added in block order, so threads cannot change them.
template <class Real>
struct BlockReport {
  Real max_speed_squared = 0;  ///< m2/s2
  Real max_sound_squared = 0;  ///< m2/s2, hardened
  Real max_strain_rate = 0;    ///< 1/s, largest |entry| of grad v
  Real min_J_P = 1, max_J_P = 1;
  double contact_work = 0;                 ///< J, of the colliders on the snow
  std::uint32_t inverted = 0;              ///< trial det F_E <= 0
  std::uint32_t inverted_unprojected = 0;  ///< of those, in models that cannot repair it
  std::uint32_t not_finite = 0;
  std::uint32_t overflowed = 0;  ///< cells outside the lattice
};

/// Channels of a node in the fused driver: the values that particles gather.
enum NodeChannel { channel_v_new = 0, channel_change = 1 };

/// Data of a node block in the staged driver, 64 nodes each. The alignment is explicit, because
/// that of a Quad depends on the instruction set of the file.
template <class Real>
struct alignas(64) StagedNodes {
  Quad<Real> momentum[block_nodes];  ///< x y z and mass
  Quad<Real> force[block_nodes];
  Quad<Real> v_old[block_nodes], v_free[block_nodes], v_star[block_nodes], v_new[block_nodes];
};

/// Values that a particle gathers from the grid; a number or lanes.
template <class R>
struct Gathered {
  R v[3];       ///< sum w v_new (PIC)
  R change[3];  ///< sum w (v_new - v_old); FLIP and AFLIP
  R grad_v[9];  ///< 1/s, row by row
  R C[9];       ///< 1/s, affine velocity (all but FLIP), row by row
};

/// One state of the world, seen by a sweep.
template <class Real>
struct SweepArgs {
  StepConstants<Real> constants;
  Particle<Real>* particles;
  std::uint32_t particle_count;
  const std::uint32_t* order;  ///< sorted position -> storage index
  std::uint64_t* keys;         ///< storage index -> block key
  std::uint16_t* locals;       ///< storage index -> model and cell in the block
  const ParticleBlock* blocks;
  const NodeBlock* node_blocks;
  const SprayCluster* spray;   ///< particles that are in no block
  int channels;                ///< of tiles and nodes: 2, or what the fused driver needs
  Quad<Real>* tiles;           ///< per particle block: `channels` tiles
  Quad<Real>* nodes;           ///< per node block: `channels` x 64
  BlockReport<Real>* reports;  ///< per particle block
  double* node_contact_work;   ///< per node block, J
  LoadSum* loads;              ///< per collider of the list
  int load_count;
  double load_unit;  ///< N s
  // Staged driver only.
  StagedNodes<Real>* staged;  ///< per node block
  Gathered<Real>* gathered;   ///< per storage index
  Real* carrier;              ///< 3 per storage index, see carrier_velocity; null: not wanted
  Real* F_trial;              ///< 9 per storage index, before projection
  Real* v_before_collision;   ///< 3 per storage index
};

/// A sweep over blocks [begin, end).
template <class Real>
using Sweep = void (*)(const SweepArgs<Real>&, std::uint32_t begin, std::uint32_t end);

/// The sweeps for one kernel and transfer.
template <class Real>
struct Sweeps {
  // Fused: two particle sweeps and a grid sweep. FLIP and AFLIP keep momentum and force apart,
  // since particles want to know how much the velocity changed; the others add dt f to the
  // momentum.
  int fused_channels;
  Sweep<Real> particles_to_grid, grid_update, grid_to_particles;
  // Fused: the whole step of clusters [begin, end) of spray, away from all colliders.
  void (*spray)(const SweepArgs<Real>&, std::uint32_t begin, std::uint32_t end,
                BlockReport<Real>& report);
  // First step of a body: masses to the nodes (channel_momentum), then back to volumes.
  Sweep<Real> rasterize, collect_momentum, volumes;
  // Staged, one stage each.
  Sweep<Real> elastic_forces, collect_force, grid_velocities, grid_collisions, lay_out_velocities;
  Sweep<Real> gather, deformation, particle_velocities, particle_collisions, advection;
  // Runs after either driver, where settings ask for it.
  Sweep<Real> push_out;
  // Brings stress, keys and limits of the state up to date without a grid; `is_projected` projects
  // as step 7 does. Blocks are ranges of storage.
  void (*refresh)(const SweepArgs<Real>&, std::uint32_t begin, std::uint32_t end, bool is_projected,
                  BlockReport<Real>& report);
};

/// Instruction sets that kernels are built for, from the one that every machine of the architecture
/// has.
enum class SimdLevel { baseline, avx2, avx512 };

/// The sweeps of an instruction set that this build and this machine have.
/// @param nodes cubic_nodes or quadratic_nodes
const Sweeps<float>& sweeps_for(SimdLevel level, int nodes, TransferKind transfer, float);
const Sweeps<double>& sweeps_for(SimdLevel level, int nodes, TransferKind transfer, double);

/// One file per instruction set defines its own.
template <class Set>
struct KernelSet {
  static const Sweeps<float>& sweeps(int nodes, TransferKind transfer, float);
  static const Sweeps<double>& sweeps(int nodes, TransferKind transfer, double);
};

}  // namespace neve::sim::kernels
