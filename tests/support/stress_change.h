#pragma once
/// The lane kernel for the change of stress, asked about one particle.

#include "sim/health/diagnostics.h"
#include "sim/laws/files.h"
#include "sim/state/method.h"
#include "sim/state/records.h"
#include "tests/support/elastic.h"

namespace neve::test {

/// dP F_E^T for dF = G F_E, in Pa, by the first of four lanes; the others hold other matrices.
template <class Real>
Mat3d stress_change_of(const sim::Material& material, const Mat3d& F_E, double J_P,
                       const Mat3d& G) {
  using V = Quad<Real>;
  const sim::kernels::MaterialConstants<Real> table[] = {sim::engine::constants_of<Real>(material)};
  sim::kernels::Record<V, Lanes<Integer<Real>, 4>> p{};
  V G_lanes[9], D[9];
  for (int q = 0; q < 9; ++q)
    for (int l = 0; l < 4; ++l) {
      const double odd = std::sin(1.0 + 5 * q + 3 * l);
      p.F_E[q][l] = static_cast<Real>(l == 0 ? F_E(q / 3, q % 3) : odd);
      G_lanes[q][l] = static_cast<Real>(l == 0 ? G(q / 3, q % 3) : 2 * odd);
    }
  p.J_P = all<V>(static_cast<Real>(J_P));
  p.V0 = p.stiffness = p.threshold = all<V>(1);
#define NEVE_CHANGE_OF_LAW(name)                                                            \
  if (material.model == sim::laws::model::name)                                             \
    sim::laws::name::InLanes::stress_change(sim::laws::name::InLanes::elasticity(p, table), \
                                            G_lanes, D);
  NEVE_LAWS(NEVE_CHANGE_OF_LAW)
#undef NEVE_CHANGE_OF_LAW
  Mat3d out;
  for (int q = 0; q < 9; ++q) out(q / 3, q % 3) = static_cast<double>(D[q][0]);
  return out;
}

}  // namespace neve::test
