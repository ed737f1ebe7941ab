#pragma once
/// Reference results of materials for one particle, by Eigen in a wider type, and how far rounding
/// may lead a kernel away from it.

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/laws/list.h"
#include "sim/laws/stretches.h"
#include "sim/types/math.h"

namespace neve::test {

/// Projection and stress in the type Wide. Every `_unit` is the error that a backward stable
/// algorithm may make at most: that of relative changes by one unit roundoff of Real in the input
/// and in each result.
template <class Wide>
struct MaterialReference {
  using Mat = Eigen::Matrix<Wide, 3, 3>;
  using Vec = Eigen::Matrix<Wide, 3, 1>;
  Mat F_E, tau;
  Wide J_P;
  Vec stretches;  ///< of F_E after projection, in the order of those before
  double F_unit, stretch_unit, J_P_unit, tau_unit;
  double tau_scale;    ///< largest term of tau, Pa
  bool has_hardening;  ///< J_P is known well enough for e^(xi (1 - J_P))
  /// Two stretches lie so close to a threshold that det(hi^2 - b), say, is all rounding, and its
  /// sign tells nothing: a particle next to the identity may pass unprojected.
  bool is_undecided;
  bool is_untouched;  ///< snow well inside the thresholds, or no snow: F_E and J_P keep their bits
};

/// F = U diag(s) V^T with proper rotations.
template <class Wide>
struct ProperSvd {
  Eigen::Matrix<Wide, 3, 3> U, V;
  Eigen::Matrix<Wide, 3, 1> s;

  explicit ProperSvd(const Eigen::Matrix<Wide, 3, 3>& F) {
    // Kept: the compiler finds a local one uninitialised, as it is where F is not finite.
    static Eigen::JacobiSVD<Eigen::Matrix<Wide, 3, 3>> svd;
    svd.compute(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    U = svd.matrixU(), V = svd.matrixV(), s = svd.singularValues();
    if (U.determinant() < 0) U.col(2) = -U.col(2), s[2] = -s[2];
    if (V.determinant() < 0) V.col(2) = -V.col(2), s[2] = -s[2];
  }
};

/// The largest slopes of the isotropic functions F -> F' and F -> tau, times |F|. With stretches s
/// that become c, an error E of F changes F' = U c V^T along U and V by (c_i - c_j)/(s_i - s_j) E
/// and (c_i + c_j)/(s_i + s_j) E, and tau = U d U^T by (d_i - d_j)/(s_i^2 - s_j^2) (|s_i| + |s_j|)
/// E.
template <class Vec>
struct Slopes {
  double strain = 0, turn = 0, tau = 0;

  /// @param d_slope  largest |dd/dc|
  Slopes(const Vec& s, const Vec& c, const Vec& d, double d_slope, double reach) {
    const double largest = static_cast<double>(s.cwiseAbs().maxCoeff());
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j) {
        const auto apart = static_cast<double>(s[i] - s[j]), sum = static_cast<double>(s[i] + s[j]);
        const auto c_apart = static_cast<double>(c[i] - c[j]),
                   d_apart = static_cast<double>(d[i] - d[j]);
        const bool is_close = std::abs(apart) < reach;
        const double c_slope = is_close ? 1 : std::abs(c_apart / apart);
        strain = std::max(strain, c_slope * largest);
        const double conditioning =
            sum > 0 ? largest / sum : std::numeric_limits<double>::infinity();
        turn = std::max(turn, static_cast<double>(c[i] + c[j]) * conditioning);
        const double axes =
            std::abs(static_cast<double>(s[i])) + std::abs(static_cast<double>(s[j]));
        // Two stretches that end in the same stress do not care for their axes.
        if (d_apart == 0 && !is_close) continue;
        tau = std::max(tau, (is_close ? d_slope : std::abs(d_apart / apart)) *
                                std::max(largest, axes * conditioning));
      }
  }
};

template <class Wide, class Real>
MaterialReference<Wide> material_reference(const sim::kernels::Particle<Real>& p,
                                           const sim::kernels::MaterialConstants<Real>& k) {
  using Reference = MaterialReference<Wide>;
  using Vec = typename Reference::Vec;
  constexpr double epsilon = std::numeric_limits<Real>::epsilon() / 2;
  const auto model = static_cast<sim::Model>(p.model());
  Reference out{};
  double permanent = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) out.F_E(a, b) = static_cast<Wide>(p.F_E[3 * a + b]);
  for (int a = 0; a < 3; ++a) {
    const auto entry = [&](int row, int column) {
      return static_cast<double>(std::abs(out.F_E(row, column % 3)));
    };
    permanent +=
        entry(0, a) * (entry(1, a + 1) * entry(2, a + 2) + entry(1, a + 2) * entry(2, a + 1));
  }
  const ProperSvd<Wide> svd(out.F_E);
  const Vec& s = svd.s;
  const double largest = static_cast<double>(s[0]);
  // Thresholds as in the kernels: rounded to Real.
  const auto lo = static_cast<Wide>(Real(1) - k.theta_c * p.threshold);
  const auto hi = static_cast<Wide>(Real(1) + k.theta_s * p.threshold);
  Vec c = s;
  Wide cut = 1;
  double cut_bound = 1;
  out.is_untouched = true;
  if (model == sim::laws::model::snow) {
    const auto margin = static_cast<Wide>(100 * epsilon * std::max(1.0, largest));
    for (int i = 0; i < 3; ++i) {
      c[i] = std::clamp(s[i], lo, hi);
      cut *= std::abs(s[i]) / c[i];
      cut_bound *=
          (std::abs(static_cast<double>(s[i])) + epsilon * largest) / static_cast<double>(c[i]);
      if (s[i] < lo + margin || s[i] > hi - margin) out.is_untouched = false;
    }
    if (c != s) out.F_E = svd.U * c.asDiagonal() * svd.V.transpose();
  }
  out.stretches = c;
  for (const Wide threshold : {lo, hi}) {
    const Vec gap = (s.array().square() - threshold * threshold).abs();
    const auto sum = static_cast<double>(gap.sum());
    out.is_undecided |= static_cast<double>(gap.prod()) < 4 * epsilon * sum * sum * sum;
  }
  const auto J_P_before = static_cast<double>(p.J_P);
  out.J_P = static_cast<Wide>(p.J_P) * cut;
  if (c != s)
    out.J_P = std::clamp(out.J_P, static_cast<Wide>(k.min_J_P), static_cast<Wide>(k.max_J_P));
  out.J_P_unit = out.is_untouched
                     ? 0
                     : std::abs(J_P_before) * (cut_bound - std::abs(static_cast<double>(cut))) +
                           epsilon * std::abs(static_cast<double>(out.J_P));

  const Wide xi = static_cast<Wide>(k.xi), most = sizeof(Real) == 4 ? 80 : 700;
  const Wide exponent = std::clamp(xi * (1 - out.J_P), -most, most);
  const Wide factor =
      std::clamp(std::exp(exponent), static_cast<Wide>(Real(sim::laws::min_hardening)),
                 static_cast<Wide>(k.max_hardening));
  const Wide H = factor * static_cast<Wide>(p.stiffness);
  const Wide mu = H * static_cast<Wide>(k.mu0), lambda = H * static_cast<Wide>(k.lambda0);
  // Error of the factor e^(xi (1 - J_P)): its argument is rounded, and J_P is uncertain.
  const auto softening = static_cast<double>(xi) * out.J_P_unit;
  const double hardening_unit =
      epsilon * (2 + std::abs(static_cast<double>(exponent)) + static_cast<double>(xi)) + softening;
  out.has_hardening = softening * 100 < 1;
  const auto m = static_cast<double>(mu), l = static_cast<double>(lambda);
  const Wide J = c.prod();
  const double J_abs = std::abs(static_cast<double>(J));
  if (model == sim::laws::model::neo_hookean) {
    const double J_unit = epsilon * permanent;
    const double J_E = static_cast<double>(out.F_E.determinant());
    const Wide log_J = std::log(std::max(out.F_E.determinant(), Wide(Real(1e-6))));
    const double log_unit = std::log(std::max(J_E + J_unit, 1e-6) / std::max(J_E - J_unit, 1e-6)) +
                            epsilon * std::abs(static_cast<double>(log_J));
    const auto b = (out.F_E * out.F_E.transpose()).eval();
    out.tau = mu * (b - Reference::Mat::Identity()) + lambda * log_J * Reference::Mat::Identity();
    out.tau_unit =
        epsilon * m * (largest * largest + 1) + l * log_unit +
        hardening_unit * (m * (largest * largest + 1) + l * std::abs(static_cast<double>(log_J)));
    return out;
  }
  Vec d;
  for (int i = 0; i < 3; ++i) d[i] = 2 * mu * (c[i] - 1) * c[i] + lambda * (J - 1) * J;
  out.tau = svd.U * d.asDiagonal() * svd.U.transpose();
  const double top = static_cast<double>(c.cwiseAbs().maxCoeff());
  const Slopes<Vec> slope(s, c, d, 2 * m * (2 * top + 1), 100 * epsilon * std::max(1.0, largest));
  // A stretch inside the thresholds follows an error of F, too.
  bool is_any_free = model != sim::laws::model::snow;
  for (int i = 0; i < 3; ++i)
    is_any_free |= std::abs(static_cast<double>(c[i] - s[i])) < 100 * epsilon * largest;
  // If the eigenvalues of b are used, F' is F and a correction as large as F.
  const bool is_correction = largest * largest < 1.01 * sim::laws::eigen_hi;
  out.stretch_unit = epsilon * (top + (is_any_free || is_correction ? largest : 0));
  out.F_unit = epsilon * (top + std::max(slope.strain, is_any_free ? largest : 0) + slope.turn);
  double J_unit = epsilon * J_abs;
  for (int i = 0; i < 3; ++i) {
    double others = out.stretch_unit;
    for (int j = 0; j < 3; ++j)
      if (j != i) others *= std::abs(static_cast<double>(c[j])) + out.stretch_unit;
    J_unit += others;
  }
  const double scale = out.tau_scale = 2 * m * top * (top + 1) + l * J_abs * (J_abs + 1);
  out.tau_unit = hardening_unit * scale + epsilon * (scale + slope.tau) +
                 2 * m * (2 * top + 1) * out.stretch_unit + l * (2 * J_abs + 1) * J_unit;
  return out;
}

}  // namespace neve::test
