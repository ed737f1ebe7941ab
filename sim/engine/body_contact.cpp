#include "sim/engine/body_contact.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace neve::sim::engine {

template <class Real>
void BodyContact<Real>::begin(State<Real>& state, const kernels::ContactArgs<Real>& a) {
  bodies_ = state.colliders.begin_bodies(state.progress.colliders_time);
  if (!bodies_) return;
  body_of_.assign(state.colliders.list().size(), -1);
  for (std::size_t b = 0; b < bodies_->size(); ++b)
    body_of_[bodies_->collider(b)] = static_cast<int>(b);
  seen_.resize(bodies_->size());
  pushes_.assign(bodies_->size(), rigid::Push{});
  bodies_->respond(static_cast<double>(a.step.constants.dt), state.method.settings.gravity,
                   pushes_);
  for (std::size_t b = 0; b < seen_.size(); ++b)
    seen_[b] = {bodies_->inertia(b).inverse(), bodies_->after(b).velocity, bodies_->after(b).spin,
                1, 0};
  is_first_ = true;
}

/// visit(body, contact, arm): the arm is from the body's centre of mass to the particle, m.
template <class Real>
template <class Visit>
void BodyContact<Real>::each_contact(const kernels::ContactArgs<Real>& a,
                                     const std::vector<std::uint32_t>& blocks,
                                     const Visit& visit) const {
  for (const std::uint32_t b : blocks)
    for (std::uint32_t k = 0; k < a.counts[b]; ++k) {
      kernels::Contact<Real>& contact = a.contacts[a.first[b] + k];
      const int body = body_of_[static_cast<std::size_t>(contact.list)];
      if (body < 0) continue;
      const auto number = contact.collider < 0 ? -1 - contact.collider : contact.collider;
      const kernels::ColliderPose& pose = a.poses[number];
      Vec3d arm = bodies_->point(static_cast<std::size_t>(body));
      for (int x = 0; x < 3; ++x)
        arm[x] += (static_cast<double>(contact.cell[x] - pose.cell[x]) +
                   (static_cast<double>(contact.offset[x]) - pose.offset[x])) *
                  a.step.constants.h_double;
      visit(static_cast<std::size_t>(body), contact, arm);
    }
}

template <class Real>
void BodyContact<Real>::collect(const kernels::ContactArgs<Real>& a,
                                const std::vector<std::uint32_t>& blocks) {
  std::fill(pushes_.begin(), pushes_.end(), rigid::Push{});
  for (Seen& seen : seen_) seen.count = 0;
  const double alpha = static_cast<double>(a.step.constants.alpha);
  each_contact(a, blocks, [&](std::size_t b, const kernels::Contact<Real>& c, const Vec3d& arm) {
    Vec3d impulse;
    for (int x = 0; x < 3; ++x)
      impulse[x] = static_cast<double>(c.mass) * alpha * static_cast<double>(c.lost[x]) -
                   static_cast<double>(c.normal[x] * c.impulse + c.sliding[x]);
    pushes_[b].impulse += impulse;
    pushes_[b].moment += arm.cross(impulse);
    // Before the first pass nobody knows which of them will press.
    seen_[b].count += is_first_ || c.impulse != Real(0) ? 1 : 0;
  });
  is_first_ = false;
}

/// The work of impulses along what they changed, as a share of what it would be on free bodies.
template <class Real>
void BodyContact<Real>::find_out_what_gives() {
  for (std::size_t b = 0; b < seen_.size(); ++b) {
    Seen& seen = seen_[b];
    const rigid::Push& push = pushes_[b];
    const double free = push.impulse.squaredNorm() / bodies_->mass(b).mass +
                        push.moment.dot(seen.inverse_inertia * push.moment);
    if (!(free > 0)) continue;
    const double done = push.impulse.dot(bodies_->after(b).velocity - seen.free_velocity) +
                        push.moment.dot(bodies_->after(b).spin - seen.free_spin);
    seen.gives = std::clamp(done / free, 0.0, 1.0);
  }
}

/// @param arm  from the centre of mass
template <class Real>
void BodyContact<Real>::show(std::size_t b, const Vec3d& arm,
                             kernels::Contact<Real>& contact) const {
  const Seen& seen = seen_[b];
  const rigid::Motion& after = bodies_->after(b);
  const Vec3d surface = after.velocity + after.spin.cross(arm);
  Vec3d normal;
  for (int x = 0; x < 3; ++x) {
    contact.surface[x] = static_cast<Real>(surface[x]);
    normal[x] = static_cast<double>(contact.normal[x]);
  }
  // n^T [r]^T I^-1 [r] n, and the sum of it over three directions.
  const Vec3d turned = arm.cross(normal);
  const double about = turned.dot(seen.inverse_inertia * turned);
  const double all =
      seen.inverse_inertia.trace() * arm.squaredNorm() - arm.dot(seen.inverse_inertia * arm);
  const double share = seen.gives * static_cast<double>(std::max<std::size_t>(seen.count, 1));
  const double inverse_mass = 1 / bodies_->mass(b).mass;
  contact.give = static_cast<Real>(share * (inverse_mass + about));
  contact.give_along = static_cast<Real>(share * (inverse_mass + std::max(all - about, 0.0)));
}

template <class Real>
void BodyContact<Real>::answer(const State<Real>& state, const kernels::ContactArgs<Real>& a,
                               const std::vector<std::uint32_t>& blocks) {
  collect(a, blocks);
  bodies_->respond(static_cast<double>(a.step.constants.dt), state.method.settings.gravity,
                   pushes_);
  find_out_what_gives();
  each_contact(a, blocks, [&](std::size_t b, kernels::Contact<Real>& contact, const Vec3d& arm) {
    show(b, arm, contact);
  });
}

template class BodyContact<float>;
template class BodyContact<double>;

}  // namespace neve::sim::engine
