/// Cam clay and sand against unit_materials.json. Tolerances are the ones stated with the vectors:
/// 1e-10 of the largest value of a field, plasticity 1e-11.

#include <gtest/gtest.h>

#include "sim/health/diagnostics.h"
#include "sim/laws/list.h"
#include "sim/state/method.h"
#include "sim/state/records.h"
#include "tests/oracle/vectors.h"
#include "tests/support/one_particle.h"
#include "tests/support/simd_levels.h"
#include "tests/support/stress_change.h"

namespace {

using namespace oracle;
using namespace neve::sim;
using namespace neve::test;

const Json& vectors() {
  static const Json all = read_json(folder() / "unit_materials.json");
  return all;
}

/// body(entry, material) for the entries of laws that are here.
template <class Body>
void each_known(const char* list, const Body& body) {
  int seen = 0;
  for (const Json& entry : vectors()[list]) {
    if (!is_known(entry["material"])) continue;
    body(entry, material(entry["material"]));
    ++seen;
  }
  EXPECT_GT(seen, 0) << list;
}

template <class Real>
kernels::Particle<Real> record_of(const Material& m, const Mat3d& F_E, double J_P) {
  kernels::Particle<Real> p{};
  engine::store_matrix(F_E, p.F_E);
  p.J_P = static_cast<Real>(J_P);
  p.m = p.V0 = p.stiffness = p.threshold = 1;
  p.kind = kernels::kind_of<Real>(0, m.model, 0);
  return p;
}

template <class Real>
Mat3d stress_of(const kernels::Particle<Real>& p) {
  const Vec3d on = engine::vector(p.tau), off = engine::vector(p.tau + 3);
  Mat3d tau;
  tau << on[0], off[0], off[1], off[0], on[1], off[2], off[1], off[2], on[2];
  return tau;
}

TEST(OracleMaterials, EnergyStressAndTheirChangeAgree) {
  each_known("constitutive", [](const Json& entry, const Material& m) {
    const Mat3d F = mat3(entry["FE"]), dF = mat3(entry["dF"]);
    const double E = m.youngs_modulus;
    EXPECT_NEAR(health::energy_density(m, F, 1), entry["psi"].get<double>(), 1e-12 * E);
    RelativeError P, tau, dP;
    P.add(E, E), tau.add(E, E), dP.add(E, E);
    P.add_all(mat3(entry["P"]), health::first_piola(m, F, 1));
    tau.add_all(mat3(entry["kirchhoff"]), health::first_piola(m, F, 1) * F.transpose());
    const Mat3d G = dF * F.inverse();
    dP.add_all(mat3(entry["dP"]) * F.transpose(), stress_change_of<double>(m, F, 1, G));
    EXPECT_LE(P.value(), 1e-11);
    EXPECT_LE(tau.value(), 1e-11);
    EXPECT_LE(dP.value(), 1e-10);
    const double rho0 = entry["rho0"].get<double>();
    EXPECT_NEAR(health::wave_speed(m, F, 1, rho0), entry["sound_speed"].get<double>(), 1e-9);
  });
}

/// J_P stands for alpha here, which the vectors choose apart from F_P.
template <class Real>
void expect_projection(double tolerance) {
  each_known("plasticity", [&](const Json& entry, const Material& m) {
    SCOPED_TRACE("case " + std::to_string(entry["case"].get<int>()));
    const double alpha0 = alpha_at_rest(m);
    const double J_P = std::exp(entry["alpha"].get<double>() - alpha0);
    kernels::Particle<Real> p = record_of<Real>(m, mat3(entry["FE_trial"]), J_P);
    update_material(p, engine::constants_of<Real>(m));
    const Mat3d F = engine::matrix(p.F_E), expected = mat3(entry["FE_out"]);
    RelativeError b;
    b.add_all(Mat3d(expected * expected.transpose()), Mat3d(F * F.transpose()));
    EXPECT_LE(b.value(), tolerance);
    EXPECT_GT(F.determinant(), 0);
    EXPECT_NEAR(alpha0 + std::log(static_cast<double>(p.J_P)), entry["alpha_out"].get<double>(),
                tolerance);
    const Mat3d tau = health::first_piola(m, expected, 1) * expected.transpose();
    EXPECT_LE((stress_of(p) - tau).norm(), 10 * tolerance * m.youngs_modulus);
    if (m.model != laws::model::cam_clay) return;
    EXPECT_NEAR(laws::cam_clay::p0(m, J_P), entry["p0"].get<double>(), 1e-11 * m.youngs_modulus);
  });
}

TEST(OracleMaterials, ProjectionAgreesAlsoInverted) {
  at_every_simd_level([] {
    expect_projection<double>(1e-11);
    expect_projection<float>(1e-4);  // p0 is a small part of K
  });
}

TEST(OracleMaterials, PathsAgree) {
  each_known("paths", [](const Json& entry, const Material& m) {
    SCOPED_TRACE(entry["name"].get<std::string>());
    const Mat3d step = Mat3d::Identity() + mat3(entry["L"]);
    const double alpha0 = alpha_at_rest(m);
    kernels::Particle<double> p = record_of<double>(m, Mat3d::Identity(), 1);
    const auto rows = entry["p"].size();
    RelativeError pressure, q, alpha;
    // The error of one that is rounding is weighed against the strength.
    for (RelativeError* error : {&pressure, &q})
      error->add(m.consolidation_pressure, m.consolidation_pressure);
    alpha.add(1, 1);
    for (std::size_t k = 0; k < rows; ++k) {
      engine::store_matrix(Mat3d(step * engine::matrix(p.F_E)), p.F_E);
      update_material(p, engine::constants_of<double>(m));
      const Mat3d tau = stress_of(p);
      pressure.add(entry["p"][k].get<double>(), -tau.trace() / 3);
      q.add(entry["q"][k].get<double>(),
            std::sqrt(1.5) * (tau - tau.trace() / 3 * Mat3d::Identity()).norm());
      alpha.add(entry["alpha"][k].get<double>(), alpha0 + std::log(p.J_P));
    }
    // 1e-12 a step, and hundreds of steps.
    EXPECT_LE(pressure.value(), 1e-9);
    EXPECT_LE(q.value(), 1e-8);
    EXPECT_LE(alpha.value(), 1e-9);
  });
}

}  // namespace
