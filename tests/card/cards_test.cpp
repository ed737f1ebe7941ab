/// A card as a whole: its materials, its numbers, and how it ends.

#include <gtest/gtest.h>

#include "app/card/card.h"
#include "app/card/plates.h"
#include "app/card/subjects.h"
#include "app/support/errors.h"
#include "tests/card/subject.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace neve::test;
using namespace neve::app::card;
using neve::app::UsageError;
using neve::app::scene::Preset;

/// All of it, soft and light, so that steps are long.
TEST(Cards, NumbersDoNotDependOnTheNumberOfThreads) {
  neve::sim::Material m = preset_snow(Preset::quick, neve::sim::laws::model::cam_clay);
  const std::vector<Subject> subjects{subject_of(m)};
  const auto text = [&](int threads) {
    return neve::app::to_text(to_json(make_cards(subjects, threads).front()));
  };
  EXPECT_EQ(text(1), text(3));
}

class CardSubjects : public ::testing::Test {
 protected:
  CardSubjects() {
    folder.write("two.toml", R"(
[material.snow]
[material.sand]
model = "sand"
[material.spare]
[[body]]
name = "a"
material = "sand"
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }
[[body]]
name = "b"
shape = { sphere = { center = [1, 0.5, 0], radius = 0.1 } }
)");
    options.scenes = {(folder.path() / "two.toml").string()};
  }

  std::vector<std::string> titles() const {
    std::vector<std::string> list;
    for (const Source& source : sources_of(options)) list.push_back(source.subject.title);
    return list;
  }

  TemporaryFolder folder;
  CardOptions options;
};

using Titles = std::vector<std::string>;

TEST_F(CardSubjects, AreTheMaterialsThatBodiesHave) {
  EXPECT_EQ(titles(), (Titles{"two: snow", "two: sand"}));
}

TEST_F(CardSubjects, MayBeChosenByName) {
  options.materials = {"spare"};
  EXPECT_EQ(titles(), Titles{"two: spare"});
  options.materials = {"sandy"};
  try {
    sources_of(options);
    ADD_FAILURE() << "there is no such material";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "--material: error: there is no material \"sandy\"; did you mean sand? "
                 "expected snow, sand, spare");
  }
}

TEST_F(CardSubjects, OfAPresetHaveItsNumbersAndThoseThatAreSet) {
  options.scenes.clear();
  options.presets = {Preset::wet, Preset::powder};
  options.overrides = {"material.snow.hardening=3"};
  EXPECT_EQ(titles(), (Titles{"wet", "powder"}));
  const neve::sim::Material wet = sources_of(options).front().subject.material;
  EXPECT_EQ(wet.hardening, 3);
  EXPECT_EQ(wet.critical_stretch, preset_snow(Preset::wet).critical_stretch);
  EXPECT_EQ(wet.model, neve::sim::laws::model::snow);
}

TEST_F(CardSubjects, AreNotMoreThanAPictureHolds) {
  options.presets.assign(9, Preset::wet);
  EXPECT_THROW(sources_of(options), UsageError);
}

/// Steps of three times what sound takes through a cell cannot be stable.
TEST(Cards, AnExperimentThatDivergesSaysSo) {
  Subject subject = subject_of(preset_snow(Preset::paper));
  subject.solver.acoustic_cfl = 3;
  const Experiment pressed = press(subject);
  EXPECT_NE(pressed.failure.find("diverged"), std::string::npos) << pressed.failure;
  EXPECT_FALSE(pressed.shown.particles.x.empty()) << "it has a picture all the same";
}

}  // namespace
