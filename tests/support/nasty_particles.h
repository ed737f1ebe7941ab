#pragma once
/// Particles whose F_E is hard on decompositions and projections, by kind.

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "sim/laws/stretches.h"
#include "sim/types/math.h"

namespace neve::test {

using sim::Mat3d;
using sim::Vec3d;

inline constexpr const char* nasty_kinds[] = {
    "identity", "rotation", "tiny strain",   "strain",         "thresholds",   "on thresholds",
    "borders",  "repeated", "near singular", "rank deficient", "inverted",     "huge",
    "any",      "shrunk",   "shear",         "eigenvalues",    "equal entries"};
inline constexpr int nasty_kind_count = static_cast<int>(std::size(nasty_kinds));

/// Materials of all sorts: the paper's; thresholds that the series does not cover; none at all; of
/// one side only; without hardening; much of it; much of it with a range of J_P, which all
/// particles start in, and a bound.
template <class Real>
std::vector<sim::kernels::MaterialConstants<Real>> nasty_materials() {
  return {{Real(58333.3), Real(38888.9), 10, Real(0.025), Real(0.0075)},
          {Real(2e4), Real(1e5), 3, Real(0.3), Real(0.3)},
          {Real(1e6), Real(3e5), 1, 0, 0},
          {Real(3e3), Real(0), 20, 0, Real(0.5)},
          {Real(7e5), Real(7e5), 0, Real(0.049), 0},
          {Real(1e4), Real(2e4), 2, Real(0.9), 2},
          {Real(40), Real(60), 40, Real(0.01), Real(0.02)},
          {Real(5e4), Real(4e4), 15, Real(0.025), Real(0.0075), Real(0.05), 20, 500}};
}

/// Makes them one after the other from a seed, the kinds in turn.
template <class Real>
class NastyParticles {
 public:
  explicit NastyParticles(unsigned seed) : engine_(seed), materials_(nasty_materials<Real>()) {}

  /// @param kind  index into nasty_kinds
  sim::kernels::Particle<Real> make(int kind) {
    sim::kernels::Particle<Real> p{};
    const auto material = static_cast<std::uint16_t>(pick(static_cast<int>(materials_.size())));
    const auto model = static_cast<sim::Model>(std::max(0, pick(5) - 2));  // mostly snow
    const Real one = 1;
    p.kind = sim::kernels::kind_of<Real>(material, model, 0);
    p.stiffness = pick(2) ? one : static_cast<Real>(between(0.2, 5));
    p.threshold = pick(2) ? one : static_cast<Real>(between(0, 1.05));
    p.J_P = pick(4) == 0 ? one : static_cast<Real>(pick(4) ? between(0.8, 1.2) : between(0.05, 20));
    p.m = p.V0 = 1;
    const sim::kernels::MaterialConstants<Real>& k = materials_[material];
    lo_ = Real(1) - k.theta_c * p.threshold;
    hi_ = Real(1) + k.theta_s * p.threshold;
    const Mat3d F = matrix(kind);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) p.F_E[3 * a + b] = static_cast<Real>(F(a, b));
    return p;
  }

  int pick(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }

 private:
  double between(double a, double b) {
    return a + (b - a) * std::uniform_real_distribution<double>()(engine_);
  }
  double power(double a, double b) { return std::pow(10.0, between(a, b)); }
  double sign() { return pick(2) ? 1 : -1; }
  double normal() { return normal_(engine_); }
  Mat3d entries() {
    return Mat3d::NullaryExpr([this] { return between(-1, 1); });
  }
  Mat3d rotation() {
    const Eigen::Vector4d q = Eigen::Vector4d::NullaryExpr([this] { return normal(); });
    const Mat3d R = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    // Small turns, of whatever the decomposition starts from, are a kind of their own.
    if (pick(8) == 0) {
      const Mat3d A = power(-9, -1) * entries();
      return Eigen::AngleAxisd(A.col(0).norm(), A.col(0).normalized()).toRotationMatrix();
    }
    return R;
  }
  Mat3d stretched(const Vec3d& s) {
    switch (pick(4)) {
      case 0:
        return s.asDiagonal();
      case 1: {
        const Mat3d R = rotation();
        return R * s.asDiagonal() * R.transpose();
      }
      default:
        return rotation() * s.asDiagonal() * rotation().transpose();
    }
  }
  /// x or a number next to it, up to 10 % away.
  double around(double x) { return pick(4) ? x * (1 + sign() * power(-9, -1)) : x; }
  /// One of the two thresholds, one unit in the last place to either side at most.
  double on_threshold() {
    const Real x = pick(2) ? lo_ : hi_;
    const int side = pick(3);
    if (side == 0) return static_cast<double>(x);
    return static_cast<double>(std::nextafter(x, side == 1 ? Real(0) : Real(10)));
  }

  Mat3d matrix(int kind) {
    const auto three = [](auto&& f) { return Vec3d(f(), f(), f()); };
    switch (kind) {
      case 0:
        return Mat3d::Identity();
      case 1:
        return rotation();
      case 2:
        return rotation() * (Mat3d::Identity() + power(-8, -2) * entries());
      case 3:
        return rotation() * (Mat3d::Identity() + power(-2, -0.5) * entries());
      case 4:
        return stretched(three([this] {
          const int which = pick(5);
          return which == 4 ? 1 : around(static_cast<double>(which < 2 ? lo_ : hi_));
        }));
      case 5:
        return three([this] { return pick(3) ? on_threshold() : 1.0; }).asDiagonal();
      case 6: {
        static constexpr double border[] = {1 - sim::kernels::series_radius,
                                            1 + sim::kernels::series_radius, sim::laws::eigen_lo,
                                            sim::laws::eigen_hi, 1};
        return stretched(three([this] { return std::sqrt(around(border[pick(5)])); }));
      }
      case 7: {
        const double a = pick(4) ? between(0.3, 2) : static_cast<double>(pick(2) ? lo_ : hi_);
        const double b = pick(2) ? a : between(0.3, 2);
        return stretched({around(a), a, around(b)});
      }
      case 8:
        return stretched({between(0.5, 2), pick(2) ? 1 : power(-12, 0), power(-12, -1)});
      case 9:
        return rank_deficient();
      case 10:
        return inverted();
      case 11:
        return pick(2) ? Mat3d(power(0, 4) * entries())
                       : stretched({power(0, 4), power(-4, 4), sign() * power(-4, 4)});
      case 12:
        return power(-1, 1) * entries();
      case 13:
        return power(-7, -1) * (pick(2) ? entries() : rotation());
      case 14: {
        Mat3d F = Mat3d::Identity();
        F(pick(3), pick(3)) += sign() * power(-7, 1);
        if (pick(2)) F(pick(3), pick(3)) += sign() * power(-7, 1);
        return F;
      }
      case 15:
        return stretched(
            three([this] { return std::sqrt(between(sim::laws::eigen_lo, sim::laws::eigen_hi)); }));
      default: {
        // Equal entries make the first rotations of Jacobi's sweeps as bad as they can be.
        const double off = sign() * power(-6, 0), diagonal = between(0.2, 1.5);
        Mat3d F = Mat3d::Constant(off);
        F.diagonal().setConstant(diagonal);
        for (int q = pick(4); q > 0; --q) F(pick(3), pick(3)) *= pick(2) ? -1 : 1 + power(-8, -1);
        return F;
      }
    }
  }

  Mat3d rank_deficient() {
    Mat3d F = entries();
    switch (pick(6)) {
      case 0:
        return Mat3d::Zero();
      case 1:
        return F.col(0) * F.row(1);
      case 2:
        F.row(pick(3)).setZero();
        return F;
      case 3:
        F.col(pick(3)).setZero();
        return F;
      case 4:
        F.col(1) = F.col(0);
        return F;
      default:
        F.setZero();
        F(pick(3), pick(3)) = between(-2, 2);
        return F;
    }
  }
  Mat3d inverted() {
    switch (pick(4)) {
      case 0:
        return Vec3d(sign(), sign(), sign()).asDiagonal();
      case 1:
        return -rotation();
      case 2: {
        const double a = between(0.1, 2);
        return stretched({between(0.1, 2), a, -around(a)});
      }
      default:
        return stretched({between(0.1, 2), between(0.1, 2), -between(0, 2)});
    }
  }

  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
  std::vector<sim::kernels::MaterialConstants<Real>> materials_;
  Real lo_ = 1, hi_ = 1;
};

}  // namespace neve::test
