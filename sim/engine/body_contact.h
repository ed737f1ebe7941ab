#pragma once
/// Bodies that move by themselves, between the passes of contact at particles.

#include <cstdint>
#include <vector>

#include "sim/kernels/particle_contact.h"
#include "sim/state/state.h"

namespace neve::sim::engine {

/// Contact of snow with bodies that move by themselves. After each pass bodies get the impulses
/// that contacts have by then, and answer: what they touch, what holds them and gravity count. Then
/// the surfaces of contacts have the new velocity, and the share by which they give way in the next
/// pass. Threads add up contacts of a block and a body, and one of them those sums: in one order,
/// at any number of threads.
template <class Real>
class BodyContact {
 public:
  bool empty() const { return bodies_ == nullptr; }

  /// @param a       of the step, with its contacts
  /// @param blocks  of particles, that have contacts
  void begin(State<Real>& state, const kernels::ContactArgs<Real>& a,
             const std::vector<std::uint32_t>& blocks);
  void answer(const State<Real>& state, const kernels::ContactArgs<Real>& a);
  /// True if the last pass changed no impulse on a body by more than `settled` of it.
  bool are_settled() const { return are_settled_; }
  /// Blocks of particles that touch a body, a part of those in begin().
  const std::vector<std::uint32_t>& blocks() const { return blocks_; }
  std::size_t memory_bytes() const {
    return sizeof(Touch) * touches_.capacity() + sizeof(Group) * groups_.capacity() +
           sizeof(InBlock) * in_block_.capacity() + sizeof(std::uint32_t) * blocks_.capacity();
  }

  /// Largest change of the impulse on a settled body, over the impulses of snow and of gravity.
  static constexpr double settled = 0.01;

 private:
  /// A body in the step.
  struct Seen {
    Mat3d inverse_inertia = Mat3d::Identity();
    /// Speeds at the end of the step, without contact of snow.
    Vec3d free_velocity = Vec3d::Zero(), free_spin = Vec3d::Zero();
    double gives = 1;   ///< how far it follows impulses, as a share of how far it would if nothing
                        ///< stopped it
    double weight = 0;  ///< kg m/s, of gravity in the step
    double radius = 0;  ///< m, of gyration
    int count = 0;      ///< contacts that press
    // Numbers that contacts are shown.
    Real share = 1;  ///< they give way by so many times what a free body alone would
    Vec3<Real> velocity{}, spin{};
  };
  /// A contact with a body.
  struct Touch {
    std::uint64_t contact;  ///< in ContactArgs::contacts
    std::size_t body;
    Vec3<Real> arm;    ///< m, from the body's centre of mass
    Real give, along;  ///< 1/kg: a free body gives way by so much to an impulse along the normal,
                       ///< and in both directions along the surface
  };
  /// Contacts of a block of particles with a body.
  struct Group {
    std::size_t first, end;  ///< touches
    std::size_t body;
    rigid::Push push{};
    int count = 0;  ///< that press
  };
  /// Touches of a block of particles, sorted by body.
  struct InBlock {
    std::size_t first, end;
  };
  void list_touches(const State<Real>& state, const kernels::ContactArgs<Real>& a,
                    const std::vector<std::uint32_t>& blocks);
  void list_groups(const std::vector<std::uint32_t>& blocks);
  /// work(group) by all threads.
  template <class Work>
  void over_groups(const State<Real>& state, const Work& work);
  Touch touch_of(std::uint64_t contact, std::size_t body,
                 const kernels::ContactArgs<Real>& a) const;
  void collect(const State<Real>& state, const kernels::ContactArgs<Real>& a);
  void add_up(const kernels::ContactArgs<Real>& a, Group& group) const;
  bool is_settled(std::size_t body) const;
  void find_out_what_gives();
  void show(const State<Real>& state, const kernels::ContactArgs<Real>& a);

  rigid::RigidBodies* bodies_ = nullptr;
  std::vector<int> body_of_;  ///< per collider; -1: the scene moves it
  std::vector<Seen> seen_;
  std::vector<Touch> touches_;     ///< with gaps
  std::vector<InBlock> in_block_;  ///< per block in begin()
  std::vector<Group> groups_;
  std::vector<std::uint32_t> blocks_;
  std::vector<rigid::Push> pushes_, before_;
  bool is_first_ = true;
  bool are_settled_ = false;
};

}  // namespace neve::sim::engine
