#include "app/health/expected.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "app/health/softness.h"
#include "app/support/text.h"
#include "sim/health/diagnostics.h"
#include "sim/health/limits.h"
#include "sim/laws/law.h"
#include "sim/laws/threshold_cell.h"
#include "sim/shapes/variation.h"

namespace neve::app::health {

namespace {

using sim::health::Law;

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Sampling, and the bias of volumes estimated at surfaces, put numbers apart from the mean.
constexpr double scatter = 2;
/// The paper's step 2 takes for snow what the nodes around a particle hold: at a coarse corner a
/// particle gets about 6 times its share.
constexpr double estimated_scatter = 8, given_scatter = 3;

}  // namespace

Expected::Expected(const scene::Scene& scene, const sim::ParticleArrays& state, double dt)
    : scene_(scene), dt_(dt), h_(scene.solver.cell_size) {
  lightest_ = no_limit;
  lightest_density_ = no_limit;
  std::vector<bool> is_used(scene.materials.size(), false);
  for (std::size_t p = 0; p < state.x.size(); ++p) {
    is_used[static_cast<std::size_t>(state.material[p])] = true;
    lightest_ = std::min(lightest_, state.m[p]);
    heaviest_ = std::max(heaviest_, state.m[p]);
    if (std::isfinite(state.J_P[p])) min_J_P_ = std::min(min_J_P_, state.J_P[p]);
  }
  const std::vector<sim::Material> materials = sim::laws::in_cells(scene.materials, scene.solver);
  for (std::size_t k = 0; k < materials.size(); ++k) {
    if (!is_used[k]) continue;
    const sim::Material& m = materials[k];
    const sim::Lame lame = sim::lame(m.youngs_modulus, m.poisson_ratio);
    density_ = std::max(density_, m.density);
    loosest_ = std::max(loosest_, m.max_J_P);
    lightest_density_ = std::min(lightest_density_, m.density);
    if (sim::laws::of(m).surface) {
      include_surface(m);
      continue;
    }
    compression_ = std::max(compression_, m.critical_compression);
    stretch_ = std::max(stretch_, m.critical_stretch);
    stiffest_ = std::max(stiffest_, 2 * lame.mu + 3 * lame.lambda);
    hardened_ = std::max(hardened_, sim::health::hardening_factor(m, min_J_P_));
    is_bounded_ = is_bounded_ && sim::laws::of(m).is_snow;
  }
}

/// Stresses and strains that the yield surface holds, where it is largest.
void Expected::include_surface(const sim::Material& m) {
  const sim::Material strongest =
      sim::scaled(m, sim::shapes::max_factor(m.variation.youngs_modulus),
                  sim::shapes::max_factor(m.variation.thresholds));
  const auto limits = sim::laws::of(m).surface(strongest, min_J_P_);
  const double p = std::max(limits.pressure, limits.tension);
  surface_stress_ =
      std::max(surface_stress_, std::sqrt(3 * p * p + 2.0 / 3 * limits.deviator * limits.deviator));
  // A principal deviator of q is 2 q/3 at most, and mu ln s'^2 in small strain; more in a large
  // one.
  const double mu = sim::lame(strongest.youngs_modulus, m.poisson_ratio).mu;
  const double turn = limits.deviator / (3 * mu);
  compression_ = std::max(compression_, 1 - std::cbrt(limits.min_J) * std::exp(-turn));
  stretch_ = std::max(stretch_, std::cbrt(limits.max_J) * std::exp(turn) - 1);
}

double Expected::negligible_share() {
  return sim::health::limits_of(Law::light_node).expected;
}

double Expected::negligible_mass() const {
  return negligible_share() * lightest_density_ * h_ * h_ * h_;
}

Expectation Expected::node_mass() const {
  const double full = density_ * h_ * h_ * h_;
  return {{0, scatter * full / min_J_P_},
          "rho h^3 = " + rough_text(full) + " kg inside snow, more in packed snow"};
}

Expectation Expected::speed() const {
  const double most = load_speed(scene_);
  return {{0, 1.5 * most}, "the fastest body or collider has " + rough_text(most) + " m/s"};
}

Expectation Expected::momentum() const {
  return {{0, node_mass().range.max * speed().range.max}, "mass times speed"};
}

double Expected::stress_limit() const {
  if (!is_bounded_) return no_limit;
  const double strain = std::max(compression_, stretch_) * (1 + stretch_);
  return std::max(std::sqrt(3.0) * stiffest_ * strain * hardened_, surface_stress_);
}

Expectation Expected::stress() const {
  return {{0, stress_limit()},
          is_bounded_ ? "what yields, hardened to J_P = " + rough_text(min_J_P_)
                      : "elastic models have no limit"};
}

Expectation Expected::force() const {
  return {{0, scatter * stress_limit() * h_ * h_}, "stress on a face of a cell"};
}

double Expected::steepest_gradient() const {
  // Near its end a weight is e = (2 - x)^3 / 6 (cubic) or (1.5 - x)^2 / 2 (quadratic) of the
  // distance x in cells. A node counts from a mass on; its e is least beside one particle of which
  // it lies at the middle of the two other axes.
  const bool is_cubic = scene_.solver.kernel == sim::Kernel::cubic;
  const double middle = is_cubic ? 2.0 / 3 : 3.0 / 4;
  const double e = std::min(1.0, negligible_mass() / (heaviest_ * middle * middle));
  return is_cubic ? 3 / std::cbrt(6 * e) : 2 / std::sqrt(2 * e);
}

Expectation Expected::velocity_change() const {
  const double gravity = scene_.solver.gravity.norm() * dt_;
  // Light nodes beside pressed snow change most: their mass falls faster than the force on them.
  const double most = std::max(scatter, steepest_gradient());
  return {{0, gravity + most * dt_ * stress_limit() / (lightest_density_ * h_)},
          "g dt = " + rough_text(gravity) + " m/s in free flight"};
}

Expectation Expected::strain_rate() const {
  // A norm of nine entries, each below the limit.
  return {{0, 3 * scene_.solver.strain_limit / dt_},
          "strain_limit / dt = " + rough_text(scene_.solver.strain_limit / dt_) + " 1/s an entry"};
}

Expectation Expected::stretch() const {
  if (!is_bounded_) return {{0, no_limit}, "elastic models have no limit"};
  // Singular values in the arithmetic of the solver.
  constexpr double rounding = 1e-5;
  return {{1 - compression_ - rounding, 1 + stretch_ + rounding},
          "1 - critical_compression to 1 + critical_stretch, or the yield surface of the law"};
}

Expectation Expected::J_E() const {
  const scene::Range s = stretch().range;
  return {{std::pow(s.min, 3), std::pow(s.max, 3)}, "product of three stretches"};
}

Expectation Expected::J_P() const {
  // Spray is loose and well; what matters is whether it could be packed again.
  const double loosest = std::min(loosest_, sim::health::limits_of(Law::dilation).expected);
  return {{sim::health::limits_of(Law::compaction).expected, loosest},
          "packed to five times the density at most; torn snow and spray are loose, up to J_P = " +
              rough_text(loosest)};
}

Expectation Expected::volume() const {
  const bool is_estimated =
      std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const sim::seeding::Body& body) {
        return body.volumes == sim::seeding::Volumes::estimated;
      });
  const double most = is_estimated ? estimated_scatter : given_scatter;
  return {{0.3 * lightest_ / density_, most * heaviest_ / lightest_density_},
          is_estimated ? "mass / density; up to " + rough_text(most) +
                             " times that at surfaces, where it is estimated"
                       : "mass / density"};
}

}  // namespace neve::app::health
