#pragma once
/// Bodies that move by themselves, between the passes of contact at particles.

#include <cstdint>
#include <vector>

#include "sim/kernels/particle_contact.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

/// After each pass bodies get the impulses that contacts have by then, and answer: what they touch,
/// what holds them and gravity count. Then the surfaces of contacts have the new velocity, and say
/// what they give way by in the next pass. Contacts are added up in one order by one thread: they
/// are few.
template <class Real>
class BodyContact {
 public:
  bool empty() const { return bodies_ == nullptr; }

  /// @param a  of the step
  void begin(State<Real>& state, const kernels::ContactArgs<Real>& a);
  /// @param a       with its contacts
  /// @param blocks  of particles, that have contacts
  void answer(const State<Real>& state, const kernels::ContactArgs<Real>& a,
              const std::vector<std::uint32_t>& blocks);

 private:
  /// A body in the step.
  struct Seen {
    Mat3d inverse_inertia;
    Vec3d free_velocity, free_spin;  ///< at the end of the step, without contact of snow
    double gives = 1;   ///< how far it follows impulses, as a share of how far it would if nothing
                        ///< stopped it
    std::size_t count;  ///< contacts that press
  };
  template <class Visit>
  void each_contact(const kernels::ContactArgs<Real>& a, const std::vector<std::uint32_t>& blocks,
                    const Visit& visit) const;
  void collect(const kernels::ContactArgs<Real>& a, const std::vector<std::uint32_t>& blocks);
  void find_out_what_gives();
  void show(std::size_t body, const Vec3d& arm, kernels::Contact<Real>& contact) const;

  rigid::RigidBodies* bodies_ = nullptr;
  std::vector<int> body_of_;  ///< per collider; -1: the scene moves it
  std::vector<Seen> seen_;
  std::vector<rigid::Push> pushes_;
  bool is_first_ = true;
};

}  // namespace neve::sim::engine
