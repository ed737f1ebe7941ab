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
  list_touches(state, a, blocks);
}

/// Lists the contacts with bodies, and of each all that does not change in the step.
template <class Real>
void BodyContact<Real>::list_touches(const State<Real>& state, const kernels::ContactArgs<Real>& a,
                                     const std::vector<std::uint32_t>& blocks) {
  in_block_.resize(blocks.size());
  std::size_t most = 0;
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    in_block_[n].first = most;
    most += a.counts[blocks[n]];
  }
  if (touches_.size() < most) touches_.resize(most);
  const auto list_block = [&](std::size_t n) {
    const std::uint32_t b = blocks[n];
    std::size_t end = in_block_[n].first;
    bool is_mixed = false;
    for (std::uint64_t k = a.first[b]; k < a.first[b] + a.counts[b]; ++k) {
      const int body = body_of_[static_cast<std::size_t>(a.contacts[k].list)];
      if (body < 0) continue;
      touches_[end++] = touch_of(k, static_cast<std::size_t>(body), a);
      is_mixed = is_mixed || touches_[end - 1].body != touches_[in_block_[n].first].body;
    }
    in_block_[n].end = end;
    if (is_mixed)
      std::sort(touches_.data() + in_block_[n].first, touches_.data() + end,
                [](const Touch& x, const Touch& y) {
                  return std::pair(x.body, x.contact) < std::pair(y.body, y.contact);
                });
  };
  state.pool->ranges(blocks.size(), state.active_threads(),
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t n = begin; n < end; ++n) list_block(n);
                     });
  list_groups(blocks);
}

template <class Real>
void BodyContact<Real>::list_groups(const std::vector<std::uint32_t>& blocks) {
  groups_.clear();
  blocks_.clear();
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    const InBlock in = in_block_[n];
    if (in.first == in.end) continue;
    blocks_.push_back(blocks[n]);
    const auto body_at = [&](std::size_t k) { return touches_[k].body; };
    for (std::size_t k = in.first; k < in.end;) {
      std::size_t end = in.end;
      if (body_at(k) != body_at(in.end - 1))
        for (end = k + 1; body_at(end) == body_at(k);) ++end;
      groups_.push_back({k, end, body_at(k)});
      k = end;
    }
  }
}

template <class Real>
template <class Work>
void BodyContact<Real>::over_groups(const State<Real>& state, const Work& work) {
  state.pool->ranges(groups_.size(), state.active_threads(),
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t n = begin; n < end; ++n) work(groups_[n]);
                     });
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
void BodyContact<Real>::collect(const State<Real>& state, const kernels::ContactArgs<Real>& a) {
  over_groups(state, [&](Group& group) { add_up(a, group); });
  std::swap(pushes_, before_);
  pushes_.assign(seen_.size(), rigid::Push{});
  for (Seen& seen : seen_) seen.count = 0;
  for (const Group& group : groups_) {
    pushes_[group.body].impulse += group.push.impulse;
    pushes_[group.body].moment += group.push.moment;
    seen_[group.body].count += group.count;
  }
  are_settled_ = !is_first_;
  for (std::size_t b = 0; are_settled_ && b < seen_.size(); ++b) are_settled_ = is_settled(b);
  is_first_ = false;
}

template <class Real>
void BodyContact<Real>::add_up(const kernels::ContactArgs<Real>& a, Group& group) const {
  const Real alpha = a.step.constants.alpha;
  rigid::Push push;
  group.count = 0;
  for (std::size_t k = group.first; k < group.end; ++k) {
    const Touch& touch = touches_[k];
    const kernels::Contact<Real>& c = a.contacts[touch.contact];
    Vec3<Real> impulse;
    for (int x = 0; x < 3; ++x)
      impulse[x] = c.mass * alpha * c.lost[x] - (c.normal[x] * c.impulse + c.sliding[x]);
    const Vec3<Real> moment = cross(touch.arm, impulse);
    for (int x = 0; x < 3; ++x) {
      push.impulse[x] += static_cast<double>(impulse[x]);
      push.moment[x] += static_cast<double>(moment[x]);
    }
    // Nobody knows before the first pass which of them will press.
    group.count += is_first_ || c.impulse != Real(0) ? 1 : 0;
  }
  group.push = push;
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
void BodyContact<Real>::show(const State<Real>& state, const kernels::ContactArgs<Real>& a) {
  over_groups(state, [&](const Group& group) {
    const Seen& seen = seen_[group.body];
    for (std::size_t k = group.first; k < group.end; ++k) {
      const Touch& touch = touches_[k];
      kernels::Contact<Real>& contact = a.contacts[touch.contact];
      const Vec3<Real> turned = cross(seen.spin, touch.arm);
      for (int x = 0; x < 3; ++x) contact.surface[x] = seen.velocity[x] + turned[x];
      contact.give = seen.share * touch.give;
      contact.give_along = seen.share * touch.along;
    }
  });
}

template <class Real>
void BodyContact<Real>::answer(const State<Real>& state, const kernels::ContactArgs<Real>& a) {
  collect(state, a);
  bodies_->respond(static_cast<double>(a.step.constants.dt), state.method.settings.gravity,
                   pushes_);
  find_out_what_gives();
  show(state, a);
}

template class BodyContact<float>;
template class BodyContact<double>;

}  // namespace neve::sim::engine
