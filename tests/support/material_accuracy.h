#pragma once
/// Kernels of every SIMD level against the reference, on nasty particles.

#include <gtest/gtest.h>

#include <cstring>
#include <type_traits>

#include "tests/support/material_reference.h"
#include "tests/support/nasty_particles.h"
#include "tests/support/one_particle.h"
#include "tests/support/simd_levels.h"

namespace neve::test {

template <class Real>
Mat3d F_of(const sim::kernels::Particle<Real>& p) {
  Mat3d F;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) F(a, b) = static_cast<double>(p.F_E[3 * a + b]);
  return F;
}

template <class Real>
Mat3d tau_of(const sim::kernels::Particle<Real>& p) {
  const Real* t = p.tau;
  Mat3d tau;
  tau << t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2];
  return tau;
}

/// Largest errors of one kind of particle, in units of what a backward stable algorithm may do.
struct MaterialErrors {
  double F_E = 0, stretches = 0, J_P = 0, tau = 0;
  double broken = 0;  ///< particles with a bit changed that had to stay, or without a finite result
};

template <class Real>
class MaterialAccuracy {
 public:
  using Wide = std::conditional_t<sizeof(Real) == 4, double, long double>;
  using Particle = sim::kernels::Particle<Real>;

  /// Adds `count` particles of all kinds.
  void check(unsigned seed, int count) {
    NastyParticles<Real> nasty(seed);
    std::vector<Particle> before(static_cast<std::size_t>(count));
    std::vector<MaterialReference<Wide>> expected(before.size());
    for (std::size_t q = 0; q < before.size(); ++q) {
      before[q] = nasty.make(static_cast<int>(q) % nasty_kind_count);
      const auto material = static_cast<std::size_t>(before[q].material());
      expected[q] = material_reference<Wide>(before[q], table_[material]);
    }
    for (const sim::kernels::SimdLevel level :
         {sim::kernels::SimdLevel::baseline, sim::kernels::SimdLevel::avx2,
          sim::kernels::SimdLevel::avx512}) {
      if (!sim::kernels::is_available(level)) continue;
      std::vector<Particle> after = before;
      update_materials(after, table_, level);
      for (std::size_t q = 0; q < before.size(); ++q)
        compare(before[q], after[q], expected[q],
                errors_[static_cast<int>(level)][static_cast<int>(q) % nasty_kind_count]);
    }
  }

  const MaterialErrors& errors(sim::kernels::SimdLevel level, int kind) const {
    return errors_[static_cast<int>(level)][kind];
  }

 private:
  static void note(double& worst, double error, double unit) {
    if (error > 0) worst = std::max(worst, error / unit);
  }

  void compare(const Particle& before, const Particle& after,
               const MaterialReference<Wide>& expected, MaterialErrors& worst) {
    const Mat3d F = F_of(after), tau = tau_of(after);
    const bool has_same_bits = std::memcmp(before.F_E, after.F_E, sizeof before.F_E) == 0 &&
                               std::memcmp(&before.J_P, &after.J_P, sizeof before.J_P) == 0;
    if (expected.is_untouched && !has_same_bits) ++worst.broken;
    if (!F.allFinite() || !std::isfinite(after.J_P)) {
      ++worst.broken;
      return;
    }
    if (expected.is_undecided && has_same_bits) {
      // Found up to 8e-5 beyond the threshold in float.
      if (!((F.cast<Wide>() - expected.F_E).cwiseAbs().maxCoeff() < Wide(5e-4))) ++worst.broken;
      return;
    }
    note(worst.J_P, static_cast<double>(std::abs(static_cast<Wide>(after.J_P) - expected.J_P)),
         expected.J_P_unit);
    const auto F_wide = F.cast<Wide>().eval();
    const double F_error = static_cast<double>((F_wide - expected.F_E).cwiseAbs().maxCoeff());
    // An F_E with two opposite stretches has no unique rotation, but stretches it has.
    if (expected.F_unit < 1e-2) note(worst.F_E, F_error, expected.F_unit);
    if (!expected.is_untouched) {
      auto s = ProperSvd<Wide>(F_wide).s, c = expected.stretches;
      std::sort(s.data(), s.data() + 3);
      std::sort(c.data(), c.data() + 3);
      note(worst.stretches, static_cast<double>((s - c).cwiseAbs().maxCoeff()),
           expected.stretch_unit);
    }
    // Hardening by e^80 leaves the range of float, softening by e^-80 its normal numbers.
    const double most = sizeof(Real) == 4 ? 1e37 : 1e300;
    if (!expected.has_hardening || !(expected.tau_scale < most) || expected.tau_scale < 1 / most ||
        !std::isfinite(expected.tau_unit))
      return;
    if (!tau.allFinite()) {
      ++worst.broken;
      return;
    }
    note(worst.tau, static_cast<double>((tau.cast<Wide>() - expected.tau).cwiseAbs().maxCoeff()),
         expected.tau_unit);
  }

  std::vector<sim::kernels::MaterialConstants<Real>> table_ = nasty_materials<Real>();
  MaterialErrors errors_[3][nasty_kind_count];
};

/// The limit in units. The worst are stretches that differ by a factor of 3 and more: b has the
/// square of that in its eigenvalues, and in float the last of three sweeps leaves off-diagonal
/// entries of 1e-5.
template <class Real>
inline constexpr double material_error_limit = sizeof(Real) == 4 ? 120 : 60;

/// Prints what was found where `is_printed`, and compares it with the limit, in units.
template <class Real>
void expect_accurate(const MaterialAccuracy<Real>& accuracy, double limit, bool is_printed) {
  for (const sim::kernels::SimdLevel level :
       {sim::kernels::SimdLevel::baseline, sim::kernels::SimdLevel::avx2,
        sim::kernels::SimdLevel::avx512}) {
    if (!sim::kernels::is_available(level)) continue;
    for (int kind = 0; kind < nasty_kind_count; ++kind) {
      const MaterialErrors& e = accuracy.errors(level, kind);
      const std::string where = std::string(sizeof(Real) == 4 ? "float " : "double ") +
                                sim::kernels::name(level) + ", " + nasty_kinds[kind];
      EXPECT_LE(std::max({e.F_E, e.stretches, e.J_P, e.tau}), limit) << where;
      EXPECT_EQ(e.broken, 0) << where;
      if (is_printed)
        std::printf("%-32s F_E %6.1f  stretches %6.1f  J_P %6.1f  tau %6.1f  broken %g\n",
                    where.c_str(), e.F_E, e.stretches, e.J_P, e.tau, e.broken);
    }
  }
}

}  // namespace neve::test
