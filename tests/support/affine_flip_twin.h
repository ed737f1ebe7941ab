#pragma once
/// AFLIP and ASFLIP once more: plain loops over particles and nodes in double, written from the
/// papers, with nothing of the kernels. Free snow only: no colliders.
///
/// Source: Stomakhin et al. 2013 (splines, stress, yielding); Jiang et al. 2015 (affine velocity);
/// Fei, Guo, Wu, Huang, Gao 2021, Revisiting Integration in the Material Point Method:
///   v_p <- sum w_ip v_i^new + alpha (v_p - sum w_ip v_i^old)
///   x_p <- x_p + dt (sum w_ip v_i^new + beta_p alpha (v_p - sum w_ip v_i^old))

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "sim/simulation.h"
#include "sim/types/grid_fields.h"

namespace neve::test {

class AffineFlipTwin {
 public:
  using Vec3d = sim::Vec3d;
  using Mat3d = sim::Mat3d;

  /// @param alpha  of a step. @param particles  with volumes, F_E, J_P and C
  AffineFlipTwin(const sim::SolverSettings& settings, const sim::Material& material, double alpha,
                 const sim::ParticleArrays& particles)
      : p(particles), s_(settings), m_(material), alpha_(alpha) {
    const bool is_asflip = s_.transfer == sim::Transfer::asflip;
    beta_min_ = is_asflip ? s_.separation_min : 0;
    beta_max_ = is_asflip ? s_.separation_max : 0;
  }

  void step(double dt) {
    particles_to_grid(dt);
    grid_to_particles(dt);
  }

  /// The way back alone, from the velocities of nodes that another code found.
  void return_from(const sim::NodeFields& nodes, double dt) {
    grid_.clear();
    for (std::size_t i = 0; i < nodes.node.size(); ++i)
      grid_[key(nodes.node[i])] = {nodes.mass[i], Vec3d::Zero(), nodes.v_old[i], nodes.v_new[i]};
    grid_to_particles(dt);
  }

  /// sum m D axial(C), with D the inertia of the weights: the part of the angular momentum that C
  /// holds, N m s.
  Vec3d spin(const std::vector<Mat3d>& C) const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t q = 0; q < C.size(); ++q)
      sum += p.m[q] * inertia() *
             Vec3d(C[q](2, 1) - C[q](1, 2), C[q](0, 2) - C[q](2, 0), C[q](1, 0) - C[q](0, 1));
    return sum;
  }
  /// Returns C of the velocities of the nodes before the last step acted on them, 1/s.
  std::vector<Mat3d> affine_velocity_before() const {
    std::vector<Mat3d> all;
    for (const Vec3d& x : p.x) all.push_back(affine(x, &Node::v_old));
    return all;
  }
  /// Rasterizes, and computes no force.
  void rasterize() { particles_to_grid(0); }

  sim::ParticleArrays p;

 private:
  struct Node {
    double m = 0;
    Vec3d momentum{0, 0, 0}, v_old{0, 0, 0}, v_new{0, 0, 0};
  };
  using Key = std::array<int, 3>;
  static Key key(const sim::Vec3i& node) { return {node[0], node[1], node[2]}; }

  double inertia() const {
    return s_.cell_size * s_.cell_size / (s_.kernel == sim::Kernel::cubic ? 3 : 4);
  }

  /// N and N' at a distance in cells.
  std::array<double, 2> spline(double x) const {
    const double r = std::abs(x), sign = x < 0 ? -1 : 1;
    if (s_.kernel == sim::Kernel::quadratic) {
      if (r < 0.5) return {0.75 - r * r, -2 * x};
      if (r < 1.5) return {0.5 * (1.5 - r) * (1.5 - r), -sign * (1.5 - r)};
      return {0, 0};
    }
    if (r < 1) return {0.5 * r * r * r - r * r + 2.0 / 3, sign * (1.5 * r * r - 2 * r)};
    if (r < 2) return {(2 - r) * (2 - r) * (2 - r) / 6, -sign * 0.5 * (2 - r) * (2 - r)};
    return {0, 0};
  }

  /// body(node, w_ip, grad_w_ip, x_i - x_p) for the nodes around a place. The gradient is by x_p.
  template <class Body>
  void each_node(const Vec3d& x, const Body& body) const {
    const double h = s_.cell_size;
    const sim::Vec3i near = (x / h).array().floor().matrix().cast<int>();
    for (int i = -1; i <= 2; ++i)
      for (int j = -1; j <= 2; ++j)
        for (int k = -1; k <= 2; ++k) {
          const sim::Vec3i node = near + sim::Vec3i(i, j, k);
          const Vec3d arm = h * node.cast<double>() - x;
          std::array<double, 2> N[3];
          for (int a = 0; a < 3; ++a) N[a] = spline(-arm[a] / h);
          const double w = N[0][0] * N[1][0] * N[2][0];
          const Vec3d grad(N[0][1] * N[1][0] * N[2][0], N[0][0] * N[1][1] * N[2][0],
                           N[0][0] * N[1][0] * N[2][1]);
          if (w > 0) body(key(node), w, Vec3d(grad / h), arm);
        }
  }

  Mat3d affine(const Vec3d& x, Vec3d Node::*velocity) const {
    Mat3d C = Mat3d::Zero();
    each_node(x, [&](const Key& i, double w, const Vec3d&, const Vec3d& arm) {
      C += w * grid_.at(i).*velocity * arm.transpose();
    });
    return C / inertia();
  }

  /// P F_E^T of snow, hardened.
  Mat3d kirchhoff(const Mat3d& F, double J_P) const {
    const Eigen::JacobiSVD<Mat3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Mat3d R = svd.matrixU() * svd.matrixV().transpose();
    const double grown = std::exp(m_.hardening * (1 - J_P)), J = F.determinant();
    const double mu = grown * m_.youngs_modulus / (2 * (1 + m_.poisson_ratio));
    const double lambda = grown * m_.youngs_modulus * m_.poisson_ratio /
                          ((1 + m_.poisson_ratio) * (1 - 2 * m_.poisson_ratio));
    return 2 * mu * (F - R) * F.transpose() + lambda * (J - 1) * J * Mat3d::Identity();
  }

  void yield(Mat3d& F, double& J_P) const {
    const Eigen::JacobiSVD<Mat3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Vec3d stretch = svd.singularValues();
    const Vec3d clamped =
        stretch.cwiseMax(1 - m_.critical_compression).cwiseMin(1 + m_.critical_stretch);
    F = svd.matrixU() * clamped.asDiagonal() * svd.matrixV().transpose();
    J_P *= stretch.prod() / clamped.prod();
  }

  void particles_to_grid(double dt) {
    grid_.clear();
    std::map<Key, Vec3d> force;
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      const Mat3d tau = kirchhoff(p.F_E[q], p.J_P[q]);
      each_node(p.x[q], [&](const Key& i, double w, const Vec3d& grad, const Vec3d& arm) {
        Node& node = grid_[i];
        node.m += w * p.m[q];
        node.momentum += w * p.m[q] * (p.v[q] + p.C[q] * arm);
        auto [at, is_new] = force.try_emplace(i, Vec3d::Zero());
        at->second -= p.V0[q] * tau * grad;
      });
    }
    for (auto& [i, node] : grid_) {
      node.v_old = node.momentum / node.m;
      node.v_new = node.v_old + dt * (force.at(i) / node.m + s_.gravity);
    }
  }

  void grid_to_particles(double dt) {
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      Vec3d before = Vec3d::Zero(), after = Vec3d::Zero();
      Mat3d grad_v = Mat3d::Zero();
      each_node(p.x[q], [&](const Key& i, double w, const Vec3d& grad, const Vec3d&) {
        const Node& node = grid_.at(i);
        before += w * node.v_old;
        after += w * node.v_new;
        grad_v += node.v_new * grad.transpose();
      });
      const double beta = p.F_E[q].determinant() >= s_.separation_J_E ? beta_max_ : beta_min_;
      const Vec3d own = alpha_ * (p.v[q] - before);
      p.C[q] = affine(p.x[q], &Node::v_new);
      p.v[q] = after + own;
      p.x[q] += dt * (after + beta * own);
      p.F_E[q] = (Mat3d::Identity() + dt * grad_v) * p.F_E[q];
      yield(p.F_E[q], p.J_P[q]);
    }
  }

  sim::SolverSettings s_;
  sim::Material m_;
  double alpha_, beta_min_, beta_max_;
  std::map<Key, Node> grid_;
};

}  // namespace neve::test
