/// Drop, tilt and column of a card against formulas and experiments.

#include <gtest/gtest.h>

#include <cmath>

#include "app/card/falls.h"
#include "tests/card/subject.h"

namespace {

using namespace neve::test;
using namespace neve::app::card;
using neve::app::scene::Preset;

/// The angle is known once the slope is 1.5 degrees steeper than what it bears.
TEST(CardTilt, SandSlidesAtTheAngleOfItsFriction) {
  for (const double angle : {20.0, 30.0}) {
    const Experiment tilted = tilt(subject_of(dry_sand(angle)));
    EXPECT_EQ(tilted.failure, "");
    EXPECT_NEAR(tilted.value("angle").value_or(NAN),
                std::atan(critical_slope(angle)) * 180 / 3.14159265358979323846, 2)
        << angle;
  }
}

/// A layer that its weight squeezes by a tenth slides degrees too early.
TEST(CardTilt, SandThatIsTooSoftSaysSo) {
  const auto words = [](double E) {
    neve::sim::Material sand = dry_sand(30);
    sand.youngs_modulus = E;
    return tilt(subject_of(sand)).words;
  };
  EXPECT_EQ(words(1e6).size(), 1u);
  ASSERT_EQ(words(2e4).size(), 2u);
  EXPECT_NE(words(2e4)[1].find("too soft"), std::string::npos);
}

TEST(CardTilt, ElasticLayersHold) {
  neve::sim::Material m;
  m.model = neve::sim::laws::model::corotated;
  const Experiment tilted = tilt(subject_of(m));
  EXPECT_TRUE(std::isnan(tilted.value("angle").value_or(0)));
  EXPECT_EQ(tilted.x.back(), 90);
}

/// The upper half of this layer makes a way of 20 cm, which is no sliding.
TEST(CardTilt, SoftElasticLayersHold) {
  for (const double E : {5e3, 2e3}) {
    neve::sim::Material m = preset_snow(Preset::wet, neve::sim::laws::model::neo_hookean);
    m.youngs_modulus = E;
    const Experiment tilted = tilt(subject_of(m));
    EXPECT_EQ(tilted.failure, "");
    EXPECT_TRUE(std::isnan(tilted.value("angle").value_or(0))) << E;
    EXPECT_EQ(tilted.x.back(), 90) << E;
  }
}

/// Run-outs of dry sand whose height is a times its radius: 1.6 sqrt(a) (Lube, Huppert, Sparks and
/// Hallworth 2004, J. Fluid Mech. 508, a > 1.7), a (Lajeunesse, Mangeney-Castelnau and Vilotte
/// 2004, Phys. Fluids 16, a < 3). The front is thinner than a cell: 98 % of the sand is nearer by a
/// tenth to a sixth, and cells of a sixth of the radius hold back some more. 26.3 degrees: sand of
/// these experiments slides at about 31 degrees.
TEST(CardColumn, DrySandRunsOutNearlyAsFarAsInExperiments) {
  const Experiment collapsed = column(subject_of(dry_sand(26.3)));
  EXPECT_EQ(collapsed.failure, "");
  const double run_out = collapsed.value("run_out").value_or(NAN), a = 2;
  EXPECT_GT(run_out, 0.7 * a);
  EXPECT_LT(run_out, 1.6 * std::sqrt(a));
  EXPECT_LT(collapsed.value("height").value_or(NAN), 0.5);
}

/// Without cohesion a column of 80 cm of powder would not stand either; snow of the paper bears
/// E theta_c = 3.5 kPa, more than its weight of 3.1 kPa.
TEST(CardColumn, SnowOfThePaperStandsAndPowderDoesNot) {
  const auto run_out = [](Preset preset) {
    return column(subject_of(preset_snow(preset))).value("run_out").value_or(NAN);
  };
  EXPECT_LT(run_out(Preset::paper), 0.02);
  EXPECT_GT(run_out(Preset::powder), 0.5);
}

neve::sim::Material soft_elastic(double youngs_modulus) {
  neve::sim::Material m;
  m.model = neve::sim::laws::model::corotated;
  m.density = 300;
  m.poisson_ratio = 0.3;
  m.youngs_modulus = youngs_modulus;
  m.hardening = 0;
  return m;
}

/// An elastic bar under its weight is shorter by rho g h / (2 E) at rest. It still swings about
/// that height when it is measured, by as much as that. Cells of a twelfth of its height and a mean
/// over a swing that is known to a tenth are worth 0.034.
TEST(CardColumn, ASwingingColumnHasTheHeightThatItSwingsAbout) {
  for (const double E : {7e3, 8e3, 1e4, 1.2e4}) {
    const Experiment swung = column(subject_of(soft_elastic(E)));
    EXPECT_EQ(swung.failure, "");
    EXPECT_NEAR(swung.value("height").value_or(NAN), 1 - 300 * 9.81 * 0.8 / (2 * E), 0.04) << E;
    EXPECT_FALSE(swung.words.front().starts_with("runs out")) << swung.words.front();
  }
}

TEST(CardDrop, AnElasticBallIsAsWideAsBefore) {
  for (const double E : {7e3, 8e3, 1e4, 1.2e4}) {
    const Experiment dropped = drop(subject_of(soft_elastic(E)));
    EXPECT_NEAR(dropped.value("spread").value_or(NAN) / dropped.y.front(), 1, 0.03) << E;
  }
}

TEST(CardDrop, WetSnowStaysABallAndPowderBursts) {
  const auto drop_of = [](Preset preset) { return drop(subject_of(preset_snow(preset))); };
  const Experiment wet = drop_of(Preset::wet), powder = drop_of(Preset::powder);
  EXPECT_EQ(wet.value("largest_piece"), 1.0);
  EXPECT_GT(*powder.value("spread"), 2 * *wet.value("spread"));
  EXPECT_EQ(wet.words.front(), "stays a ball");
  EXPECT_EQ(powder.words.front(), "bursts");
}

}  // namespace
