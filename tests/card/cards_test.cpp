/// A card as a whole: its materials, its numbers, and how it ends.

#include <gtest/gtest.h>

#include <cmath>

#include "app/card/again.h"
#include "app/card/card.h"
#include "app/card/falls.h"
#include "app/card/plates.h"
#include "app/card/subjects.h"
#include "app/output/atomic_file.h"
#include "app/record/picture_record.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/errors.h"
#include "render/image/image.h"
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

TEST_F(CardSubjects, OfAPictureAreThoseThatItShows) {
  options.presets = {Preset::wet};
  options.overrides = {"solver.transfer=mls"};
  const std::vector<Source> made = sources_of(options);
  const neve::render::Image pixel{1, 1, 3, {0, 0, 0}};
  const auto write = [&](const neve::render::PngText& texts) {
    neve::app::output::write_file(folder / "card.png", neve::render::encode_png(pixel, texts));
  };
  write(texts_of(made));
  options = {};
  options.scenes = {(folder / "card.png").string()};
  options.overrides = {"material.snow.hardening=3"};
  const std::vector<Source> again = sources_of(options);
  ASSERT_EQ(again.size(), made.size());
  for (std::size_t k = 0; k < made.size(); ++k) {
    EXPECT_EQ(again[k].subject.title, made[k].subject.title);
    EXPECT_EQ(again[k].subject.material.density, made[k].subject.material.density);
    EXPECT_EQ(again[k].subject.solver.transfer, neve::sim::Transfer::mls);
  }
  EXPECT_EQ(again.back().subject.material.hardening, 3);

  neve::render::PngText broken = texts_of(made);
  for (const char* text : {"", "{}", "[1]", "[{\"scene\": \"\"}]"}) {
    broken["neve:card"] = text;
    write(broken);
    if (text == std::string("{}"))
      EXPECT_EQ(sources_of(options).size(), 2u) << "the scene counts";
    else
      EXPECT_THROW(sources_of(options), std::runtime_error) << text;
  }
}

TEST_F(CardSubjects, OfAPictureMayBeChosenByName) {
  const std::vector<Source> made = sources_of(options);
  const neve::render::Image pixel{1, 1, 3, {0, 0, 0}};
  neve::app::output::write_file(folder / "card.png",
                                neve::render::encode_png(pixel, texts_of(made)));
  options.scenes = {(folder / "card.png").string()};
  options.materials = {"sand"};
  EXPECT_EQ(titles(), Titles{"two: sand"});
  options.materials = {"spare"};
  try {
    sources_of(options);
    ADD_FAILURE() << "there is no card of it";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "--material: error: there is no material \"spare\"; expected snow, sand");
  }
}

/// A picture carries the scene as it was written: its curves, and what it sets beside them.
TEST_F(CardSubjects, OfAPictureFollowItsCurves) {
  folder.write("curve.toml", R"(
[material.snow]
youngs_modulus = 1e5
[[body]]
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }
[[curve]]
parameter = "material.snow.youngs_modulus"
keyframes = [{ time = 0, value = 2e4 }, { time = 1, value = 3e4 }]
)");
  options.scenes = {(folder.path() / "curve.toml").string()};
  const std::vector<Source> made = sources_of(options);
  EXPECT_EQ(made.front().subject.material.youngs_modulus, 2e4);
  const neve::render::Image pixel{1, 1, 3, {0, 0, 0}};
  neve::app::output::write_file(folder / "card.png",
                                neve::render::encode_png(pixel, texts_of(made)));
  options.scenes = {(folder.path() / "card.png").string()};
  const auto stiffness_with = [&](const std::string& change) {
    options.overrides = {change};
    return sources_of(options).front().subject.material.youngs_modulus;
  };
  EXPECT_EQ(stiffness_with("material.snow.hardening=3"), 2e4);
  EXPECT_EQ(stiffness_with("curve.1.keyframes=[{time=0,value=2e3}]"), 2e3);
  EXPECT_EQ(stiffness_with("curve.1=none"), 1e5);
  EXPECT_THROW(stiffness_with("material.snow.youngs_modulus=1e6"), UsageError);
}

/// Settings that are asked for count, also where the run of the picture has changed them later.
TEST_F(CardSubjects, OfAPictureHaveWhatIsSetAndOtherwiseWhatItsRunChanged) {
  neve::app::record::PictureRecord record;
  record.scene = neve::app::scene::write_scene(
      neve::app::scene::read_scene_file((folder.path() / "two.toml").string()));
  record.view = "particles";
  record.quality = "preview";
  record.state_hash = "0123456789abcdef";
  record.changes = {{3, "material.snow.hardening", "4"}};
  const neve::render::Image pixel{1, 1, 3, {0, 0, 0}};
  neve::app::output::write_file(
      folder / "branch.png",
      neve::render::encode_png(pixel, neve::app::record::to_png_text(record)));
  options.scenes = {(folder / "branch.png").string()};
  options.materials = {"snow"};
  const auto hardening_with = [&](const std::vector<std::string>& changes) {
    options.overrides = changes;
    return sources_of(options).front().subject.material.hardening;
  };
  EXPECT_EQ(hardening_with({}), 4);
  EXPECT_EQ(hardening_with({"material.snow.hardening=20"}), 20);
  EXPECT_EQ(hardening_with({"material.snow.preset=wet"}),
            neve::app::scene::snow_of(Preset::wet).hardening);
}

TEST_F(CardSubjects, AreNotMoreThanAPictureHolds) {
  options.presets.assign(9, Preset::wet);
  EXPECT_THROW(sources_of(options), UsageError);
}

/// Steps of three times what sound takes through a cell cannot be stable.
TEST(Cards, AnExperimentThatDivergesSaysSo) {
  Subject subject = subject_of(preset_snow(Preset::paper));
  subject.solver.acoustic_cfl = 3;
  const Experiment pressed = press(subject), torn = tear(subject), sheared = shear(subject);
  EXPECT_NE(pressed.failure.find("diverged"), std::string::npos) << pressed.failure;
  EXPECT_FALSE(pressed.shown.particles.x.empty()) << "it has a picture all the same";
  // Experiments that did not end give no verdict.
  for (const Experiment& stopped : {drop(subject), column(subject), pressed, torn, sheared}) {
    ASSERT_NE(stopped.failure, "");
    EXPECT_TRUE(stopped.words.empty()) << stopped.words.front();
    EXPECT_FALSE(stopped.measures.empty());
    for (const Measure& measure : stopped.measures)
      EXPECT_TRUE(std::isnan(measure.value)) << measure.name;
  }
  const Experiment tilted = tilt(subject);
  ASSERT_NE(tilted.failure, "");
  EXPECT_TRUE(tilted.words.empty() || tilted.words.front().starts_with("held up to "))
      << tilted.words.front();
}

}  // namespace
