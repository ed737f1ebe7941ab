#include "app/bench/naive.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

namespace neve::app::bench {

namespace {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

constexpr int cubic = 4, quadratic = 3;  // nodes of a stencil on one axis

/// N(x) and N'(x), x in cells.
template <int K>
double N(double x) {
  x = std::abs(x);
  if constexpr (K == cubic) {
    if (x < 1) return (0.5 * x - 1) * x * x + 2.0 / 3;
    if (x < 2) return (2 - x) * (2 - x) * (2 - x) / 6;
  } else {
    if (x < 0.5) return 0.75 - x * x;
    if (x < 1.5) return 0.5 * (1.5 - x) * (1.5 - x);
  }
  return 0;
}

template <int K>
double dN(double x) {
  const double a = std::abs(x), sign = x < 0 ? -1 : 1;
  if constexpr (K == cubic) {
    if (a < 1) return sign * (1.5 * a - 2) * a;
    if (a < 2) return -sign * 0.5 * (2 - a) * (2 - a);
  } else {
    if (a < 0.5) return -2 * x;
    if (a < 1.5) return -sign * (1.5 - a);
  }
  return 0;
}

}  // namespace

/// The nodes that a particle touches, from `first` on, and their weights by axis.
template <int K>
struct NaiveSnow::Stencil {
  Eigen::Vector3i first;     ///< in the grid
  Vec3 from_particle;        ///< place of the first node minus x_p, m
  double w[3][K], dw[3][K];  ///< N, and dN/dx in 1/m

  double weight(int i, int j, int k) const { return w[0][i] * w[1][j] * w[2][k]; }
  Vec3 gradient(int i, int j, int k) const {
    return Vec3(dw[0][i] * w[1][j] * w[2][k], w[0][i] * dw[1][j] * w[2][k],
                w[0][i] * w[1][j] * dw[2][k]);
  }
};

template <int K>
NaiveSnow::Stencil<K> NaiveSnow::stencil_of(const Particle& p) const {
  const double h = settings_.cell_size;
  Stencil<K> s;
  for (int axis = 0; axis < 3; ++axis) {
    const double in_cells = p.x[axis] / h;
    const int base = static_cast<int>(std::floor(K == cubic ? in_cells - 1 : in_cells - 0.5));
    s.first[axis] = base - first_[axis];
    s.from_particle[axis] = base * h - p.x[axis];
    for (int k = 0; k < K; ++k) {
      s.w[axis][k] = N<K>(in_cells - (base + k));
      s.dw[axis][k] = dN<K>(in_cells - (base + k)) / h;
    }
  }
  return s;
}

NaiveSnow::NaiveSnow(const sim::SolverSettings& settings, const sim::Material& material,
                     const sim::ParticleArrays& in)
    : settings_(settings),
      material_(material),
      rest_(sim::lame(material.youngs_modulus, material.poisson_ratio)) {
  const bool is_flip =
      settings.transfer == sim::Transfer::flip && settings.kernel == sim::Kernel::cubic;
  const bool is_mls =
      settings.transfer == sim::Transfer::mls && settings.kernel == sim::Kernel::quadratic;
  if (!(is_flip || is_mls) || settings.advect != sim::Advect::particle ||
      material.model != sim::Model{})
    throw std::invalid_argument("the naive code has only FLIP cubic and MLS quadratic snow");
  if (in.V0.size() != in.x.size()) throw std::invalid_argument("the naive code needs volumes");
  for (std::size_t q = 0; q < in.x.size(); ++q)
    particles_.push_back(
        {in.x[q], in.v[q], in.m[q], in.V0[q], Mat3::Identity(), Mat3::Identity(), Mat3::Zero()});
}

void NaiveSnow::step(double dt) {
  fit_grid();
  if (settings_.transfer == sim::Transfer::flip) {
    particles_to_grid_flip();
    update_grid(dt);
    grid_to_particles_flip(dt);
  } else {
    particles_to_grid_mls();
    update_grid(dt);
    grid_to_particles_mls(dt);
  }
}

/// A dense grid that covers the particles and two cells around them, cleared.
void NaiveSnow::fit_grid() {
  Vec3 low = particles_.front().x, high = low;
  for (const Particle& p : particles_) {
    low = low.cwiseMin(p.x);
    high = high.cwiseMax(p.x);
  }
  const double h = settings_.cell_size;
  for (int axis = 0; axis < 3; ++axis) {
    first_[axis] = static_cast<int>(std::floor(low[axis] / h)) - 2;
    size_[axis] = static_cast<int>(std::floor(high[axis] / h)) + 4 - first_[axis];
  }
  nodes_.assign(static_cast<std::size_t>(size_.x()) * size_.y() * size_.z(), Node{});
}

/// Hardened stress of the paper times J: tau = 2 mu (F_E - R) F_E^T + lambda (J_E - 1) J_E I.
Mat3 NaiveSnow::kirchhoff_stress(const Particle& p) const {
  const double hardening = std::exp(material_.hardening * (1 - p.F_P.determinant()));
  const Eigen::JacobiSVD<Mat3> svd(p.F_E, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 R = svd.matrixU() * svd.matrixV().transpose();
  const double J_E = p.F_E.determinant();
  return hardening * (2 * rest_.mu * (p.F_E - R) * p.F_E.transpose() +
                      rest_.lambda * (J_E - 1) * J_E * Mat3::Identity());
}

/// Steps 1 and 3 of the paper: mass, momentum and f_i = -sum V0 tau grad_w_ip.
void NaiveSnow::particles_to_grid_flip() {
  for (const Particle& p : particles_) {
    const Stencil<cubic> s = stencil_of<cubic>(p);
    const Mat3 V0_tau = p.V0 * kirchhoff_stress(p);
    for (int i = 0; i < cubic; ++i)
      for (int j = 0; j < cubic; ++j)
        for (int k = 0; k < cubic; ++k) {
          Node& n = node(s.first.x() + i, s.first.y() + j, s.first.z() + k);
          const double w_m = s.weight(i, j, k) * p.m;
          n.m += w_m;
          n.v_old += w_m * p.v;
          n.f -= V0_tau * s.gradient(i, j, k);
        }
  }
}

/// The same for MLS (Hu et al. 2018): affine momentum, and w_ip (x_i - x_p) 4/h^2 for the gradient.
void NaiveSnow::particles_to_grid_mls() {
  const double h = settings_.cell_size;
  for (const Particle& p : particles_) {
    const Stencil<quadratic> s = stencil_of<quadratic>(p);
    const Mat3 V0_tau = p.V0 * 4 / (h * h) * kirchhoff_stress(p);
    for (int i = 0; i < quadratic; ++i)
      for (int j = 0; j < quadratic; ++j)
        for (int k = 0; k < quadratic; ++k) {
          Node& n = node(s.first.x() + i, s.first.y() + j, s.first.z() + k);
          const double w = s.weight(i, j, k);
          const Vec3 arm = s.from_particle + h * Vec3(i, j, k);
          n.m += w * p.m;
          n.v_old += w * p.m * (p.v + p.C * arm);
          n.f -= w * (V0_tau * arm);
        }
  }
}

/// Step 4: v = v_old + dt (f / m + g).
void NaiveSnow::update_grid(double dt) {
  for (Node& n : nodes_) {
    if (!(n.m > 0)) continue;
    n.v_old /= n.m;
    n.v_new = n.v_old + dt * (n.f / n.m + settings_.gravity);
  }
}

/// Step 7: trial F_E, singular values clamped, the rest of F into F_P (equations 11 and 12).
void NaiveSnow::update_deformation(Particle& p, const Mat3& grad_v, double dt) const {
  const Mat3 F_E = (Mat3::Identity() + dt * grad_v) * p.F_E;
  const Mat3 F = F_E * p.F_P;
  const Eigen::JacobiSVD<Mat3> svd(F_E, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 s = svd.singularValues()
                     .cwiseMax(1 - material_.critical_compression)
                     .cwiseMin(1 + material_.critical_stretch);
  p.F_E = svd.matrixU() * s.asDiagonal() * svd.matrixV().transpose();
  p.F_P = svd.matrixV() * s.cwiseInverse().asDiagonal() * svd.matrixU().transpose() * F;
}

/// Steps 7, 8 and 10.
void NaiveSnow::grid_to_particles_flip(double dt) {
  const double alpha = settings_.flip_reference_dt > 0
                           ? std::pow(settings_.flip_ratio, dt / settings_.flip_reference_dt)
                           : settings_.flip_ratio;
  for (Particle& p : particles_) {
    const Stencil<cubic> s = stencil_of<cubic>(p);
    Vec3 v_pic = Vec3::Zero(), v_flip = p.v;
    Mat3 grad_v = Mat3::Zero();
    for (int i = 0; i < cubic; ++i)
      for (int j = 0; j < cubic; ++j)
        for (int k = 0; k < cubic; ++k) {
          const Node& n = node(s.first.x() + i, s.first.y() + j, s.first.z() + k);
          const double w = s.weight(i, j, k);
          v_pic += w * n.v_new;
          v_flip += w * (n.v_new - n.v_old);
          grad_v += n.v_new * s.gradient(i, j, k).transpose();
        }
    update_deformation(p, grad_v, dt);
    p.v = (1 - alpha) * v_pic + alpha * v_flip;
    p.x += dt * p.v;
  }
}

/// Steps 7, 8 and 10 for MLS: C is the gradient too.
void NaiveSnow::grid_to_particles_mls(double dt) {
  const double h = settings_.cell_size;
  for (Particle& p : particles_) {
    const Stencil<quadratic> s = stencil_of<quadratic>(p);
    Vec3 v = Vec3::Zero();
    Mat3 B = Mat3::Zero();
    for (int i = 0; i < quadratic; ++i)
      for (int j = 0; j < quadratic; ++j)
        for (int k = 0; k < quadratic; ++k) {
          const Node& n = node(s.first.x() + i, s.first.y() + j, s.first.z() + k);
          const Vec3 w_v = s.weight(i, j, k) * n.v_new;
          v += w_v;
          B += w_v * (s.from_particle + h * Vec3(i, j, k)).transpose();
        }
    p.v = v;
    p.C = 4 / (h * h) * B;
    update_deformation(p, p.C, dt);
    p.x += dt * p.v;
  }
}

sim::ParticleArrays NaiveSnow::particles() const {
  sim::ParticleArrays out;
  for (const Particle& p : particles_) {
    out.x.push_back(p.x);
    out.v.push_back(p.v);
    out.m.push_back(p.m);
    out.V0.push_back(p.V0);
    out.F_E.push_back(p.F_E);
    out.J_P.push_back(p.F_P.determinant());
    out.C.push_back(p.C);
    out.material.push_back(0);
  }
  return out;
}

}  // namespace neve::app::bench
