// Kinds of snow by name: the numbers they set, their precedence, and that pictures keep numbers.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "app/health/findings.h"
#include "app/scene/describe.h"
#include "app/scene/edit_text.h"
#include "app/scene/flat.h"
#include "app/scene/leaf.h"
#include "app/scene/names.h"
#include "app/scene/params.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "sim/laws/cam_clay.h"
#include "sim/laws/list.h"

namespace neve::app {
namespace {

const std::string body = "\n[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n";

app::scene::Scene preset_scene(const std::string& material,
                               const std::vector<std::string>& sets = {}) {
  std::vector<app::scene::Override> overrides;
  for (const std::string& set : sets) overrides.push_back(app::scene::parse_override(set));
  return app::scene::read_scene_text(material + body, "s.toml", "", overrides);
}

sim::Material preset_snow(const std::string& material, const std::vector<std::string>& sets = {}) {
  return preset_scene(material, sets).materials.at(0);
}

const std::string powder = "[material.snow]\npreset = \"powder\"\n";

TEST(Preset, PresetOfThePaperIsTheDefault) {
  EXPECT_EQ(app::scene::preset_of(sim::Material{}), app::scene::Preset::paper);
}

TEST(Preset, EveryPresetHasDistinctValidNumbers) {
  std::set<std::string> written;
  for (const auto& name : app::scene::names(app::scene::Preset{})) {
    const app::scene::Scene scene =
        preset_scene("[material.snow]\npreset = \"" + std::string(name.text) + "\"\n");
    EXPECT_EQ(app::scene::preset_of(scene.materials[0]), name.value) << name.text;
    // Writing and reading back refuses what is out of range.
    const std::string text = app::scene::write_scene(scene);
    EXPECT_EQ(app::scene::write_scene(app::scene::read_scene_text(text, "again", "")), text)
        << name.text;
    EXPECT_TRUE(written.insert(text).second) << name.text << " is the same as another one";
  }
}

TEST(Preset, PresetSetsEveryNumberOfTheSnowAndNothingElse) {
  app::scene::Scene before = preset_scene("");
  sim::Material& m = before.materials[0];
  m.density = m.youngs_modulus = m.hardening = m.consolidation_pressure = 3;
  m.friction_angle = m.own[sim::laws::cam_clay::cohesion] =
      m.own[sim::laws::cam_clay::consolidation_hardening] = 2;
  m.poisson_ratio = m.dust = m.critical_compression = m.critical_stretch = 0.123;
  m.model = sim::laws::model::corotated;
  app::scene::Scene after = before;
  app::scene::use_preset(after.materials[0], app::scene::Preset::icy);
  std::vector<std::string> changed;
  for (const app::scene::Difference& difference : app::scene::differences(before, after))
    changed.push_back(difference.address);
  EXPECT_EQ(changed, app::scene::addresses_set_by("material.snow.preset"));
  EXPECT_EQ(changed.size(), 11u);
}

TEST(Preset, NumbersBesideAPresetOverrideIt) {
  const sim::Material m = preset_snow("[material.snow]\nhardening = 3\npreset = \"powder\"\n");
  EXPECT_EQ(m.hardening, 3);
  EXPECT_EQ(m.density, app::scene::snow_of(app::scene::Preset::powder).density);
  EXPECT_EQ(m.critical_stretch, app::scene::snow_of(app::scene::Preset::powder).critical_stretch);
}

TEST(Preset, NumbersOfTheCommandLineOverrideAPreset) {
  for (const auto& sets : {std::vector<std::string>{"material.snow.hardening=3"},
                           {"material.snow.preset=icy", "material.snow.hardening=3"},
                           {"material.snow.hardening=3", "material.snow.preset=icy"}}) {
    const sim::Material m = preset_snow(powder, sets);
    EXPECT_EQ(m.hardening, 3);
    EXPECT_EQ(m.density, app::scene::snow_of(sets.size() == 1 ? app::scene::Preset::powder
                                                              : app::scene::Preset::icy)
                             .density);
  }
}

// The scene kept with a picture gives all its numbers; a preset set for it must not do nothing.
TEST(Preset, PresetOfTheCommandLineOverridesTheFile) {
  EXPECT_EQ(app::scene::preset_of(
                preset_snow("[material.snow]\nhardening = 3\n", {"material.snow.preset=wet"})),
            app::scene::Preset::wet);
  const std::string kept = app::scene::write_scene(preset_scene(powder));
  const app::scene::Scene again = app::scene::read_scene_text(
      kept, "s.toml", "", {app::scene::parse_override("material.snow.preset=\"packed\"")});
  EXPECT_EQ(app::scene::preset_of(again.materials[0]), app::scene::Preset::packed);
}

/// A preset sets the numbers of all laws; one that a person types and the law does not read is
/// told.
TEST(Preset, NumbersThatTheLawDoesNotReadAreNoMistakeOfAnyone) {
  const auto findings = [](const std::string& more) {
    std::vector<app::health::Finding> found;
    app::health::check_unused(
        preset_scene("[material.snow]\nmodel = \"cam_clay\"\npreset = \"wet\"\n" + more), 1, found);
    return found;
  };
  EXPECT_TRUE(findings("").empty());
  EXPECT_TRUE(findings("cohesion = 0.3\n").empty());
  ASSERT_EQ(findings("hardening = 3\n").size(), 1u);
  EXPECT_EQ(findings("hardening = 3\n")[0].address, "material.snow.hardening");
}

TEST(Preset, ARemovedPresetLeavesTheNumbersOfTheFile) {
  const sim::Material m = preset_snow(powder + "hardening = 3\n", {"material.snow.preset=none"});
  EXPECT_EQ(m.hardening, 3);
  EXPECT_EQ(m.density, sim::Material{}.density);
}

TEST(Preset, PresetIsWrittenAsNumbers) {
  const std::string text = app::scene::write_scene(preset_scene(powder + "hardening = 3\n"));
  EXPECT_EQ(text.find("preset"), std::string::npos) << text;
  const sim::Material m = app::scene::read_scene_text(text, "again", "").materials[0];
  EXPECT_EQ(m.hardening, 3);
  EXPECT_EQ(m.youngs_modulus, app::scene::snow_of(app::scene::Preset::powder).youngs_modulus);
}

TEST(Preset, PresetOfAnUnknownNameIsRefusedWithTheNearest) {
  try {
    preset_snow("[material.snow]\npreset = \"powdr\"\n");
    ADD_FAILURE() << "was read";
  } catch (const app::scene::toml::SceneError& error) {
    EXPECT_EQ(error.line, 2);
    EXPECT_NE(std::string(error.what()).find("did you mean \"powder\"?"), std::string::npos)
        << error.what();
  }
  try {
    preset_snow("", {"material.snow.preset=ice"});
    ADD_FAILURE() << "was set";
  } catch (const app::UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"icy\"?"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(preset_snow("[material.snow]\npreset = 3\n"), app::scene::toml::SceneError);
}

TEST(Preset, PresetIsListedWithItsChoices) {
  const auto info = app::scene::param_at("material.snow.preset");
  ASSERT_TRUE(info);
  EXPECT_EQ(info->choices, app::scene::choices<app::scene::Preset>());
  // Density needs a restart; kept changes of a running simulation are numbers.
  EXPECT_FALSE(app::scene::is_live("material.snow.preset"));
}

TEST(Preset, PresetIsDocumentedWithItsNumbers) {
  std::ifstream file(std::string(NEVE_SOURCE_DIR) + "/docs/scenes.md");
  std::map<std::string, std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::string bar, name, word;
    if (!(cells >> bar >> name) || bar != "|") continue;
    while (cells >> word)
      if (word[0] >= '0' && word[0] <= '9')
        rows[name].push_back(std::strtod(word.c_str(), nullptr));
  }
  for (const auto& name : app::scene::names(app::scene::Preset{})) {
    const sim::Material m = app::scene::snow_of(name.value);
    EXPECT_EQ(rows[name.text],
              (std::vector<double>{m.density, m.youngs_modulus, m.poisson_ratio, m.hardening,
                                   m.critical_compression, m.critical_stretch, m.friction_angle,
                                   m.own[sim::laws::cam_clay::cohesion], m.consolidation_pressure,
                                   m.own[sim::laws::cam_clay::consolidation_hardening]}))
        << name.text;
  }
}

TEST(Preset, APresetSavedToAFileReplacesItsNumbers) {
  const std::string text =
      "[material.snow]   # mine\ndensity = 300   # heavy\nmodel = \"snow\"\nhardening = 4\n" + body;
  const std::string expected =
      "[material.snow]   # mine\nmodel = \"snow\"\npreset = \"wet\"\nhardening = 7\n" + body;
  EXPECT_EQ(
      app::scene::edit_scene_text(text, {app::scene::parse_override("material.snow.hardening=7"),
                                         app::scene::parse_override("material.snow.preset=wet")}),
      "[material.snow]   # mine\nmodel = \"snow\"\nhardening = 7\npreset = \"wet\"\n" + body);
  EXPECT_EQ(
      app::scene::edit_scene_text(text, {app::scene::parse_override("material.snow.preset=wet"),
                                         app::scene::parse_override("material.snow.hardening=7")}),
      expected);
}

}  // namespace
}  // namespace neve::app
