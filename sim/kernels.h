#pragma once
/// The table of sweeps that one instruction set provides, and what they read and write. Plain data:
/// the files that implement the sweeps are compiled for their instruction set and include no
/// standard library beyond <cstdint>.

#include <cstdint>

#include "sim/blocks.h"
#include "sim/constitutive.h"
#include "sim/contact.h"
#include "sim/particles.h"

namespace neve::sim {

/// Bits of the node channels: one Quad per node and channel.
enum TileChannel { channel_momentum = 0, channel_force = 1, tile_channels = 2 };

/// Particles that are taken through steps 7 to 10 together, so that materials work on full lanes.
inline constexpr int group_size = 64;

enum class TransferKind : int { flip, apic, mls };

/// Everything a step needs besides particles and nodes.
template <class Real>
struct StepConstants {
  Real h, inv_h;  ///< m, 1/m
  Real dt;        ///< s
  Real dt_over_h;
  Real alpha;  ///< FLIP share of this step
  Real gravity[3];
  bool moves_with_grid;  ///< advect = pic
  double h_double;       ///< for placing colliders exactly
  const MaterialConstants<Real>* materials;
  const ColliderPose* colliders;
  int collider_count;
};

/// What one block of particles found out while it was updated. All combine by max, min and sums of
/// integers, or are added in block order, so threads cannot change them.
template <class Real>
struct BlockReport {
  Real max_speed_squared = 0;  ///< m2/s2
  Real max_sound_squared = 0;  ///< m2/s2, hardened
  Real max_strain_rate = 0;    ///< 1/s, largest |entry| of grad v
  Real min_J_P = 1, max_J_P = 1;
  double contact_work = 0;                 ///< J, energy that contacts added
  std::uint32_t inverted = 0;              ///< trial det F_E <= 0
  std::uint32_t inverted_unprojected = 0;  ///< of those, in models that cannot repair it
  std::uint32_t not_finite = 0;
  std::uint32_t overflowed = 0;  ///< cells outside the lattice
};

/// What the fused driver keeps of a node: what particles gather.
enum NodeChannel { channel_v_new = 0, channel_change = 1, node_channels = 2 };

/// What the staged driver keeps of a node block, 64 nodes each.
template <class Real>
struct StagedNodes {
  Quad<Real> momentum[block_nodes];  ///< x y z and mass
  Quad<Real> force[block_nodes];
  Quad<Real> v_old[block_nodes], v_free[block_nodes], v_star[block_nodes], v_new[block_nodes];
};

/// What a particle gathers from the grid.
template <class Real>
struct Gathered {
  Quad<Real> v;       ///< sum w v_new (PIC)
  Quad<Real> change;  ///< sum w (v_new - v_old)
  Real grad_v[9];     ///< 1/s, row by row
  Real C[9];          ///< 1/s, affine velocity (APIC, MLS)
};

/// One state of the world, seen by a sweep.
template <class Real>
struct SweepArgs {
  StepConstants<Real> constants;
  Particle<Real>* particles;
  const std::uint32_t* order;  ///< sorted position -> storage index
  std::uint64_t* keys;         ///< storage index -> block key
  std::uint16_t* locals;       ///< storage index -> model and cell in the block
  const ParticleBlock* blocks;
  const NodeBlock* node_blocks;
  Quad<Real>* tiles;           ///< per particle block: tile_channels tiles
  Quad<Real>* nodes;           ///< per node block: node_channels x 64
  BlockReport<Real>* reports;  ///< per particle block
  double* node_contact_work;   ///< per node block, J
  // Staged driver only.
  StagedNodes<Real>* staged;       ///< per node block
  Gathered<Real>* gathered;        ///< per storage index
  Real* F_trial;                   ///< 9 per storage index, before projection
  Quad<Real>* v_before_collision;  ///< per storage index
};

/// A sweep over blocks [begin, end).
template <class Real>
using Sweep = void (*)(const SweepArgs<Real>&, std::uint32_t begin, std::uint32_t end);

/// The sweeps for one kernel and transfer.
template <class Real>
struct Sweeps {
  // Fused: two particle sweeps and a grid sweep.
  Sweep<Real> particles_to_grid, grid_update, grid_to_particles;
  // First step of a body: masses to the nodes (channel_momentum), then back to volumes.
  Sweep<Real> rasterize, collect_momentum, volumes;
  // Staged, one stage each.
  Sweep<Real> elastic_forces, collect_force, grid_velocities, grid_collisions, keep_velocities;
  Sweep<Real> gather, deformation, particle_velocities, particle_collisions, advection;
  // Without a grid: stress, keys and limits of the state as it is. Blocks are ranges of storage.
  void (*refresh)(const SweepArgs<Real>&, std::uint32_t begin, std::uint32_t end,
                  BlockReport<Real>& report);
};

/// @param nodes cubic_nodes or quadratic_nodes
const Sweeps<float>& baseline_sweeps(int nodes, TransferKind transfer, float);
const Sweeps<double>& baseline_sweeps(int nodes, TransferKind transfer, double);

}  // namespace neve::sim
