/// Mistakes in stress, hardening and plasticity.

#include "tests/mutation/mistakes.h"

namespace neve::test {

namespace {

constexpr const char* hardening = "sim/laws/hardening.h";
constexpr const char* stretches = "sim/laws/stretches.h";
constexpr const char* snow = "sim/laws/snow.h";
constexpr const char* load = "sim/engine/load.cpp";

/// The stored stress is symmetric. For a stress that is not, forces are computed from nine numbers
/// `s`, row by row, found where particles are read.
/// @param code  sets s from t (the right tau), F and F_inverse_transposed, nine lanes each
std::vector<Edit> stress_of(const std::string& code) {
  const std::string prelude =
      "        const V* F = p.F_E;\n"
      "        const V t[9] = {p.tau[0], p.tau[3], p.tau[4], p.tau[3], p.tau[1],\n"
      "                        p.tau[5], p.tau[4], p.tau[5], p.tau[2]};\n"
      "        V s[9], inverse[9];\n"
      "        for (int i = 0; i < 3; ++i)\n"
      "          for (int j = 0; j < 3; ++j) {\n"
      "            const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;\n"
      "            const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;\n"
      "            inverse[3 * i + j] = (F[3 * i1 + j1] * F[3 * i2 + j2] -\n"
      "                                  F[3 * i1 + j2] * F[3 * i2 + j1]) / determinant(F);\n"
      "          }\n"
      "        // c = a b, or a b^T, or a^T b\n"
      "        const auto multiply = [](const V* a, int a_row, int a_column, const V* b, int "
      "b_row,\n"
      "                                 int b_column, V* c) {\n"
      "          for (int i = 0; i < 3; ++i)\n"
      "            for (int j = 0; j < 3; ++j) {\n"
      "              c[3 * i + j] = V{};\n"
      "              for (int k = 0; k < 3; ++k)\n"
      "                c[3 * i + j] += a[a_row * i + a_column * k] * b[b_row * k + b_column * j];\n"
      "            }\n"
      "        };\n"
      "        V P[9];  // tau F^-T\n"
      "        multiply(t, 3, 1, inverse, 3, 1, P);\n";
  return {
      {"sim/kernels/sweeps.h", "load_for_scatter<with_affine, has_force>(p, group.record + q);",
       "load_for_scatter<with_affine, has_force>(p, group.record + q);\n"
       "    RecordReader<V, I>(group.record + q, p).deformation();"},
      {"sim/kernels/sweeps.h",
       "      if constexpr (has_force)\n"
       "        keep(elastic_force<K, transfer>(p.V0, p.tau, c.inv_h, duration), force);",
       "      if constexpr (has_force) {\n" + prelude + code +
           "        keep(elastic_force<K, transfer>(p.V0, s, c.inv_h, duration), force);\n"
           "      }"},
      {"sim/kernels/stages.h",
       "  const V xx = tau[0], yy = tau[1], zz = tau[2], xy = tau[3], xz = tau[4], yz = tau[5];\n"
       "  return {{{{factor * xx, factor * xy, factor * xz, V{}}},\n"
       "           {{factor * xy, factor * yy, factor * yz, V{}}},\n"
       "           {{factor * xz, factor * yz, factor * zz, V{}}}}};",
       "  return {{{{factor * tau[0], factor * tau[3], factor * tau[6], V{}}},\n"
       "           {{factor * tau[1], factor * tau[4], factor * tau[7], V{}}},\n"
       "           {{factor * tau[2], factor * tau[5], factor * tau[8], V{}}}}};"}};
}

/// F - X instead of F - R: tau + 2 mu (R - X) F^T. @param x  element (i, j) of X
std::vector<Edit> rotation_replaced(const std::string& x) {
  return stress_of(
      "        (void)P;\n"
      "        const SignedSvd<V> svd = signed_svd_lanes(F);\n"
      "        V mu, R[9], S[9], off[9];\n"
      "        multiply(svd.U, 3, 1, svd.V, 1, 3, R);\n"
      "        multiply(R, 1, 3, F, 3, 1, S);\n"
      "        for (int l = 0; l < W; ++l) {\n"
      "          const auto& row = c.materials[p.material()[l]];\n"
      "          mu[l] = row.mu0, off[0][l] = row.xi;\n"
      "        }\n"
      "        mu *= exponential_lanes(off[0] * (Real(1) - p.J_P));\n"
      "        (void)S;\n"
      "        for (int i = 0; i < 3; ++i)\n"
      "          for (int j = 0; j < 3; ++j) off[3 * i + j] = R[3 * i + j] - (" +
      x +
      ");\n"
      "        multiply(off, 3, 1, F, 1, 3, s);\n"
      "        for (int k = 0; k < 9; ++k) s[k] = t[k] + Real(2) * mu * s[k];\n");
}

constexpr const char* added =
    "added to the correct stress where forces read it, with R and S from a decomposition of F_E";

constexpr const char* keep_tau =
    "tau[0] = t.xx, tau[1] = t.yy, tau[2] = t.zz, tau[3] = t.xy, tau[4] = t.xz, tau[5] = t.yz;";

/// tau times a factor in which J = det(F_E F_P).
Edit stress_times(const std::string& factor) {
  return {hardening, keep_tau,
          "const V J = determinant(F()) * J_P(), by = " + factor +
              ";\n    tau[0] = t.xx * by, tau[1] = t.yy * by, tau[2] = t.zz * by;\n"
              "    tau[3] = t.xy * by, tau[4] = t.xz * by, tau[5] = t.yz * by;"};
}

constexpr const char* initial_F = "in.F_E.empty() ? Mat3d(Mat3d::Identity()) : in.F_E[q]";
constexpr const char* initial_J_P = "p.J_P = in.J_P.empty() ? Real(1) :";
const Edit zero_J_P{load, initial_J_P, "p.J_P = in.J_P.empty() ? Real(0) :"};

/// Exponent of the hardening, times xi.
std::vector<Edit> hardening_by(const std::string& exponent) {
  return {{hardening, "exponential_lanes(word[word_xi] * (Real(1) - J_P()));",
           "exponential_lanes(word[word_xi] * (" + exponent + "));"}};
}

}  // namespace

std::vector<Mistake> stress_mistakes() {
  const std::string stored =
      "the stored stress is symmetric, so P is computed from it where forces read it";
  return {
      {"stress_P_F",
       "stress P F (F not transposed)",
       stress_of("        multiply(P, 3, 1, F, 3, 1, s);\n"),
       {},
       stored,
       true},
      {"stress_F_transposed_P",
       "stress Fᵀ P (rows for columns)",
       stress_of("        multiply(F, 1, 3, P, 3, 1, s);\n"),
       {},
       stored},
      {"stress_P",
       "stress P alone (no Fᵀ)",
       stress_of("        for (int k = 0; k < 9; ++k) s[k] = P[k];\n"),
       {},
       stored},
      {"stress_not_times_J", "V0 σ instead of J V0 σ", {stress_times("Real(1) / J")}},
      {"J_of_all_of_F",
       "J = det(F_E F_P) in λ (J − 1)",
       {{stretches, "m.set_tau(add_identity(Real(2) * mu * deviation, lambda * (J - one) * J));",
         "m.set_tau(add_identity(Real(2) * mu * deviation,\n"
         "                         lambda * (J * m.J_P() - one) * J * m.J_P()));"},
        {stretches, "pressure = lambda * (J_E - one) * J_E;",
         "pressure = lambda * (J_E * m.J_P() - one) * J_E * m.J_P();"}}},
      {"F_minus_S", "F − S instead of F − R", rotation_replaced("S[3 * i + j]"), {}, added},
      {"R_transposed", "R transposed (V Uᵀ)", rotation_replaced("R[3 * j + i]"), {}, added},
      {"R_is_I",
       "R = I (no rotation removed)",
       rotation_replaced("i == j ? V{} + Real(1) : V{}"),
       {},
       added},
      {"F_starts_at_0",
       "F_E, F_P start at 0, formula with 1/J",
       {{load, initial_F, "in.F_E.empty() ? Mat3d(Mat3d::Zero()) : in.F_E[q]"},
        zero_J_P,
        stress_times("J / J")},
       {},
       "J_P is stored instead of F_P; 1/J cancels a factor J"},
      {"F_P_starts_at_0",
       "F_P starts at 0, F_E = I",
       {zero_J_P},
       {},
       "J_P is stored instead of F_P"},
  };
}

std::vector<Mistake> plasticity_mistakes() {
  return {
      {"hardening_sign", "hardening e^(ξ (J_P − 1))", hardening_by("J_P() - Real(1)")},
      {"hardening_of_J_P", "hardening e^(ξ J_P)", hardening_by("J_P()")},
      {"hardening_of_all_of_F", "hardening with J of F instead of F_P",
       hardening_by("Real(1) - J_P() * determinant(F())")},
      {"F_P_not_updated",
       "F_E clamped, F_P never updated",
       {{snow, "  m.J_P() = is_cut ? moved : m.J_P();\n", "  (void)is_cut;\n"}}},
      {"signed_cut",
       "J_P of a particle turned inside out changes its sign",
       {{snow, "cut * (absolute_lanes(s) / clamped)", "cut * (s / clamped)"}}},
      {"clamped_to_thresholds",
       "clamp to [θ_s, θ_c] instead of [1 − θ_c, 1 + θ_s]",
       {{hardening, "= Real(1) - k[3] * p.threshold;", "= k[4] * p.threshold;"},
        {hardening, "= Real(1) + k[4] * p.threshold;", "= k[3] * p.threshold;"}}},
      {"no_plasticity",
       "no plasticity",
       {{stretches, "is_projected && Yield::yields;", "is_projected && Yield::yields && false;"}}},
  };
}

}  // namespace neve::test
