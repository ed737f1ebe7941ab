#pragma once
/// Each stage of the step once, as an inline kernel on one particle or one node. Both drivers call
/// these, so a stage cannot differ between them. Numbers are the paper's steps (section 4).

#include "sim/kernels.h"

namespace neve::sim {

template <class Real>
NEVE_INLINE Quad<Real> quad(const Real* xyz, Real w = Real(0)) {
  return Quad<Real>{xyz[0], xyz[1], xyz[2], w};
}

// ---- transfers: reusable scatter and gather -----------------------------------------------------

/// tile += sum over the stencil of w_ip value, value in four channels.
template <class Real, int K>
NEVE_INLINE void scatter_value(const Weights<Real, K>& s, int first, Quad<Real> value,
                               Quad<Real>* tile) {
  for (int i = 0; i < K; ++i) {
    for (int j = 0; j < K; ++j) {
      const Quad<Real> row = value * (s.w[0][i] * s.w[1][j]);
      Quad<Real>* node = tile + first + Tile<K>::node(i, j, 0);
      for (int k = 0; k < K; ++k) node[k] += row * s.w[2][k];
    }
  }
}

/// tile += sum of A g_ip, with A given by columns and g_ip the product weights in which one axis
/// takes g instead of w: the gradient of w_ip (g = N'/h) or w_ip (x_i - x_p) (g = arm).
template <class Real, int K>
NEVE_INLINE void scatter_tensor(const Weights<Real, K>& s, const Real (&g)[3][K], int first,
                                Quad<Real> A0, Quad<Real> A1, Quad<Real> A2, Quad<Real>* tile) {
  for (int i = 0; i < K; ++i) {
    for (int j = 0; j < K; ++j) {
      const Quad<Real> across = A0 * (g[0][i] * s.w[1][j]) + A1 * (s.w[0][i] * g[1][j]);
      const Quad<Real> along = A2 * (s.w[0][i] * s.w[1][j]);
      Quad<Real>* node = tile + first + Tile<K>::node(i, j, 0);
      for (int k = 0; k < K; ++k) node[k] += across * s.w[2][k] + along * g[2][k];
    }
  }
}

/// Columns of sum v_i g_ip^T, and sum w_ip v_i, over the stencil.
template <class Real>
struct ValueAndTensor {
  Quad<Real> value{}, column[3]{};
};
template <class Real, int K>
NEVE_INLINE ValueAndTensor<Real> gather_tensor(const Weights<Real, K>& s, const Real (&g)[3][K],
                                               int first, const Quad<Real>* tile) {
  ValueAndTensor<Real> out;
  for (int i = 0; i < K; ++i) {
    Quad<Real> plane{}, plane_y{}, plane_z{};
    for (int j = 0; j < K; ++j) {
      const Quad<Real>* node = tile + first + Tile<K>::node(i, j, 0);
      Quad<Real> row{}, row_z{};
      for (int k = 0; k < K; ++k) {
        row += node[k] * s.w[2][k];
        row_z += node[k] * g[2][k];
      }
      plane += row * s.w[1][j];
      plane_y += row * g[1][j];
      plane_z += row_z * s.w[1][j];
    }
    out.value += plane * s.w[0][i];
    out.column[0] += plane * g[0][i];
    out.column[1] += plane_y * s.w[0][i];
    out.column[2] += plane_z * s.w[0][i];
  }
  return out;
}

/// sum w_ip value_i over the stencil.
template <class Real, int K>
NEVE_INLINE Quad<Real> gather_value(const Weights<Real, K>& s, int first, const Quad<Real>* tile) {
  Quad<Real> out{};
  for (int i = 0; i < K; ++i) {
    Quad<Real> plane{};
    for (int j = 0; j < K; ++j) {
      const Quad<Real>* node = tile + first + Tile<K>::node(i, j, 0);
      Quad<Real> row{};
      for (int k = 0; k < K; ++k) row += node[k] * s.w[2][k];
      plane += row * s.w[1][j];
    }
    out += plane * s.w[0][i];
  }
  return out;
}

template <class Real>
NEVE_INLINE void store_columns(const Quad<Real>* column, Real scale, Real* matrix) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) matrix[3 * a + b] = column[b][a] * scale;
}

// ---- particle to node ---------------------------------------------------------------------------

/// Step 1: mass and momentum; APIC and MLS carry v_p + C (x_i - x_p).
template <class Real, int K, TransferKind transfer>
NEVE_INLINE void rasterize(const Particle<Real>& p, const Weights<Real, K>& s, int first, Real h,
                           Quad<Real>* tile) {
  scatter_value(s, first, quad(p.v, Real(1)) * p.m, tile);
  if constexpr (transfer != TransferKind::flip) {
    const Real scale = p.m * h;
    const Quad<Real> A0{p.C[0] * scale, p.C[3] * scale, p.C[6] * scale, 0};
    const Quad<Real> A1{p.C[1] * scale, p.C[4] * scale, p.C[7] * scale, 0};
    const Quad<Real> A2{p.C[2] * scale, p.C[5] * scale, p.C[8] * scale, 0};
    scatter_tensor(s, s.arm, first, A0, A1, A2, tile);
  }
}

/// Step 3: f_i = -sum V0 tau grad_w_ip (the paper, equation 6, with J cancelled). MLS replaces
/// grad_w_ip by w_ip (x_i - x_p) / D (Hu et al. 2018).
template <class Real, int K, TransferKind transfer>
NEVE_INLINE void elastic_forces(const Particle<Real>& p, const Weights<Real, K>& s, int first,
                                Real inv_h, Quad<Real>* tile) {
  constexpr bool is_mls = transfer == TransferKind::mls;
  const Real scale = -p.V0 * inv_h * (is_mls ? Real(1 / apic_inertia<K>) : Real(1));
  const Real xx = p.tau[0] * scale, yy = p.tau[1] * scale, zz = p.tau[2] * scale;
  const Real xy = p.tau[3] * scale, xz = p.tau[4] * scale, yz = p.tau[5] * scale;
  const Quad<Real> A0{xx, xy, xz, 0}, A1{xy, yy, yz, 0}, A2{xz, yz, zz, 0};
  if constexpr (is_mls) {
    scatter_tensor(s, s.arm, first, A0, A1, A2, tile);
  } else {
    scatter_tensor(s, s.dw, first, A0, A1, A2, tile);
  }
}

/// Step 2, once per body: rho_p = sum m_i w_ip / h^3, V0 = m_p / rho_p.
template <class Real, int K>
NEVE_INLINE Real estimated_volume(const Particle<Real>& p, const Weights<Real, K>& s, int first,
                                  Real h, const Quad<Real>* momentum) {
  const Real mass = gather_value(s, first, momentum)[3];
  return p.m * (h * h * h) / mass;
}

// ---- nodes --------------------------------------------------------------------------------------

/// v_old = momentum / mass; 0 where no mass arrived. The fourth lane keeps the mass.
template <class Real>
NEVE_INLINE Quad<Real> node_v_old(Quad<Real> momentum) {
  const Real mass = momentum[3];
  if (!(mass > Real(0))) return Quad<Real>{};
  Quad<Real> v = momentum / mass;
  v[3] = mass;
  return v;
}

/// Step 4: v_free = v_old + dt (f / m + g).
template <class Real>
NEVE_INLINE Quad<Real> node_v_free(Quad<Real> v_old, Quad<Real> force,
                                   const StepConstants<Real>& c) {
  const Real mass = v_old[3];
  if (!(mass > Real(0))) return Quad<Real>{};
  Quad<Real> v = v_old + (force / mass + quad(c.gravity)) * c.dt;
  v[3] = mass;
  return v;
}

/// Kinetic energy that a change of velocity added, J; 0 where it took some.
template <class Real>
NEVE_INLINE double energy_gained(Real mass, const Vec3<Real>& before, const Vec3<Real>& after) {
  const double gained =
      0.5 * static_cast<double>(mass) *
      (static_cast<double>(dot(after, after)) - static_cast<double>(dot(before, before)));
  return gained > 0 ? gained : 0;
}

/// Steps 5 and 9: contact at a place r in the block, collider after collider.
template <class Real>
NEVE_INLINE Quad<Real> collide(Quad<Real> v_in, Real mass, const Vec3<Real>& r,
                               const LocalCollider<Real>* colliders, int count, double& work) {
  if (count == 0) return v_in;
  const Vec3<Real> before{v_in[0], v_in[1], v_in[2]};
  Vec3<Real> v = before;
  for (int k = 0; k < count; ++k) v = respond(colliders[k], r, v);
  work += energy_gained(mass, before, v);
  return Quad<Real>{v.x, v.y, v.z, v_in[3]};
}

// ---- node to particle ---------------------------------------------------------------------------

/// What steps 7 and 8 need from the grid.
template <class Real, int K, TransferKind transfer>
NEVE_INLINE Gathered<Real> gather(const Weights<Real, K>& s, int first, Real inv_h,
                                  const Quad<Real>* v_new, const Quad<Real>* change) {
  constexpr Real arm_scale = Real(1 / apic_inertia<K>);
  Gathered<Real> out{};
  if constexpr (transfer == TransferKind::mls) {
    const ValueAndTensor<Real> t = gather_tensor(s, s.arm, first, v_new);
    out.v = t.value;
    store_columns(t.column, inv_h * arm_scale, out.C);
    for (int q = 0; q < 9; ++q) out.grad_v[q] = out.C[q];
  } else {
    const ValueAndTensor<Real> t = gather_tensor(s, s.dw, first, v_new);
    out.v = t.value;
    store_columns(t.column, inv_h, out.grad_v);
    if constexpr (transfer == TransferKind::apic) {
      const ValueAndTensor<Real> affine = gather_tensor(s, s.arm, first, v_new);
      store_columns(affine.column, inv_h * arm_scale, out.C);
    } else {
      out.change = gather_value(s, first, change);
    }
  }
  return out;
}

/// Step 7, first half: trial F_E = (I + dt grad_v) F_E.
template <class Real>
NEVE_INLINE void strain(Particle<Real>& p, const Real* grad_v, Real dt) {
  Real F[9];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      F[3 * a + b] =
          p.F_E[3 * a + b] + dt * (grad_v[3 * a] * p.F_E[b] + grad_v[3 * a + 1] * p.F_E[3 + b] +
                                   grad_v[3 * a + 2] * p.F_E[6 + b]);
  for (int q = 0; q < 9; ++q) p.F_E[q] = F[q];
}

/// Step 7, second half: projection and stress of a group, and what the report wants to know of
/// them.
template <class Real>
NEVE_INLINE void project(Particle<Real>* const* group, int count, const StepConstants<Real>& c,
                         BlockReport<Real>& report) {
  MaterialResponse<Real> responses[group_size];
  update_materials(group, count, c.materials, true, responses);
  for (int q = 0; q < count; ++q) {
    const Particle<Real>& p = *group[q];
    if (responses[q].is_inverted) {
      report.inverted += 1;
      if (static_cast<ModelKind>(p.model) != ModelKind::snow) report.inverted_unprojected += 1;
    }
    report.max_sound_squared =
        larger(report.max_sound_squared, responses[q].wave_modulus * p.V0 / p.m);
    report.min_J_P = smaller(report.min_J_P, p.J_P);
    report.max_J_P = larger(report.max_J_P, p.J_P);
  }
}

/// Step 8: FLIP v_p = (1 - alpha) PIC + alpha (v_p + change); APIC and MLS take v and C.
template <class Real, TransferKind transfer>
NEVE_INLINE Quad<Real> particle_velocity(Particle<Real>& p, const Gathered<Real>& g, Real alpha) {
  if constexpr (transfer == TransferKind::flip) {
    return g.v * (Real(1) - alpha) + (quad(p.v) + g.change) * alpha;
  } else {
    for (int q = 0; q < 9; ++q) p.C[q] = g.C[q];
    return g.v;
  }
}

/// Where a particle is, from the first node of its block, m.
template <class Real>
NEVE_INLINE Vec3<Real> place_in_block(const Particle<Real>& p, const int* block_cell, Real h) {
  Vec3<Real> r;
  for (int a = 0; a < 3; ++a)
    r[a] = (static_cast<Real>(p.cell[a] - block_cell[a]) + p.offset[a]) * h;
  return r;
}

/// Key of the block that the particle's stencil starts in, and the code of its cell and model.
template <class Real, int K>
NEVE_INLINE bool locate(const Particle<Real>& p, std::uint64_t& key, std::uint16_t& local) {
  int base[3];
  bool is_inside = true;
  for (int a = 0; a < 3; ++a) {
    base[a] = stencil_base<K>(p.cell[a], p.offset[a]);
    const int block = base[a] >> 2;
    is_inside = is_inside && block > -block_limit && block < block_limit;
  }
  if (!is_inside) return false;
  key = block_key(base[0] >> 2, base[1] >> 2, base[2] >> 2);
  local = static_cast<std::uint16_t>(p.model << 6 | (base[0] & 3) << 4 | (base[1] & 3) << 2 |
                                     (base[2] & 3));
  return true;
}

/// Step 10: x_p += dt v, in cells and offsets. A particle that would leave the lattice or whose
/// velocity is no number stays where it is and is reported.
template <class Real, int K>
NEVE_INLINE void move(Particle<Real>& p, Quad<Real> v, Real dt_over_h, BlockReport<Real>& report,
                      std::uint64_t& key, std::uint16_t& local) {
  constexpr Real farthest = Real(1 << 20);
  Particle<Real> moved = p;
  for (int a = 0; a < 3; ++a) {
    const Real x = p.offset[a] + dt_over_h * v[a];
    if (!(absolute(x) < farthest)) {
      if (is_finite(x))
        report.overflowed += 1;
      else
        report.not_finite += 1;
      return;
    }
    const int whole = floor_to_int(x);
    Real rest = x - static_cast<Real>(whole);
    int carry = 0;
    if (rest >= Real(1)) {  // a tiny negative x rounds up to the next cell
      rest = 0;
      carry = 1;
    }
    moved.cell[a] = p.cell[a] + whole + carry;
    moved.offset[a] = rest;
  }
  if (!locate<Real, K>(moved, key, local)) {
    report.overflowed += 1;
    return;
  }
  for (int a = 0; a < 3; ++a) {
    p.cell[a] = moved.cell[a];
    p.offset[a] = moved.offset[a];
  }
}

}  // namespace neve::sim
