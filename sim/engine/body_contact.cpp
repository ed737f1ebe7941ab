#include "sim/engine/body_contact.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace neve::sim::engine {

namespace {

template <class Real>
Vec3<Real> narrowed(const Vec3d& v) {
  return {static_cast<Real>(v.x()), static_cast<Real>(v.y()), static_cast<Real>(v.z())};
}

}  // namespace

template <class Real>
void BodyContact<Real>::begin(State<Real>& state, const kernels::ContactArgs<Real>& a,
                              const std::vector<std::uint32_t>& blocks) {
  bodies_ = state.colliders.begin_bodies(state.progress.colliders_time);
  if (!bodies_) return;
  body_of_.assign(state.colliders.list().size(), -1);
  for (std::size_t b = 0; b < bodies_->size(); ++b)
    body_of_[bodies_->collider(b)] = static_cast<int>(b);
  seen_.resize(bodies_->size());
  pushes_.assign(bodies_->size(), rigid::Push{});
  const double dt = static_cast<double>(a.step.constants.dt);
  const Vec3d& gravity = state.method.settings.gravity;
  bodies_->respond(dt, gravity, pushes_);
  for (std::size_t b = 0; b < seen_.size(); ++b) {
    const double mass = bodies_->mass(b).mass;
    const Mat3d inertia = bodies_->inertia(b);
    Seen& seen = seen_[b] = {};
    seen.inverse_inertia = inertia.inverse();
    seen.free_velocity = bodies_->after(b).velocity;
    seen.free_spin = bodies_->after(b).spin;
    seen.weight = mass * dt * gravity.norm();
    seen.radius = std::sqrt(inertia.trace() / (3 * mass));
  }
  is_first_ = true;
  list_touches(a, blocks);
}

/// What does not change in the step.
template <class Real>
void BodyContact<Real>::list_touches(const kernels::ContactArgs<Real>& a,
                                     const std::vector<std::uint32_t>& blocks) {
  touches_.clear();
  blocks_.clear();
  for (const std::uint32_t b : blocks) {
    const std::size_t before = touches_.size();
    for (std::uint64_t k = a.first[b]; k < a.first[b] + a.counts[b]; ++k) {
      const int body = body_of_[static_cast<std::size_t>(a.contacts[k].list)];
      if (body >= 0) touches_.push_back(touch_of(k, static_cast<std::size_t>(body), a));
    }
    if (touches_.size() > before) blocks_.push_back(b);
  }
}

template <class Real>
typename BodyContact<Real>::Touch BodyContact<Real>::touch_of(
    std::uint64_t number, std::size_t body, const kernels::ContactArgs<Real>& a) const {
  const kernels::Contact<Real>& contact = a.contacts[number];
  const kernels::ColliderPose& pose =
      a.poses[contact.collider < 0 ? -1 - contact.collider : contact.collider];
  Vec3d arm = bodies_->point(body), normal;
  for (int x = 0; x < 3; ++x) {
    arm[x] += (static_cast<double>(contact.cell[x] - pose.cell[x]) +
               (static_cast<double>(contact.offset[x]) - pose.offset[x])) *
              a.step.constants.h_double;
    normal[x] = static_cast<double>(contact.normal[x]);
  }
  // n^T [r]^T I^-1 [r] n, and the sum of it over three directions.
  const Mat3d& inverse_inertia = seen_[body].inverse_inertia;
  const Vec3d turned = arm.cross(normal);
  const double about = turned.dot(inverse_inertia * turned);
  const double all = inverse_inertia.trace() * arm.squaredNorm() - arm.dot(inverse_inertia * arm);
  const double inverse_mass = 1 / bodies_->mass(body).mass;
  return {number, body, narrowed<Real>(arm), static_cast<Real>(inverse_mass + about),
          static_cast<Real>(inverse_mass + std::max(all - about, 0.0))};
}

template <class Real>
void BodyContact<Real>::collect(const kernels::ContactArgs<Real>& a) {
  std::swap(pushes_, before_);
  pushes_.assign(seen_.size(), rigid::Push{});
  for (Seen& seen : seen_) seen.count = 0;
  const Real alpha = a.step.constants.alpha;
  for (const Touch& touch : touches_) {
    const kernels::Contact<Real>& c = a.contacts[touch.contact];
    Vec3<Real> impulse;
    for (int x = 0; x < 3; ++x)
      impulse[x] = c.mass * alpha * c.lost[x] - (c.normal[x] * c.impulse + c.sliding[x]);
    const Vec3<Real> moment = cross(touch.arm, impulse);
    rigid::Push& push = pushes_[touch.body];
    for (int x = 0; x < 3; ++x) {
      push.impulse[x] += static_cast<double>(impulse[x]);
      push.moment[x] += static_cast<double>(moment[x]);
    }
    // Before the first pass nobody knows which of them will press.
    seen_[touch.body].count += is_first_ || c.impulse != Real(0) ? 1 : 0;
  }
  are_settled_ = !is_first_;
  for (std::size_t b = 0; are_settled_ && b < seen_.size(); ++b) are_settled_ = is_settled(b);
  is_first_ = false;
}

template <class Real>
bool BodyContact<Real>::is_settled(std::size_t b) const {
  const double radius = seen_[b].radius;
  const auto size = [&](const Vec3d& impulse, const Vec3d& moment) {
    return impulse.norm() + moment.norm() / radius;
  };
  const rigid::Push &now = pushes_[b], &before = before_[b];
  return size(now.impulse - before.impulse, now.moment - before.moment) <=
         settled * (size(now.impulse, now.moment) + seen_[b].weight);
}

/// The work of impulses along what they changed, as a share of what it would be on free bodies.
template <class Real>
void BodyContact<Real>::find_out_what_gives() {
  for (std::size_t b = 0; b < seen_.size(); ++b) {
    Seen& seen = seen_[b];
    const rigid::Push& push = pushes_[b];
    const double free = push.impulse.squaredNorm() / bodies_->mass(b).mass +
                        push.moment.dot(seen.inverse_inertia * push.moment);
    if (free > 0) {
      const double done = push.impulse.dot(bodies_->after(b).velocity - seen.free_velocity) +
                          push.moment.dot(bodies_->after(b).spin - seen.free_spin);
      seen.gives = std::clamp(done / free, 0.0, 1.0);
    }
    seen.share = static_cast<Real>(seen.gives) * static_cast<Real>(std::max(seen.count, 1));
    seen.velocity = narrowed<Real>(bodies_->after(b).velocity);
    seen.spin = narrowed<Real>(bodies_->after(b).spin);
  }
}

template <class Real>
void BodyContact<Real>::show(const kernels::ContactArgs<Real>& a) const {
  for (const Touch& touch : touches_) {
    kernels::Contact<Real>& contact = a.contacts[touch.contact];
    const Seen& seen = seen_[touch.body];
    const Vec3<Real> turned = cross(seen.spin, touch.arm);
    for (int x = 0; x < 3; ++x) contact.surface[x] = seen.velocity[x] + turned[x];
    contact.give = seen.share * touch.give;
    contact.give_along = seen.share * touch.along;
  }
}

template <class Real>
void BodyContact<Real>::answer(const State<Real>& state, const kernels::ContactArgs<Real>& a) {
  collect(a);
  bodies_->respond(static_cast<double>(a.step.constants.dt), state.method.settings.gravity,
                   pushes_);
  find_out_what_gives();
  show(a);
}

template class BodyContact<float>;
template class BodyContact<double>;

}  // namespace neve::sim::engine
