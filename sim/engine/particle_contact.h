#pragma once
/// Contact at particles for a whole step: which blocks take part, and the passes over them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/engine/body_contact.h"
#include "sim/kernels/implicit.h"
#include "sim/kernels/particle_contact.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

template <class Real>
class ParticleContact {
 public:
  /// v_star from v_free, both as v_new of the nodes. Overwrites the first channel of the tiles, and
  /// adds the work of the colliders to that of the nodes.
  /// @param step  whose nodes have v_free
  /// @param is_before_solve  impulses are those of the last step: the solve finds those of this one
  void act(State<Real>& state, const kernels::SweepArgs<Real>& step, bool is_before_solve);

  // These belong to the semi-implicit solve of the step that `act` was called for.

  /// Adds the forces of the springs to H u in the tiles. @param is_first  u are velocities
  void hold(const State<Real>& state, const kernels::SolveArgs<Real>& solve, bool is_first);
  /// Sums over the contacts at the velocities u.
  struct Solution {
    double missing = 0;            ///< J, of the impulses that contact would still need
    Vec3d spring = Vec3d::Zero();  ///< kg m/s, of the springs
  };
  Solution look(const State<Real>& state, const kernels::SolveArgs<Real>& solve);
  /// Impulses that u asks for: they change v_star of the nodes.
  void renew(const State<Real>& state, const kernels::SolveArgs<Real>& solve);
  /// Impulses at u = v_new of the nodes, and what contact still needs of them; adds the work of the
  /// colliders to that of the nodes.
  /// @param unexplained  kg m/s that the snow got in the solve from none of the springs
  void settle(State<Real>& state, const kernels::SolveArgs<Real>& solve, const Vec3d& unexplained);
  /// Finishes a step without a solution as an explicit one, from v_star.
  void settle_without(State<Real>& state);

  std::size_t memory_bytes() const;

 private:
  using Sweep = kernels::ContactSweep<Real>;
  void over(const std::vector<std::uint32_t>& blocks, Sweep sweep, const State<Real>& state) const;
  static void over(const std::vector<std::uint32_t>& blocks, Sweep sweep,
                   const kernels::ContactArgs<Real>& a, const State<Real>& state);
  void over_springs(Sweep sweep, const State<Real>& state, const kernels::SolveArgs<Real>& solve,
                    bool is_first);
  kernels::ContactArgs<Real> contact_args(State<Real>& state, const kernels::SweepArgs<Real>& step);
  void make_room(std::size_t particles, const Partition& partition);
  std::uint64_t place_contacts();
  std::uint32_t place_kept();
  void follow_bodies(const State<Real>& state);
  bool is_enough(int pass, int wanted) const;
  void pass(int number, int wanted, const State<Real>& state);
  void pass_again(const State<Real>& state);
  void share(const Vec3d& unexplained);
  void book(State<Real>& state);
  void list_blocks();
  void list_node_blocks(const Partition& partition, const std::vector<std::uint32_t>& blocks,
                        std::vector<std::uint32_t>& node_blocks);
  void list_near_bodies(const Partition& partition);

  std::vector<std::uint32_t> candidates_;            ///< per sorted position
  std::vector<std::uint32_t> near_counts_, counts_;  ///< per particle block, see ContactArgs
  std::vector<std::uint64_t> first_;
  std::vector<std::uint32_t> first_to_keep_;         ///< likewise
  std::vector<std::uint32_t> blocks_, node_blocks_;  ///< that take part
  std::vector<std::uint8_t> is_reached_;             ///< per node block
  std::vector<kernels::Contact<Real>> contacts_;
  std::vector<kernels::ContactNodes<Real>> nodes_;
  kernels::ContactArgs<Real> args_{};  ///< of the last step
  std::uint32_t kept_count_ = 0;       ///< of its contacts, that may be remembered
  std::vector<double> sums_;           ///< see ContactArgs
  BodyContact<Real> bodies_;
  /// The part of the blocks, and of their counts, that touches bodies.
  struct {
    std::vector<std::uint32_t> blocks, node_blocks, counts;
  } near_bodies_;
};

}  // namespace neve::sim::engine
