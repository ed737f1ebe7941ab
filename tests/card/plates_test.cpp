/// Press, tear and shear of a card against formulas.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/card/plates.h"
#include "tests/card/subject.h"
#include "tests/support/compression.h"

namespace {

using namespace neve::test;
using namespace neve::app::card;
using neve::app::scene::Preset;
using neve::sim::Lame;
using neve::sim::lame;
using neve::sim::Material;

double value(const Experiment& e, const char* name) {
  EXPECT_EQ(e.failure, "");
  EXPECT_TRUE(e.value(name)) << name;
  return e.value(name).value_or(NAN);
}

Lame lame_of(const Material& m) {
  return lame(m.youngs_modulus, m.poisson_ratio);
}

Material elastic(double poisson_ratio) {
  Material m;
  m.model = neve::sim::laws::model::corotated;
  m.hardening = 0;
  m.poisson_ratio = poisson_ratio;
  return m;
}

/// The slope is taken up to strains of 0.6 %, where the stress of a stretch 1 - e is about
/// (1 + e/2) times the line, and waves of the plate come on top.
TEST(CardPress, ThePressHasTheModulusOfConfinedCompression) {
  for (const Material& m :
       {elastic(0.2), elastic(0.4), preset_snow(Preset::wet), preset_snow(Preset::icy),
        preset_snow(Preset::packed, neve::sim::laws::model::cam_clay)}) {
    const Lame l = lame_of(m);
    EXPECT_NEAR(value(press(subject_of(m)), "modulus") / (l.lambda + 2 * l.mu), 1, 0.025);
  }
}

/// Its slope is below that of the same sand without yielding, and no formula is beside it.
TEST(CardPress, WhatYieldsAtOnceHasASlopeToo) {
  Material sand = dry_sand(15);
  const Experiment pressed = press(subject_of(sand));
  const Lame l = lame_of(sand);
  EXPECT_GT(value(pressed, "modulus"), 0.7 * (l.lambda + 2 * l.mu));
  EXPECT_LT(value(pressed, "modulus"), l.lambda + 2 * l.mu);
  EXPECT_FALSE(pressed.measures.front().formula);
}

/// Snow has yielded when its stress is behind that of the law without yielding by 3 %: after
/// theta_c, by what it takes to fall so far, and by a sample of the plate, each at most 0.07 of it.
TEST(CardPress, SnowYieldsAtItsCriticalCompression) {
  for (const Preset preset : {Preset::paper, Preset::powder, Preset::wet}) {
    const Material m = preset_snow(preset);
    EXPECT_NEAR(value(press(subject_of(m)), "yield_strain") / m.critical_compression, 1.07, 0.08);
  }
}

/// The stress is at the strain of the snow in the middle: a hundredth more is a tenth more stress.
TEST(CardPress, ThePressFollowsTheLawToATwentieth) {
  for (const Preset preset : {Preset::paper, Preset::powder, Preset::packed}) {
    const Material m = preset_snow(preset);
    EXPECT_NEAR(
        value(press(subject_of(m)), "stress_at_20_percent") / -uniaxial_formula(m, 0.8).sigma, 1,
        0.05);
  }
}

TEST(CardPress, HarderSnowBearsMore) {
  Material soft = preset_snow(Preset::paper), hard = soft;
  soft.hardening = 5;
  EXPECT_GT(value(press(subject_of(hard)), "stress_at_20_percent"),
            1.5 * value(press(subject_of(soft)), "stress_at_20_percent"));
}

/// With stretch s on one axis alone, the law of the paper bears 2 mu (s - 1) + lambda (s - 1) s,
/// per area as it is: the sides stay. Waves of the plate are a per cent of it; a crack begins
/// anywhere, so the part that is watched may be a sample further.
TEST(CardTear, SnowTearsAtItsCriticalStretch) {
  for (const Preset preset : {Preset::paper, Preset::powder, Preset::icy}) {
    const Material m = preset_snow(preset);
    const Lame l = lame_of(m);
    const double e = m.critical_stretch, strength = 2 * l.mu * e + l.lambda * e;
    const Experiment torn = tear(subject_of(m));
    EXPECT_NEAR(value(torn, "strength") / strength, 1, 0.05);
    EXPECT_NEAR(value(torn, "stretch_at_strength") / e, 1.02, 0.08);
    EXPECT_LT(torn.y.back(), 0.2 * strength) << "it is torn";
  }
}

TEST(CardTear, SandBearsNoTensionAndElasticLawsDoNotTear) {
  const Experiment sand = tear(subject_of(dry_sand(30)));
  for (const char* name : {"strength", "stretch_at_strength", "work"})
    EXPECT_EQ(value(sand, name), 0) << name;
  const Experiment stretched = tear(subject_of(elastic(0.2)));
  EXPECT_EQ(std::max_element(stretched.y.begin(), stretched.y.end()), stretched.y.end() - 1);
  for (const char* name : {"strength", "stretch_at_strength", "work"})
    EXPECT_TRUE(std::isnan(value(stretched, name))) << name << ": it bears more";
  EXPECT_TRUE(stretched.words.front().starts_with("bears at least ")) << stretched.words.front();
}

TEST(CardShear, WhatNeverYieldsHasNoStrengthAndNoFriction) {
  const Experiment sheared = shear(subject_of(elastic(0.2)));
  for (const char* name : {"strength", "friction"})
    EXPECT_TRUE(std::isnan(value(sheared, name))) << name << ": it bears more";
  EXPECT_TRUE(sheared.words.front().starts_with("bears at least ")) << sheared.words.front();
  EXPECT_EQ(sheared.words.size(), 2u) << sheared.words.back();
  EXPECT_GT(value(sheared, "modulus"), 0);
}

/// Below 0.6 % of shear strain the law is linear to 1e-4; the rest is waves and the plate's start.
TEST(CardShear, TheShearHasTheShearModulus) {
  for (const Material& m : {elastic(0.2), elastic(0.4), preset_snow(Preset::wet),
                            preset_snow(Preset::packed, neve::sim::laws::model::cam_clay)})
    EXPECT_NEAR(value(shear(subject_of(m)), "modulus") / lame_of(m).mu, 1, 0.025);
}

/// Between the plates sand flows at constant volume. Its lowest and highest layers are held, and
/// samples of the last eighth of the way scatter by a per cent. The smallest principal stress is
/// p (1 - slope): at 40 degrees a twentieth is left of it, and sand comes apart at the plates.
TEST(CardShear, ShearedSandHasTheFrictionOfItsAngle) {
  for (const double angle : {20.0, 30.0, 36.0})
    EXPECT_NEAR(value(shear(subject_of(dry_sand(angle))), "friction") / critical_slope(angle), 1,
                0.05);
}

/// The pressure is right for any transfer and contact, and for soft laws, whose stress is no line.
TEST(CardShear, TheBlockIsPressedByFiveHundredPascal) {
  using neve::sim::ContactAt, neve::sim::Kernel, neve::sim::Transfer;
  Material m = preset_snow(Preset::wet, neve::sim::laws::model::neo_hookean);
  Subject subject = subject_of(m);
  for (const double E : {1e4, 1e5, 1e6}) {
    subject.material.youngs_modulus = E;
    EXPECT_NEAR(value(shear(subject), "pressure") / 500, 1, 0.02) << E;
  }
  subject.solver.transfer = Transfer::mls;
  subject.solver.kernel = Kernel::quadratic;
  EXPECT_NEAR(value(shear(subject), "pressure") / 500, 1, 0.03);
  subject.solver.contact_at = ContactAt::nodes;
  EXPECT_NEAR(value(shear(subject), "pressure") / 500, 1, 0.05);
  for (const Material& law : {preset_snow(Preset::powder), preset_snow(Preset::icy), dry_sand(30)})
    EXPECT_NEAR(value(shear(subject_of(law)), "pressure") / 500, 1, 0.03);
}

/// The law without yielding bears 500 Pa at a smaller strain than these do. Waves of the plate
/// leave their mark in sand that yields at once: a tenth of so small a pressure.
TEST(CardShear, SnowThatYieldsBeforeIsPressedOn) {
  Material clay = preset_snow(Preset::paper, neve::sim::laws::model::cam_clay);
  clay.consolidation_pressure = 200;
  for (const Material& law : {clay, dry_sand(15)})
    EXPECT_NEAR(value(shear(subject_of(law)), "pressure") / 500, 1, 0.12) << law.friction_angle;
}

/// Snow that bears less at 5 % says so, and has no friction once it does not press any more.
TEST(CardShear, SnowTooWeakForThePressureSaysUnderWhich) {
  Material weak = preset_snow(Preset::paper);
  weak.critical_compression = weak.critical_stretch = 5e-4;
  const Experiment sheared = shear(subject_of(weak));
  const double pressure = value(sheared, "pressure");
  EXPECT_GT(pressure, 100) << "more than where its law begins to yield";
  EXPECT_LT(pressure, 450);
  ASSERT_GE(sheared.words.size(), 2u);
  EXPECT_EQ(sheared.words[1], "under " + pressure_text(pressure) + ", pressed by 5 %");
  EXPECT_LT(sheared.value("friction").value_or(0), 10);
}

/// Its first steps are strains of 1e-6, which single precision knows to a tenth.
TEST(CardShear, StiffSandIsSheared) {
  Material sand = dry_sand(30);
  sand.youngs_modulus = 2e6;
  EXPECT_NEAR(value(shear(subject_of(sand)), "friction") / critical_slope(30), 1, 0.05);
}

}  // namespace
