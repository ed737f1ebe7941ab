/// Splines, decompositions, stress, projection and contact of the kernels against unit.json.
/// Tolerances are the ones stated with the vectors, relative to the largest value of the field.

#include <gtest/gtest.h>

#include "sim/health/diagnostics.h"
#include "sim/laws/list.h"
#include "tests/oracle/vectors.h"
#include "tests/support/one_particle.h"
#include "tests/support/stress_change.h"

namespace {

using namespace oracle;
using namespace neve::sim;
using namespace neve::test;

const Json& unit() {
  static const Json vectors = read_json(folder() / "unit.json");
  return vectors;
}

kernels::Particle<double> particle(const Mat3d& F_E, double J_P, Model model) {
  kernels::Particle<double> p{};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) p.F_E[3 * a + b] = F_E(a, b);
  p.J_P = J_P;
  p.m = p.V0 = 1;
  p.stiffness = p.threshold = 1;
  p.kind = kernels::kind_of<double>(0, model, 0);
  return p;
}

Mat3d rows(const double* m) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m);
}

Mat3d tau_of(const kernels::Particle<double>& p) {
  Mat3d tau;
  tau << p.tau[0], p.tau[3], p.tau[4], p.tau[3], p.tau[1], p.tau[5], p.tau[4], p.tau[5], p.tau[2];
  return tau;
}

kernels::MaterialConstants<double> constants(const Json& m) {
  const Lame l = lame(m["E"].get<double>(), m["nu"].get<double>());
  return {l.mu, l.lambda, m["xi"].get<double>(), m["theta_c"].get<double>(),
          m["theta_s"].get<double>()};
}

/// Weights of both kernels at a place, as the sweeps take them.
template <int K>
void compare_weights(const Json& entry) {
  const double h = entry["h"].get<double>();
  const Vec3d origin = vec3(entry["origin"]) / h, in_cells = vec3(entry["x"]) / h;
  kernels::Particle<double> p{};
  for (int a = 0; a < 3; ++a) {
    p.cell[a] = static_cast<int>(std::floor(in_cells[a]));
    p.offset[a] = in_cells[a] - static_cast<double>(p.cell[a]);
  }
  const Weights<double, K> s = weights_of<K>(p);
  std::map<std::array<int, 3>, std::pair<double, Vec3d>> found;
  double sum = 0;
  for (int i = 0; i < K; ++i)
    for (int j = 0; j < K; ++j)
      for (int k = 0; k < K; ++k) {
        std::array<int, 3> node{s.base[0] + i, s.base[1] + j, s.base[2] + k};
        for (int a = 0; a < 3; ++a)
          node[static_cast<std::size_t>(a)] -= static_cast<int>(std::lround(origin[a]));
        const double w = s.w[0][i] * s.w[1][j] * s.w[2][k];
        found[node] = {w,
                       Vec3d(s.dw[0][i] * s.w[1][j] * s.w[2][k], s.w[0][i] * s.dw[1][j] * s.w[2][k],
                             s.w[0][i] * s.w[1][j] * s.dw[2][k]) /
                           h};
        sum += w;
      }
  EXPECT_NEAR(sum, 1, 1e-14);
  // A place on a node may have its stencil start one node to the side, where the weights are 0: so
  // every node of either must agree, and a node that one of them leaves out has 0.
  RelativeError w, grad;
  for (std::size_t q = 0; q < entry["node"].size(); ++q) {
    const auto at = found.find(entry["node"][q].get<std::array<int, 3>>());
    const auto [w_found, grad_found] =
        at == found.end() ? std::pair<double, Vec3d>{0, Vec3d::Zero()} : at->second;
    w.add(entry["w"][q].get<double>(), w_found);
    grad.add_all(vec3(entry["grad_w"][q]), grad_found);
    if (at != found.end()) found.erase(at);
  }
  for (const auto& [node, value] : found) {
    w.add(0, value.first);
    grad.add_all(Vec3d(Vec3d::Zero()), value.second);
  }
  EXPECT_LE(w.value(), 1e-13);
  EXPECT_LE(grad.value(), 1e-13);
}

TEST(OracleUnit, SplinesAndTheirDerivativesAgree) {
  for (const Json& entry : unit()["bspline"]) {
    const bool is_cubic = entry["kernel"] == "cubic";
    RelativeError N, dN;
    for (std::size_t q = 0; q < entry["x"].size(); ++q) {
      const double x = entry["x"][q].get<double>();
      // The kernels know a spline only through the stencil of a particle: node 0 seen from x.
      double w = 0, dw = 0;
      kernels::Particle<double> p{};
      p.cell[0] = static_cast<int>(std::floor(x));
      p.offset[0] = x - static_cast<double>(p.cell[0]);
      const auto look = [&](const auto& s) {
        const int k = -s.base[0];
        if (k < 0 || k >= static_cast<int>(std::size(s.w[0]))) return;
        w = s.w[0][k];
        dw = s.dw[0][k];
      };
      if (is_cubic)
        look(weights_of<kernels::cubic_nodes>(p));
      else
        look(weights_of<kernels::quadratic_nodes>(p));
      N.add(entry["N"][q].get<double>(), w);
      dN.add(entry["dN"][q].get<double>(), dw);
    }
    EXPECT_LE(N.value(), 1e-13) << entry["kernel"];
    EXPECT_LE(dN.value(), 1e-13) << entry["kernel"];
  }
}

TEST(OracleUnit, WeightsAndGradientsAgree) {
  ASSERT_FALSE(unit()["weights"].empty());
  for (const Json& entry : unit()["weights"]) {
    if (entry["kernel"] == "cubic")
      compare_weights<kernels::cubic_nodes>(entry);
    else
      compare_weights<kernels::quadratic_nodes>(entry);
  }
}

TEST(OracleUnit, LameParametersAgree) {
  RelativeError mu, lambda;
  for (const Json& entry : unit()["lame"]) {
    const Lame l = lame(entry["E"].get<double>(), entry["nu"].get<double>());
    mu.add(entry["mu"].get<double>(), l.mu);
    lambda.add(entry["lambda"].get<double>(), l.lambda);
  }
  EXPECT_LE(mu.value(), 1e-13);
  EXPECT_LE(lambda.value(), 1e-13);
}

TEST(OracleUnit, DecompositionsAgreeAlsoInvertedAndDegenerate) {
  for (const Json& entry : unit()["decomposition"]) {
    SCOPED_TRACE(entry["case"].get<std::string>());
    const Mat3d F = mat3(entry["F"]);
    const kernels::Particle<double> p = particle(F, 1, laws::model::snow);
    const kernels::SignedSvd<double> svd = kernels::signed_svd(p.F_E);
    const Mat3d U = rows(svd.U), V = rows(svd.V);
    Vec3d s(svd.s[0], svd.s[1], svd.s[2]);
    EXPECT_NEAR(U.determinant(), 1, 1e-12);
    EXPECT_NEAR(V.determinant(), 1, 1e-12);
    RelativeError whole, R, S, values;
    whole.add_all(F, Mat3d(U * s.asDiagonal() * V.transpose()));
    S.add_all(mat3(entry["S"]), Mat3d(V * s.asDiagonal() * V.transpose()));
    R.add_all(mat3(entry["R"]), Mat3d(U * V.transpose()));
    std::sort(s.data(), s.data() + 3, [](double a, double b) { return std::abs(a) > std::abs(b); });
    values.add_all(vec3(entry["singular_values"]), s);
    EXPECT_LE(whole.value(), 1e-12);
    EXPECT_LE(values.value(), 1e-12);
    EXPECT_LE(S.value(), 1e-12);
    EXPECT_LE(R.value(), 1e-12 * std::max(1.0, entry["condition_R"].get<double>()));
    EXPECT_NEAR(kernels::determinant(p.F_E), entry["det"].get<double>(),
                1e-13 * s.cwiseAbs().maxCoeff());
  }
}

TEST(OracleUnit, EnergyAndStressAgree) {
  for (const Json& entry : unit()["constitutive"]) {
    const Json& m = entry["material"];
    const bool is_neo_hookean = entry["model"] == "neo_hookean";
    Material material;
    material.model = is_neo_hookean ? laws::model::neo_hookean : laws::model::corotated;
    material.youngs_modulus = m["E"].get<double>();
    material.poisson_ratio = m["nu"].get<double>();
    material.hardening = m["xi"].get<double>();
    const Mat3d F_E = mat3(entry["FE"]);
    const double J_P = mat3(entry["FP"]).determinant(), J = F_E.determinant() * J_P;
    // Weak strain: psi and P are differences of numbers of the size of mu.
    const double scale = std::max(1.0, mat3(entry["P"]).cwiseAbs().maxCoeff());
    EXPECT_NEAR(health::energy_density(material, F_E, J_P), entry["psi"].get<double>(),
                1e-10 * std::max(1.0, entry["psi"].get<double>()));
    EXPECT_LE((health::first_piola(material, F_E, J_P) - mat3(entry["P"])).cwiseAbs().maxCoeff(),
              1e-10 * scale);
    kernels::Particle<double> p =
        particle(F_E, J_P, is_neo_hookean ? laws::model::neo_hookean : laws::model::corotated);
    update_material(p, constants(m));
    EXPECT_LE((tau_of(p) - mat3(entry["kirchhoff"])).cwiseAbs().maxCoeff(), 1e-10 * scale);
    EXPECT_LE((tau_of(p) / J - mat3(entry["cauchy"])).cwiseAbs().maxCoeff(),
              1e-10 * std::max(1.0, mat3(entry["cauchy"]).cwiseAbs().maxCoeff()));
    const Mat3d dP = mat3(entry["dP"]), G = mat3(entry["dF"]) * F_E.inverse();
    const double dP_scale = std::max((dP * F_E.transpose()).cwiseAbs().maxCoeff(),
                                     entry["mu"].get<double>() * G.cwiseAbs().maxCoeff());
    EXPECT_LE((stress_change_of<double>(material, F_E, J_P, G) - dP * F_E.transpose())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-10 * dP_scale);
    EXPECT_LE((stress_change_of<float>(material, F_E, J_P, G) - dP * F_E.transpose())
                  .cwiseAbs()
                  .maxCoeff(),
              1e-4 * dP_scale);
  }
}

/// The reference lets J_P change its sign with a negative stretch. Here such a stretch counts by
/// its size, so that J_P stays positive: it is compared with the absolute value of theirs. F_E is
/// the same.
TEST(OracleUnit, PlasticProjectionAgreesAlsoInverted) {
  for (const Json& entry : unit()["plasticity"]) {
    const double theta_c = entry["theta_c"].get<double>(), theta_s = entry["theta_s"].get<double>();
    kernels::Particle<double> p =
        particle(mat3(entry["FE_trial"]), mat3(entry["FP"]).determinant(), laws::model::snow);
    update_material(p, kernels::MaterialConstants<double>{1, 1, 10, theta_c, theta_s});
    RelativeError F_E;
    F_E.add_all(mat3(entry["FE_out"]), rows(p.F_E));
    EXPECT_LE(F_E.value(), 1e-11);
    const double J_P = entry["JP_out"].get<double>();
    EXPECT_NEAR(p.J_P, std::abs(J_P), 1e-11 * std::max(1.0, std::abs(J_P)));
    EXPECT_TRUE(tau_of(p).allFinite());
  }
}

TEST(OracleUnit, UniaxialCompressionAgrees) {
  const Json& m = unit()["uniaxial_material"];
  for (const Json& entry : unit()["uniaxial"]) {
    const double s = entry["stretch"].get<double>();
    SCOPED_TRACE(s);
    kernels::Particle<double> p = particle(Vec3d(1, s, 1).asDiagonal(), 1, laws::model::snow);
    update_material(p, constants(m));
    const Mat3d sigma = tau_of(p) / s;
    EXPECT_NEAR(p.J_P, entry["JP"].get<double>(), 1e-12);
    const double axial = entry["sigma_axial"].get<double>();
    EXPECT_NEAR(sigma(1, 1), axial, 1e-9 * std::max(1.0, std::abs(axial)));
    EXPECT_NEAR(sigma(0, 0), entry["sigma_lateral"].get<double>(),
                1e-9 * std::max(1.0, std::abs(axial)));
  }
}

TEST(OracleUnit, ContactAgrees) {
  ASSERT_FALSE(unit()["colliders"].empty());
  for (const Json& entry : unit()["colliders"]) {
    const Json& j = entry["collider"];
    SCOPED_TRACE(j["shape"].get<std::string>() + " " + j["mode"].get<std::string>());
    kernels::ColliderPose pose{};
    const bool is_plane = j["shape"] == "half_space", is_sphere = j["shape"] == "sphere";
    pose.shape = is_plane    ? kernels::ColliderShape::plane
                 : is_sphere ? kernels::ColliderShape::sphere
                             : kernels::ColliderShape::box;
    pose.contact =
        j["mode"] == "sticky" ? kernels::ContactLaw::sticky : kernels::ContactLaw::separate;
    pose.friction = j["friction"].get<double>();
    // Cells of 1 m: offsets are metres.
    for (std::size_t a = 0; a < 3; ++a) {
      pose.offset[a] = j["point"][a].get<double>();
      pose.velocity[a] = j["velocity"][a].get<double>();
      pose.omega[a] = j["omega"][a].get<double>();
      if (is_plane) pose.normal[a] = vec3(j["normal"]).normalized()[static_cast<Eigen::Index>(a)];
      if (!is_plane && !is_sphere) {
        pose.half[a] = j["half"][a].get<double>();
        for (std::size_t b = 0; b < 3; ++b)
          pose.axes[3 * a + b] = j["rotation"][a][b].get<double>();
      }
    }
    if (is_sphere) pose.radius = j["radius"].get<double>();
    const int block[3] = {0, 0, 0};
    const kernels::LocalCollider<double> local = kernels::localize<double>(pose, block, 1.0);
    RelativeError v_out;
    for (std::size_t q = 0; q < entry["x"].size(); ++q) {
      const Vec3d x = vec3(entry["x"][q]), v = vec3(entry["v"][q]);
      using V = neve::Quad<double>;
      const auto lanes = [](const Vec3d& a) {
        return neve::Vec3<V>{neve::all<V>(a[0]), neve::all<V>(a[1]), neve::all<V>(a[2])};
      };
      neve::Vec3<V> n;
      EXPECT_EQ(kernels::touch(local, lanes(x), n)[0] != 0, entry["inside"][q].get<bool>());
      if (entry["inside"][q].get<bool>()) {
        EXPECT_LE((Vec3d(n.x[0], n.y[0], n.z[0]) - vec3(entry["normal"][q])).norm(), 1e-11);
      }
      const neve::Vec3<V> out = kernels::respond(local, lanes(x), lanes(v)).v;
      v_out.add_all(vec3(entry["v_out"][q]), Vec3d(out.x[0], out.y[0], out.z[0]));
    }
    EXPECT_LE(v_out.value(), 1e-11);
  }
}

}  // namespace
