/// Objects of a scene are added, copied and removed in the view.

#include <gtest/gtest.h>

#include "app/output/atomic_file.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "tests/support/needs.h"
#include "tests/view/view_support.h"

namespace neve::test {
namespace {

using namespace app;
using view::session::Document;
using view::session::NewObject;

constexpr const char* two_things = R"(
frames = 4
[solver]
cell_size = 0.04
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }
velocity = [0, -2, 0]
[[collider]]
name = "floor"
shape = { plane = {} }
[[collider]]
name = "post"
shape = { capsule = { a = [1, 0, 0], b = [1, 0.5, 0], radius = 0.1 } }
keyframes = [{ time = 0, position = [1, 0.25, 0] }, { time = 1, position = [2, 0.25, 0] }]
)";

sim::shapes::Bounds bounds_of(const scene::Scene& scene, std::size_t body) {
  return sim::shapes::bounds(scene.bodies.at(body).shape);
}

TEST(Objects, EveryNewObjectIsASceneAndIsTakenBack) {
  Document document("scene.toml", two_things, {}, 1);
  using enum NewObject;
  for (const NewObject object : {snow_ball, snow_block, emitter, sink, sphere, box, floor}) {
    const view::session::AddedObject added =
        view::session::new_object(*document.scene(), object, {0, 0.1, 0}, 0.1);
    document.set(added.address, added.value);
    EXPECT_EQ(document.changes().back().address, added.address);
  }
  EXPECT_EQ(document.scene()->bodies.size(), 3u);
  EXPECT_EQ(document.scene()->emitters.size(), 1u);
  EXPECT_EQ(document.scene()->sinks.size(), 1u);
  EXPECT_EQ(document.scene()->colliders.size(), 5u);
  while (document.can_undo()) document.undo();
  EXPECT_EQ(document.scene()->bodies.size(), 1u);
  EXPECT_EQ(document.scene()->colliders.size(), 2u);
  while (document.can_redo()) document.redo();
  EXPECT_EQ(document.scene()->colliders.size(), 5u);
}

TEST(Objects, NewSnowIsAboveWhatExists) {
  Document document("scene.toml", two_things, {}, 1);
  for (int k = 0; k < 3; ++k) {
    const view::session::AddedObject added =
        view::session::new_object(*document.scene(), NewObject::snow_ball, {0, 0.1, 0}, 0.1);
    document.set(added.address, added.value);
  }
  const scene::Scene& scene = *document.scene();
  for (std::size_t k = 1; k < scene.bodies.size(); ++k)
    EXPECT_GT(bounds_of(scene, k).min.y(), bounds_of(scene, k - 1).max.y()) << k;
}

TEST(Objects, ACopyHasTheEditsOfItsOriginalAndAnotherPlace) {
  Document document("scene.toml", two_things, {}, 1);
  document.set("body.ball.velocity", "[7, 0, 0]");
  document.set("body.ball.shape.sphere.radius", "0.1");
  for (const char* address : {"body.ball", "collider.post", "collider.floor"}) {
    const view::session::AddedObject copy = view::session::copy_of(document, address);
    EXPECT_EQ(copy.address, std::string(address) + "_2");
    document.set(copy.address, copy.value);
  }
  const scene::Scene& scene = *document.scene();
  EXPECT_EQ(scene.bodies[1].velocity.x(), 7);
  EXPECT_GE(bounds_of(scene, 1).min.x(), bounds_of(scene, 0).max.x());
  EXPECT_EQ(std::get<sim::shapes::Sphere>(scene.bodies[1].shape.form).radius, 0.1);
  const scene::Collider& post = scene.colliders.at(2);
  ASSERT_EQ(post.keyframes.size(), 2u);
  const double way = std::get<sim::shapes::Capsule>(post.shape.form).a.x() - 1;
  EXPECT_GT(way, 0.2);
  EXPECT_NEAR(post.keyframes[1].position->x(), 2 + way, 1e-12);
  EXPECT_LT(std::get<sim::shapes::Plane>(scene.colliders.at(3).shape.form).point.y(), 0);
  // The copy of a copy, and that of an object without a name.
  EXPECT_EQ(view::session::copy_of(document, "body.ball_2").address, "body.ball_3");
  Document unnamed("scene.toml", "[[body]]\nshape = { sphere = { radius = 0.1 } }\n", {}, 1);
  EXPECT_EQ(view::session::copy_of(unnamed, "body.1").address, "body.body_2");
  EXPECT_THROW(view::session::copy_of(unnamed, "body.2"), UsageError);
}

/// A door has its own hinge, and a spring pulls to where it was.
TEST(Objects, ACopyOfAColliderTakesItsJointAndItsSpringAlong) {
  Document document("scene.toml", std::string(two_things) + R"(
[[collider]]
name = "door"
shape = { box = { center = [0, 0, 0.4], size = [0.2, 0.2, 0.05] } }
density = 500
joint = "hinge"
joint_point = [-0.1, 0, 0.4]
spring_stiffness = 100
[[collider]]
name = "cart"
shape = { box = { center = [0, 0, 2], size = [0.2, 0.2, 0.05] } }
density = 500
joint = "slider"
)",
                    {}, 1);
  for (const char* address : {"collider.door", "collider.cart"}) {
    const view::session::AddedObject copy = view::session::copy_of(document, address);
    document.set(copy.address, copy.value);
  }
  const std::vector<scene::Collider>& colliders = document.scene()->colliders;
  ASSERT_EQ(colliders.size(), 6u);
  const auto way = [&](std::size_t copy, std::size_t original) {
    return sim::Vec3d(sim::shapes::center(colliders[copy].shape) -
                      sim::shapes::center(colliders[original].shape));
  };
  const sim::shapes::RigidBody& door = colliders[4].body;
  EXPECT_GT(way(4, 2).norm(), 0.2);
  EXPECT_LT((door.joint_point - sim::Vec3d(-0.1, 0, 0.4) - way(4, 2)).norm(), 1e-12);
  EXPECT_LT((door.spring_place - way(4, 2)).norm(), 1e-12);
  // A slider has no point, and no spring pulls the cart.
  EXPECT_GT(way(5, 3).norm(), 0.2);
  EXPECT_EQ(colliders[5].body.joint_point, sim::Vec3d(0, 0, 0));
  EXPECT_EQ(colliders[5].body.spring_place, sim::Vec3d(0, 0, 0));
}

TEST(Objects, ARemovedObjectTakesItsEditsAlongAndUndoBringsBoth) {
  Document document("scene.toml", two_things, {}, 1);
  document.set("collider.post.friction", "0.9");
  document.set("collider.post", "none");
  EXPECT_EQ(document.scene()->colliders.size(), 1u);
  EXPECT_EQ(document.changes().size(), 1u);
  document.undo();
  EXPECT_EQ(document.scene()->colliders.at(1).friction, 0.9);
  // One that was added leaves no trace.
  document.set("body.egg", "{ shape = { sphere = { center = [1, 1, 1], radius = 0.1 } } }");
  document.set("body.egg.velocity", "[1, 0, 0]");
  document.set("body.egg", "none");
  EXPECT_EQ(document.changes().size(), 1u);
  EXPECT_THROW(document.set("body.ball", "none"), std::exception) << "a scene has snow";
  EXPECT_EQ(document.scene()->bodies.size(), 1u);
}

struct Working {
  explicit Working(const std::string& text = two_things) : bench(bench_for(folder, text)) {}
  const TemporaryFolder folder;
  view::session::Workbench bench;
};

TEST(Objects, AtTheStartTheyExistAtOnceAndLaterSnowWaitsForReset) {
  Working work;
  EXPECT_EQ(work.bench.add_object(NewObject::snow_ball, {0, 0.1, 0}, 0.1), "body.ball_2");
  auto live = wait_for(work.bench.session(), [](const view::session::LiveFrame& frame) {
    return frame.scene->bodies.size() == 2;
  });
  EXPECT_TRUE(work.bench.waiting_for_reset().empty());
  work.bench.session().next_frame();
  rest_at(work.bench.session(), 1);
  work.bench.add_object(NewObject::sink, {5, 0.1, 0}, 0.1);
  EXPECT_EQ(work.bench.copy_object("body.ball"), "body.ball_3");
  EXPECT_EQ(work.bench.waiting_for_reset().size(), 2u);
  // A value of a new object waits with it, and disturbs nothing else.
  work.bench.set("body.ball_3.velocity", "[0, -1, 0]");
  work.bench.set("collider.floor.friction", "0.2");
  EXPECT_EQ(work.bench.waiting_for_reset().size(), 2u);
  for (const auto& message : work.bench.messages())
    EXPECT_EQ(message.kind, view::session::Message::Kind::note) << message.text;
  live = wait_for(work.bench.session(), [](const view::session::LiveFrame& frame) {
    return frame.scene->colliders.at(0).friction == 0.2;
  });
  EXPECT_EQ(live->scene->bodies.size(), 2u);
  // A picture of the run has its objects, not those that wait.
  const record::PictureRecord record =
      work.bench.picture_record(*live, work.bench.document().scene()->views.front());
  EXPECT_EQ(scene::read_scene_text(record.scene, "record").bodies.back().name, "ball_2");
  work.bench.reset();
  live = wait_for(work.bench.session(), [](const view::session::LiveFrame& frame) {
    return frame.steps == 0 && frame.scene->bodies.back().name == "ball_3";
  });
  EXPECT_EQ(live->scene->bodies.back().velocity.y(), -1);
  EXPECT_TRUE(work.bench.waiting_for_reset().empty());
}

/// Colliders come and go in a run; a picture begins with those of its start.
TEST(Objects, CollidersComeAndGoAtOnce) {
  Working work;
  work.bench.session().next_frame();
  rest_at(work.bench.session(), 1);
  work.bench.set("collider.post", "none");
  const std::string sphere = work.bench.add_object(NewObject::sphere, {0.5, 0.1, 0}, 0.1);
  work.bench.set(sphere + ".friction", "0.3");
  work.bench.set(sphere + ".style", "\"wire\"");
  EXPECT_TRUE(work.bench.waiting_for_reset().empty());
  auto live = wait_for(work.bench.session(), [&](const view::session::LiveFrame& frame) {
    return frame.scene->colliders.back().name == "sphere" &&
           frame.scene->colliders.back().friction == 0.3;
  });
  EXPECT_EQ(live->scene->colliders.size(), 2u);
  const record::PictureRecord record =
      work.bench.picture_record(*live, work.bench.document().scene()->views.front());
  const scene::Scene start = scene::read_scene_text(record.scene, "record");
  ASSERT_EQ(start.colliders.size(), 2u);
  EXPECT_EQ(start.colliders[1].name, "post");
  ASSERT_EQ(record.changes.size(), 3u);
  EXPECT_EQ(record.changes[0].address, "collider.post");
  EXPECT_EQ(record.changes[0].value, "none");
  while (work.bench.document().can_undo()) work.bench.undo();
  live = wait_for(work.bench.session(), [](const view::session::LiveFrame& frame) {
    return frame.scene->colliders.back().name == "post";
  });
  EXPECT_EQ(live->scene->colliders.size(), 2u);
  for (const auto& message : work.bench.messages())
    EXPECT_EQ(message.kind, view::session::Message::Kind::note) << message.text;
}

TEST(Objects, LimitsHoldAndMistakesAreMessages) {
  Working work(std::string(two_things) + "[limits]\nparticles = 700\n");
  EXPECT_EQ(work.bench.add_object(NewObject::snow_block, {0, 0.1, 0}, 9), "");
  ASSERT_FALSE(work.bench.messages().empty());
  EXPECT_NE(work.bench.messages().back().text.find("limits.particles"), std::string::npos)
      << work.bench.messages().back().text;
  EXPECT_EQ(work.bench.copy_object("body.bull"), "");
  EXPECT_EQ(work.bench.messages().back().text, "there is no body.bull; select one of the list");
  work.bench.set("body.ball", "none");
  EXPECT_EQ(work.bench.messages().back().kind, view::session::Message::Kind::error);
  EXPECT_EQ(work.bench.document().scene()->bodies.size(), 1u);
}

TEST(Objects, ASavedSceneHasThem) {
  Working work;
  work.bench.add_object(NewObject::sphere, {0, 0.1, 0}, 0.2);
  work.bench.copy_object("body.ball");
  work.bench.set("collider.post", "none");
  work.bench.save_scene(work.folder / "out" / "scene.toml");
  const scene::Scene saved = scene::read_scene_file((work.folder / "out" / "scene.toml").string());
  EXPECT_EQ(saved.bodies.size(), 2u);
  ASSERT_EQ(saved.colliders.size(), 2u);
  EXPECT_EQ(saved.colliders[0].name, "floor");
  EXPECT_EQ(saved.colliders[1].name, "sphere");
  // The command line of the same changes makes the same scene.
  const Document& document = work.bench.document();
  const scene::Scene by_command =
      scene::read_scene_text(two_things, "scene.toml", "", document.all_overrides());
  EXPECT_EQ(by_command.colliders.size(), 2u);
  EXPECT_NE(work.bench.command().find("collider.post=none"), std::string::npos);
}

TEST(Objects, OverTheWebACopyMayNameTheFilesOfItsOriginal) {
  const TemporaryFolder folder;
  folder.write("points.csv", "x,y,z\n0,0,0\n0.1,0,0\n0,0.1,0\n0.1,0.1,0\n");
  view::session::WorkbenchOptions options;
  options.folder = folder / "out";
  options.is_remote = true;
  view::session::Workbench bench(
      view::session::open_document(
          folder.write("scene.toml",
                       "[solver]\ncell_size = 0.1\n[[body]]\nname = \"c\"\nshape = { points = { "
                       "file = \"points.csv\", spacing = 0.1 } }\n"),
          {}, 1)
          .document,
      options, {});
  EXPECT_EQ(bench.copy_object("body.c"), "body.c_2");
  EXPECT_EQ(bench.document().scene()->bodies.size(), 2u);
  bench.set("body.d", "{ shape = { points = { file = \"/etc/passwd\", spacing = 0.1 } } }");
  EXPECT_EQ(bench.messages().back().kind, view::session::Message::Kind::error);
  EXPECT_EQ(bench.document().scene()->bodies.size(), 2u);
}

class ObjectsByScript : public Cli {};

TEST_F(ObjectsByScript, TheyAreAddedCopiedAndRemovedByHand) {
  folder.write("clicks.json", R"([
    {"click": "Objects"}, {"wait_for": "label Add ..."},
    {"click": "Add ..."}, {"click": "Collider: a sphere"}, {"wait_for": "label collider.sphere"},
    {"wait_for": "label collider.sphere.friction"}, {"wait": 3},
    {"click": "Add ..."}, {"click": "Body: a sphere"}, {"wait_for": "label body.ball_2"},
    {"click": "Copy"}, {"wait_for": "label body.ball_3"}, {"wait": 5},
    {"screenshot": "objects.png"},
    {"click": "body.ball"}, {"wait_for": "label Remove"}, {"click": "Remove"}, {"wait": 3},
    {"click": "collider.floor"}, {"wait": 2}, {"click": "Remove"}, {"wait": 2},
    {"key": "z", "ctrl": true}, {"wait_for": "label collider.floor"},
    {"key": "s", "ctrl": true}, {"wait": 5}])");
  const auto result = neve({"view", "scene.toml", "--replay", "clicks.json", "--out", "out"});
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const scene::Scene saved = scene::read_scene_file((folder / "out" / "scene.toml").string());
  ASSERT_EQ(saved.bodies.size(), 2u);
  EXPECT_EQ(saved.bodies[0].name, "ball_2");
  EXPECT_EQ(saved.bodies[1].name, "ball_3");
  ASSERT_EQ(saved.colliders.size(), 2u);
  EXPECT_EQ(saved.colliders[1].name, "sphere");
  EXPECT_EQ(neve({"check", "out/scene.toml"}).exit_code, 0);
}

TEST_F(ObjectsByScript, TheArrowsMoveAHingeWithItsDoor) {
  folder.write("scene.toml", std::string(tiny_scene) + R"([[collider]]
name = "door"
shape = { box = { center = [0, 0.1, 0.2], size = [0.2, 0.2, 0.05] } }
density = 500
joint = "hinge"
joint_point = [-0.1, 0.1, 0.2]
)");
  folder.write("clicks.json", R"([
    {"click": "Objects"}, {"wait": 5}, {"click": "collider.door"}, {"wait": 5},
    {"drag": ["handle x", {"label": "picture", "part": [0.9, 0.5]}]}, {"wait": 5},
    {"key": "s", "ctrl": true}, {"wait": 5}])");
  const auto result = neve({"view", "scene.toml", "--replay", "clicks.json", "--out", "out"});
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const scene::Scene saved = scene::read_scene_file((folder / "out" / "scene.toml").string());
  const sim::Vec3d way = sim::shapes::center(saved.colliders[1].shape) - sim::Vec3d(0, 0.1, 0.2);
  EXPECT_GT(way.x(), 0.01);
  EXPECT_LT((saved.colliders[1].body.joint_point - sim::Vec3d(-0.1, 0.1, 0.2) - way).norm(), 1e-9);
}

}  // namespace
}  // namespace neve::test
