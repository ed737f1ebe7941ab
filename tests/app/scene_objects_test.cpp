/// Whole objects by --set, and in the user's own file.

#include <gtest/gtest.h>

#include "app/scene/edit_text.h"
#include "app/scene/read.h"
#include "app/support/errors.h"

namespace neve::app {
namespace {

constexpr const char* objects_scene = R"(# A ball and two blocks.
frames = 3

# The one that falls.
[[body]]
name = "ball"   # round
# of snow
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } }

[[body]]
shape = { box = { center = [1, 0.1, 0], size = [0.2, 0.2, 0.2] } }
[[body]]
velocity = [1, 0, 0]
[body.shape.box]
center = [2, 0.1, 0]
size = [0.2, 0.2, 0.2]

# The ground.
[[collider]]
name = "floor"
shape = { plane = {} }
)";

std::vector<scene::Override> object_overrides(const std::vector<std::string>& sets) {
  std::vector<scene::Override> overrides;
  for (const std::string& set : sets) overrides.push_back(scene::parse_override(set));
  return overrides;
}

scene::Scene with_objects(const std::vector<std::string>& sets,
                          const std::string& text = objects_scene) {
  return scene::read_scene_text(text, "s.toml", "", object_overrides(sets));
}

std::string edited_objects(const std::vector<std::string>& sets,
                           const std::string& text = objects_scene) {
  return scene::edit_scene_text(text, object_overrides(sets));
}

std::string object_error(const std::string& argument) {
  try {
    with_objects({argument});
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no usage error";
}

constexpr const char* added_egg = "body.egg={shape={sphere={center=[3,1,0],radius=0.2}}}";

TEST(Objects, AnObjectIsAddedChangedAndRemoved) {
  scene::Scene scene = with_objects({added_egg, "body.egg.velocity=[0,-1,0]"});
  ASSERT_EQ(scene.bodies.size(), 4u);
  EXPECT_EQ(scene.bodies[3].name, "egg");
  EXPECT_EQ(scene.bodies[3].velocity.y(), -1);
  scene = with_objects({"collider.floor=none"});
  EXPECT_TRUE(scene.colliders.empty());
  scene = with_objects({"emitter.tap={shape={box={size=[1,1,1]}},rate=3}",
                        "sink.hole={shape={box={size=[1,1,1]}}}"});
  EXPECT_EQ(scene.emitters.at(0).rate, 3);
  EXPECT_EQ(scene.sinks.at(0).name, "hole");
}

/// Ids and seeds of snow are those of the place of its body.
TEST(Objects, ATableTakesThePlaceOfAnObjectOfThatName) {
  const std::vector<std::string> sets{"body.ball={shape={box={size=[1,1,1]}}}"};
  const scene::Scene scene = with_objects(sets);
  ASSERT_EQ(scene.bodies.size(), 3u);
  EXPECT_EQ(scene.bodies[0].name, "ball");
  EXPECT_TRUE(std::holds_alternative<sim::shapes::Box>(scene.bodies[0].shape.form));
  EXPECT_EQ(scene.bodies[1].name, "2");
  const std::string text = edited_objects(sets);
  EXPECT_EQ(scene::write_scene(with_objects({}, text)), scene::write_scene(scene)) << text;
  EXPECT_EQ(text.rfind("# A ball and two blocks.\nframes = 3\n\n[[body]]\nname = \"ball\"\n"
                       "shape = { box = { size = [1, 1, 1] } }\n\n[[body]]\n",
                       0),
            0u)
      << text;
  EXPECT_TRUE(edited_objects({"collider.floor={shape={plane={}}, friction=0.9}"})
                  .ends_with("\n[[collider]]\nname = \"floor\"\nshape = { plane = {} }\n"
                             "friction = 0.9\n"));
}

TEST(Objects, UnnamedOnesKeepTheirNumbersWhenAnotherIsRemoved) {
  const scene::Scene scene = with_objects({"body.ball=none", "body.3.velocity=[5,0,0]"});
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].name, "2");
  EXPECT_EQ(scene.bodies[1].name, "3");
  EXPECT_EQ(scene.bodies[1].velocity.x(), 5);
}

TEST(Objects, MistakesAreTold) {
  EXPECT_EQ(object_error("body.bull=none"),
            "--set body.bull=none: error: there is no body \"bull\"; did you mean \"ball\"?");
  EXPECT_EQ(object_error("body.slab=none"),
            "--set body.slab=none: error: there is no body \"slab\"; expected \"ball\", \"2\" or "
            "\"3\"");
  EXPECT_EQ(object_error("sink.hole=none"),
            "--set sink.hole=none: error: there is no sink \"hole\"; the scene has none");
  EXPECT_EQ(object_error("body.egg=3"),
            "--set body.egg=3: error: body.egg is a whole body: expected a table or none; for "
            "example body.egg={ shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } } }");
  EXPECT_EQ(object_error("body.egg={shape={sphere={}}}"),
            "--set body.egg={shape={sphere={}}}: error: body.egg.shape.sphere has no radius; "
            "expected radius (Radius, in m), for example radius = 0.1");
  EXPECT_EQ(object_error("body.egg={name=\"ball\",shape={sphere={radius=1}}}"),
            "--set body.egg={name=\"ball\",shape={sphere={radius=1}}}: error: its name is not "
            "\"egg\"; omit the name: it is in the address");
  EXPECT_EQ(object_error("body.e g={shape={sphere={radius=1}}}"),
            "--set body.e g={shape={sphere={radius=1}}}: error: bad body name \"e g\"; expected 1 "
            "to 64 letters, digits, _ and -");
  // Forgotten names are not names of new objects.
  EXPECT_EQ(object_error("body.shape={sphere={radius=1}}").find("whole body"), std::string::npos);
  EXPECT_NE(object_error("body.velocity=[0,0,0]").find("does not say which body"),
            std::string::npos);
}

TEST(Objects, AnAddedOneIsWrittenAtTheEndOfTheFile) {
  EXPECT_EQ(edited_objects({added_egg, "body.egg.velocity=[0,-1,0]"}),
            std::string(objects_scene) +
                "\n[[body]]\nname = \"egg\"\n"
                "shape = { sphere = { center = [3, 1, 0], radius = 0.2 } }\n"
                "velocity = [0,-1,0]\n");
}

TEST(Objects, ARemovedOneTakesItsCommentsAlong) {
  const std::string text = edited_objects({"body.ball=none"});
  EXPECT_EQ(text.find("falls"), std::string::npos) << text;
  EXPECT_EQ(text.find("of snow"), std::string::npos) << text;
  EXPECT_EQ(text.find("\n\n\n"), std::string::npos) << text;
  EXPECT_EQ(text.rfind("# A ball and two blocks.\nframes = 3\n\n[[body]]\n", 0), 0u) << text;
  EXPECT_NE(text.find("# The ground.\n[[collider]]\n"), std::string::npos) << text;
  EXPECT_NE(text.find("name = \"2\""), std::string::npos) << "the others keep their numbers";
  const std::string without_floor = edited_objects({"collider.floor=none"});
  EXPECT_EQ(without_floor.find("ground"), std::string::npos) << without_floor;
  EXPECT_TRUE(without_floor.ends_with("size = [0.2, 0.2, 0.2]\n")) << without_floor;
}

TEST(Objects, EveryObjectOfAFileCanBeRemovedAndPutBack) {
  for (const std::string address : {"body.ball", "body.2", "body.3", "collider.floor"}) {
    const std::string text = edited_objects({address + "=none"});
    const std::string again = edited_objects({address + "={shape={box={size=[1,1,1]}}}"}, text);
    const std::size_t bodies = with_objects({}).bodies.size();
    const bool is_body = address.starts_with("body");
    EXPECT_EQ(with_objects({}, text).bodies.size(), bodies - (is_body ? 1 : 0)) << text;
    EXPECT_EQ(with_objects({}, again).bodies.size(), bodies) << again;
  }
}

TEST(Objects, AListInOnePlaceIsLeftToItsAuthor) {
  const std::string text =
      "body = [{ name = \"a\", shape = { sphere = { radius = 0.1 } } }, { name = \"b\", shape = { "
      "sphere = { radius = 0.2 } } }]\n";
  EXPECT_EQ(edited_objects({"body.a=none"}, text),
            "body = [{ name = \"b\", shape = { sphere = { radius = 0.2 } } }]\n");
  EXPECT_THROW(edited_objects({added_egg}, text), UsageError);
}

TEST(Objects, CurvesViewsMosaicsAndExportsAreTakenAway) {
  const std::string text = std::string(objects_scene) + R"(
# It thaws.
[[curve]]
name = "thaw"
parameter = "material.snow.hardening"
keyframes = [{ time = 0, value = 5 }]
[[view]]
name = "p"
layers = ["particles"]
[[export]]
format = "ply"
)";
  const scene::Scene scene =
      with_objects({"curve.thaw=none", "view.p=none", "export.1=none"}, text);
  EXPECT_TRUE(scene.curves.empty());
  EXPECT_TRUE(scene.exports.empty());
  ASSERT_EQ(scene.views.size(), 1u) << "a scene shows something";
  EXPECT_EQ(scene.views[0].name, scene::read_scene_text(objects_scene, "s.toml").views[0].name);
  for (const char* set : {"curve.thaw=none", "view.p=none", "export.1=none"}) {
    const scene::Scene edited = scene::read_scene_text(edited_objects({set}, text), "s.toml");
    EXPECT_EQ(scene::write_scene(edited), scene::write_scene(with_objects({set}, text))) << set;
  }
  EXPECT_EQ(object_error("curve.thaw=none"),
            "--set curve.thaw=none: error: there is no curve \"thaw\"; the scene has none");
}

/// Sweeps, cards and comparisons take the first view of a scene.
TEST(Objects, AnEmptyListOfViewsIsNoList) {
  const scene::Scene scene =
      scene::read_scene_text(std::string("view = []\n") + objects_scene, "s");
  EXPECT_EQ(scene.views.size(), 1u);
}

}  // namespace
}  // namespace neve::app
