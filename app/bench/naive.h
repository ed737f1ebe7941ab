#pragma once
/// The same method as a reader of the papers would write it down first: one loop after the other
/// over Eigen matrices in double precision, a dense grid, one JacobiSVD wherever the paper asks for
/// a decomposition, one thread, no word to the compiler but -O3. The yardstick of `neve bench`.
///
/// It does not waste time on purpose: weights are evaluated once per particle and axis, the grid is
/// no larger than the snow, particles are stored in the order of the grid. It takes two SVDs per
/// particle and step: step 3 needs the rotation of F_E, step 7 the singular values of the new one.

#include <Eigen/Core>
#include <vector>

#include "sim/simulation.h"
#include "sim/types/material.h"
#include "sim/types/settings.h"

namespace neve::app::bench {

class NaiveSnow {
 public:
  /// @param settings FLIP with cubic or MLS with quadratic weights, advect = particle
  /// @param particles with volumes
  /// @throws std::invalid_argument for features that it lacks
  NaiveSnow(const sim::SolverSettings& settings, const sim::Material& material,
            const sim::ParticleArrays& particles);

  /// One step of the paper's section 4.1, explicit, without colliders.
  void step(double dt);

  /// Returns the particles in the order they came in.
  sim::ParticleArrays particles() const;

 private:
  struct Particle {
    Eigen::Vector3d x, v;
    double m, V0;
    Eigen::Matrix3d F_E, F_P, C;
  };
  struct Node {
    double m = 0;
    Eigen::Vector3d v_old{0, 0, 0};  ///< momentum until divided by the mass
    Eigen::Vector3d f{0, 0, 0};
    Eigen::Vector3d v_new{0, 0, 0};
  };
  template <int K>
  struct Stencil;

  void fit_grid();
  void particles_to_grid_flip();
  void particles_to_grid_mls();
  void update_grid(double dt);
  void grid_to_particles_flip(double dt);
  void grid_to_particles_mls(double dt);
  template <int K>
  Stencil<K> stencil_of(const Particle& p) const;
  Eigen::Matrix3d kirchhoff_stress(const Particle& p) const;
  void update_deformation(Particle& p, const Eigen::Matrix3d& grad_v, double dt) const;

  Node& node(int i, int j, int k) {
    return nodes_[(static_cast<std::size_t>(i) * size_.y() + j) * size_.z() + k];
  }

  sim::SolverSettings settings_;
  sim::Material material_;
  sim::Lame rest_;
  std::vector<Particle> particles_;
  std::vector<Node> nodes_;
  Eigen::Vector3i first_{0, 0, 0}, size_{0, 0, 0};  ///< corner of the grid and its nodes
};

}  // namespace neve::app::bench
