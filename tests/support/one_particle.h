#pragma once
/// The lane kernels, asked about single particles.

#include <vector>

#include "sim/kernels/simd.h"
#include "sim/kernels/stages.h"

namespace neve::test {

/// Step 7's projection and stress of any particles through the kernels of a SIMD level. Their
/// materials are rows of the table.
template <class Real>
void update_materials(std::vector<sim::kernels::Particle<Real>>& particles,
                      const std::vector<sim::kernels::MaterialConstants<Real>>& table,
                      sim::kernels::SimdLevel level) {
  std::vector<std::uint64_t> keys(particles.size());
  std::vector<std::uint16_t> locals(particles.size());
  sim::kernels::SweepArgs<Real> a{};
  a.constants.materials = table.data();
  a.particles = particles.data();
  a.keys = keys.data();
  a.locals = locals.data();
  sim::kernels::BlockReport<Real> report;
  const auto& sweeps = sim::kernels::sweeps_for(level, sim::kernels::cubic_nodes,
                                                sim::kernels::TransferKind::flip, Real());
  sweeps.refresh(a, 0, static_cast<std::uint32_t>(particles.size()), true, report);
}

/// One particle, whose material is `k`, at the chosen level.
template <class Real>
void update_material(sim::kernels::Particle<Real>& p,
                     const sim::kernels::MaterialConstants<Real>& k) {
  std::vector<sim::kernels::Particle<Real>> one{p};
  update_materials(one, {k}, sim::kernels::chosen_simd_level());
  p = one[0];
}

/// Weights of one particle, per axis.
template <class Real, int K>
struct Weights {
  int base[3];
  Real w[3][K], dw[3][K], arm[3][K];
};

template <int K, class Real>
Weights<Real, K> weights_of(const sim::kernels::Particle<Real>& p) {
  using V = Quad<Real>;
  sim::kernels::Stencils<Real, K, 4> s;
  V offset[3];
  Lanes<Integer<Real>, 4> cell[3];
  for (int a = 0; a < 3; ++a) {
    offset[a] = all<V>(p.offset[a]);
    cell[a] = all<Lanes<Integer<Real>, 4>>(p.cell[a]);
  }
  s.template set<true, true>(0, offset, cell);
  Weights<Real, K> out;
  for (int a = 0; a < 3; ++a) {
    out.base[a] = static_cast<int>(sim::kernels::stencil_base<K, Real>(p.cell[a], p.offset[a]));
    for (int k = 0; k < K; ++k) {
      out.w[a][k] = s.w[a][k][0];
      out.dw[a][k] = s.dw[a][k][0];
      out.arm[a][k] = s.arm[a][k][0];
    }
  }
  return out;
}

}  // namespace neve::test
