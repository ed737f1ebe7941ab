/// Noise on density, stiffness and thresholds: its size and smoothness, and that all laws of a step
/// hold with it.

#include "sim/shapes/variation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/checks/watch.h"
#include "sim/health/diagnostics.h"
#include "tests/support/snow.h"

namespace {

using namespace neve;
using namespace neve::sim;
using namespace neve::test;

struct Spread {
  double mean = 0, deviation = 0;
};

template <class Value>
Spread spread(const Variation& variation, const Value& value) {
  constexpr int n = 40'000;
  double sum = 0, squares = 0;
  for (int k = 0; k < n; ++k) {
    // Places far from each other: independent lumps.
    const Vec3d y(0.37 * (k % 34), 0.41 * (k / 34 % 34), 0.43 * (k / 34 / 34));
    const double x = value(shapes::vary(variation, 5, static_cast<std::uint64_t>(k), y));
    sum += x;
    squares += x * x;
  }
  const double mean = sum / n;
  return {mean, std::sqrt(squares / n - mean * mean)};
}

TEST(Variation, FactorsHaveTheDeviationsThatAreAskedFor) {
  for (const double size : {0.0, 0.05}) {
    const Variation variation{0.1, 0.4, 0.25, size};
    const Spread density = spread(variation, [](const shapes::Factors&f) { return f.density; }),
                 stiffness = spread(variation, [](const shapes::Factors&f) { return f.stiffness; }),
                 threshold = spread(variation, [](const shapes::Factors&f) { return f.threshold; });
    // 40 000 samples: the mean is known to 0.4 / 200, the deviation to 1 %; cutting at three
    // deviations takes another percent from it.
    EXPECT_NEAR(density.mean, 1, 0.003);
    EXPECT_NEAR(density.deviation, 0.1, 0.004);
    EXPECT_NEAR(stiffness.mean, 1, 0.01);
    EXPECT_NEAR(stiffness.deviation, 0.4, 0.016);
    EXPECT_NEAR(threshold.mean, 1, 0.006);
    EXPECT_NEAR(threshold.deviation, 0.25, 0.01);
  }
}

TEST(Variation, FactorsWithoutVariationAreOne) {
  const shapes::Factors f = shapes::vary(Variation{}, 5, 3, {0.1, 0.2, 0.3});
  EXPECT_EQ(f.density, 1);
  EXPECT_EQ(f.stiffness, 1);
  EXPECT_EQ(f.threshold, 1);
}

TEST(Variation, LumpsAreSmoothAndAsLargeAsAskedFor) {
  const Variation variation{0, 0.4, 0, 0.05};
  const auto at = [&](double x) {
    return shapes::vary(variation, 5, 0, {x, 0.01, 0.02}).stiffness;
  };
  double largest_step = 0, near = 0, far = 0, variance = 0;
  constexpr int n = 4000;
  for (int k = 0; k < n; ++k) {
    const double x = 0.013 * k;
    largest_step = std::max(largest_step, std::abs(at(x + 1e-6) - at(x)));
    near += std::pow(at(x + 0.005) - at(x), 2);
    far += std::pow(at(x + 0.2) - at(x), 2);
    variance += std::pow(at(x) - 1, 2);
  }
  // The steepest fade is 15/8 per lump between values a few deviations apart.
  EXPECT_LT(largest_step, 1e-6 / 0.05 * 20);
  EXPECT_LT(near, 0.1 * variance) << "a tenth of a lump away it is nearly the same";
  EXPECT_NEAR(far / variance, 2, 0.3) << "four lumps away it is another";
}

/// A factor on the stiffness is a material of that stiffness; likewise the thresholds.
TEST(Variation, AFactorIsAnotherMaterial) {
  SolverSettings settings;
  settings.precision = Precision::real64;
  ParticleArrays p = ball_of_snow({0, 0.2, 0}, 0.05, 0.01, Vec3d::Zero());
  disturb(p, 0.1, 2);
  const double dt = 1e-4;
  ParticleArrays varied = p;
  varied.stiffness.assign(p.x.size(), 3.0);
  varied.threshold.assign(p.x.size(), 0.5);
  Simulation by_factor(settings, {Material{}}, {}, varied, 1);
  Simulation by_material(settings, {scaled(Material{}, 3, 0.5)}, {}, p, 1);
  EXPECT_NEAR(by_factor.summary().elastic_energy, by_material.summary().elastic_energy,
              1e-12 * by_material.summary().elastic_energy);
  EXPECT_DOUBLE_EQ(by_factor.step_limits().max_sound_speed,
                   by_material.step_limits().max_sound_speed);
  for (int k = 0; k < 20; ++k) {
    by_factor.step(dt);
    by_material.step(dt);
  }
  const ParticleArrays a = by_factor.particles(), b = by_material.particles();
  // The factor is one more rounding of each modulus.
  for (std::size_t q = 0; q < a.x.size(); ++q) {
    EXPECT_LT((a.F_E[q] - b.F_E[q]).norm(), 1e-10);
    EXPECT_NEAR(a.J_P[q], b.J_P[q], 1e-10);
  }
  EXPECT_EQ(a.stiffness, varied.stiffness);
  EXPECT_EQ(a.threshold, varied.threshold);
}

TEST(Variation, EveryLawOfAStepHolds) {
  for (const double beta : {0.0, 0.5}) {
    SolverSettings settings;
    settings.precision = Precision::real64;
    settings.beta = beta;
    ParticleArrays p = ball_of_snow({0, 0.2, 0}, 0.05, 0.01, {0, -2, 0});
    disturb(p, 0.02, 1);
    const Variation variation{0, 0.5, 0.3, 0.03};
    for (std::size_t q = 0; q < p.x.size(); ++q) {
      const shapes::Factors f = shapes::vary(variation, 1, q, p.x[q]);
      p.stiffness.push_back(f.stiffness);
      p.threshold.push_back(f.threshold);
    }
    Simulation simulation(settings, {Material{}}, {}, p, 1);
    checks::Watch watch(settings, {Material{}});
    for (int k = 0; k < 10; ++k) {
      for (const std::string& broken : watch.look(simulation)) ADD_FAILURE() << broken;
      simulation.step(simulation.choose_dt(1).dt);
    }
    EXPECT_FALSE(watch.has_errors());
  }
}

/// Factors and materials are of the state, where they are not those that most snow has.
TEST(Variation, TheHashOfAStateTellsFactorsAndMaterialsApart) {
  const ParticleArrays plain = ball_of_snow({0, 0.2, 0}, 0.03, 0.01, Vec3d::Zero());
  const auto hash = [](const ParticleArrays& p) {
    return Simulation({}, {Material{}, Material{}}, {}, p, 1).state_hash();
  };
  ParticleArrays ones = plain, stiff = plain, strong = plain, other = plain;
  ones.stiffness.assign(plain.x.size(), 1.0);
  ones.threshold.assign(plain.x.size(), 1.0);
  EXPECT_EQ(hash(ones), hash(plain));
  stiff.stiffness = ones.stiffness, strong.threshold = ones.threshold;
  stiff.stiffness[3] = strong.threshold[3] = 1.25;
  other.material.assign(plain.x.size(), 0);
  EXPECT_EQ(hash(other), hash(plain));
  other.material[3] = 1;
  std::vector<std::uint64_t> all{hash(plain), hash(stiff), hash(strong), hash(other)};
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::unique(all.begin(), all.end()), all.end());
}

TEST(Variation, VariationRefusesFactorsThatAreNotPositive) {
  ParticleArrays p = ball_of_snow({0, 0.2, 0}, 0.03, 0.01, Vec3d::Zero());
  p.stiffness.assign(p.x.size(), 1.0);
  p.stiffness.back() = 0;
  EXPECT_THROW(Simulation({}, {Material{}}, {}, p, 1), std::invalid_argument);
  p.stiffness.pop_back();
  EXPECT_THROW(Simulation({}, {Material{}}, {}, p, 1), std::invalid_argument);
}

TEST(Variation, LumpsOfNoSizeAreStillNumbers) {
  for (const double size : {1e-310, 1e-30}) {
    const shapes::Factors factors = shapes::vary({0.1, 0.2, 0.3, size}, 5, 1, {0.3, -0.2, 0});
    EXPECT_TRUE(factors.density > 0 && factors.density < 2) << factors.density;
    EXPECT_TRUE(factors.stiffness > 0 && factors.stiffness < 4) << factors.stiffness;
  }
}

}  // namespace
