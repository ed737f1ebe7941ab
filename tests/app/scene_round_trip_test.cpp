// Everything that describe.h describes survives writing and reading. A visitor changes every
// parameter and another reads them all back, so a new parameter is covered as soon as it is
// described.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "app/scene/describe.h"
#include "app/scene/names.h"
#include "app/scene/read.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

/// The two ways to walk a scene share how they descend.
template <class Self>
class Walker {
 public:
  explicit Walker(std::string prefix) : prefix_(std::move(prefix)) {}

  template <class Describe>
  void section(const char* key, const char*, Describe describe_members) {
    Self inner = self().inside(key);
    describe_members(inner);
  }
  template <class T>
  void optional(const char* key, std::optional<T>& member, const char*) {
    if (!member) return;
    Self inner = self().inside(key);
    app::scene::describe(inner, *member);
  }
  template <class T>
  void named(const char* key, std::vector<T>& items, const char*) {
    list(key, items, "");
  }
  template <class T>
  void list(const char* key, std::vector<T>& items, const char*) {
    for (T& item : items) {
      Self inner = self().inside(key + ("." + item.name));
      app::scene::describe(inner, item);
    }
  }
  template <class T>
  void sequence(const char* key, std::vector<T>& items, const char*) {
    for (std::size_t k = 0; k < items.size(); ++k) {
      Self inner = self().inside(key + ("." + std::to_string(k)));
      app::scene::describe(inner, items[k]);
    }
  }
  template <class Describe>
  void shape(const char* key, sim::shapes::Shape& shape, const char*, Describe describe_forms) {
    Self inner = self().inside(key);
    describe_forms(inner, shape);
  }
  template <class Form>
  void form(const char* key, sim::shapes::Shape& shape, app::scene::Change change, const char*) {
    Form* form = std::get_if<Form>(&shape.form);
    if (!form) return;
    Self inner = self().inside(key);
    app::scene::describe(inner, *form, change);
    app::scene::describe_rotation(inner, shape, change);
  }
  /// Says nothing that is not written elsewhere.
  template <class... Rest>
  void shorthand(const char*, Rest&&...) {}

 protected:
  std::string prefix_;

 private:
  Self& self() { return static_cast<Self&>(*this); }
};

/// Sets every parameter to a valid value that is not its default, each to another one.
class Perturb : public Walker<Perturb> {
 public:
  Perturb(std::string prefix, int& count) : Walker(std::move(prefix)), count_(count) {}
  Perturb inside(const std::string& key) { return {prefix_ + key + ".", count_}; }

  template <class T>
  void operator()(const char* key, T& member, const char*, const app::scene::Valid& valid,
                  app::scene::Change, const char*) {
    if (valid.text != app::scene::Valid::Text::any)
      return;  // names and files hold the scene together
    ++count_;
    change(member, valid, prefix_ + key);
  }

 private:
  /// Returns a number between the bounds, with digits that only an exact round trip keeps.
  double fraction(const app::scene::Valid& valid) {
    const double low = std::isfinite(valid.min) ? valid.min : 0;
    const double high = std::isfinite(valid.max) ? valid.max : low + 1;
    return low + (high - low) * std::fmod(0.6180339887498949 * (count_ + 1), 1.0);
  }
  void change(bool& is_on, const app::scene::Valid&, const std::string&) { is_on = !is_on; }
  void change(double& x, const app::scene::Valid& valid, const std::string&) {
    x = fraction(valid);
  }
  void change(int& i, const app::scene::Valid& valid, const std::string&) {
    i = static_cast<int>(fraction(valid));
  }
  void change(std::uint64_t& i, const app::scene::Valid& valid, const std::string&) {
    i = static_cast<std::uint64_t>(fraction(valid));
  }
  void change(std::string& s, const app::scene::Valid&, const std::string&) {
    s = "\"névé\" \\ 😀\n\t\x01\x7f #'";
  }
  void change(sim::Vec3d& v, const app::scene::Valid& valid, const std::string& at) {
    for (double& x : {std::ref(v.x()), std::ref(v.y()), std::ref(v.z())}) {
      ++count_;
      change(x, valid, at);
    }
  }
  void change(app::scene::PictureSize& size, const app::scene::Valid& valid,
              const std::string& at) {
    change(size.width, valid, at);
    ++count_;
    change(size.height, valid, at);
  }
  void change(std::vector<std::string>&, const app::scene::Valid&, const std::string&) {
  }  // names of views
  void change(std::optional<app::scene::Range>& range, const app::scene::Valid&,
              const std::string&) {
    range = app::scene::Range{-1.0 / 3, 1e30};
  }
  template <class T>
  void change(std::optional<T>& member, const app::scene::Valid& valid, const std::string& at) {
    change(member.emplace(), valid, at);
  }
  void change(sim::laws::OneOf& name, const app::scene::Valid&, const std::string&) {
    name.place = name.names.size() - 1 - name.place;
  }
  template <scene::Choice E>
  void change(E& e, const app::scene::Valid&, const std::string& at) {
    const E before = e, last = app::scene::names(E{}).back().value;
    e = before == last ? app::scene::names(E{}).front().value : last;
    EXPECT_NE(e, before) << at;
  }
  template <scene::Choice E>
  void change(std::vector<E>& list, const app::scene::Valid&, const std::string&) {
    list = {app::scene::names(E{}).back().value, app::scene::names(E{}).front().value};
  }

  int& count_;
};

/// Every parameter's exact value by address.
class Flatten : public Walker<Flatten> {
 public:
  using Values = std::map<std::string, std::vector<std::uint64_t>>;
  Flatten(std::string prefix, Values& values) : Walker(std::move(prefix)), values_(values) {}
  Flatten inside(const std::string& key) { return {prefix_ + key + ".", values_}; }

  template <class T>
  void operator()(const char* key, T& member, const char*, const app::scene::Valid&,
                  app::scene::Change, const char*) {
    add(values_[prefix_ + key], member);
  }

 private:
  using Bits = std::vector<std::uint64_t>;
  static void add(Bits& bits, double x) { bits.push_back(std::bit_cast<std::uint64_t>(x)); }
  static void add(Bits& bits, int i) { bits.push_back(static_cast<std::uint64_t>(i)); }
  static void add(Bits& bits, std::uint64_t i) { bits.push_back(i); }
  static void add(Bits& bits, const std::string& s) {
    for (const char c : s) bits.push_back(static_cast<unsigned char>(c));
  }
  static void add(Bits& bits, const sim::Vec3d& v) {
    for (const double x : {v.x(), v.y(), v.z()}) add(bits, x);
  }
  static void add(Bits& bits, const std::vector<std::string>& list) {
    for (const std::string& item : list) add(bits, item);
  }
  static void add(Bits& bits, const app::scene::PictureSize& size) {
    add(bits, size.width);
    add(bits, size.height);
  }
  static void add(Bits& bits, const app::scene::Range& range) {
    add(bits, range.min);
    add(bits, range.max);
  }
  template <class T>
  static void add(Bits& bits, const std::optional<T>& member) {
    if (member) add(bits, *member);
  }
  static void add(Bits& bits, const sim::laws::OneOf& name) { bits.push_back(name.place); }
  template <scene::Choice E>
  static void add(Bits& bits, const E& e) {
    bits.push_back(static_cast<std::uint64_t>(e));
  }
  template <scene::Choice E>
  static void add(Bits& bits, const std::vector<E>& list) {
    for (const E& e : list) add(bits, e);
  }

  Values& values_;
};

Flatten::Values values_of(app::scene::Scene scene) {
  Flatten::Values values;
  Flatten flatten("", values);
  app::scene::describe(flatten, scene);
  return values;
}

/// A form with the sizes that it needs.
std::string sized(const std::string& form) {
  const std::map<std::string, const char*> sizes{
      {"sphere", "radius = 0.1"},
      {"box", "size = [0.2, 0.2, 0.2]"},
      {"capsule", "a = [0, 0, 0], b = [0, 0.2, 0], radius = 0.1"},
      {"cylinder", "radius = 0.1, height = 0.2"},
      {"cone", "radius = 0.1, height = 0.2"},
      {"torus", "major_radius = 0.15, minor_radius = 0.05"}};
  const auto found = sizes.find(form);
  return form + " = { " + (found == sizes.end() ? "" : found->second) + " }";
}

/// A scene with every optional part and every form, named and unnamed things.
app::scene::Scene full_scene(const std::string& mesh_file) {
  std::string text =
      "[camera]\neye = [0, 1, 2]\ntarget = [0, 0, 0]\nkeyframes = [{ time = 1 }, { time = 2 }]\n"
      "[material.ice]\n";
  for (const char* form : {"sphere", "box", "capsule", "cylinder", "cone", "torus"}) {
    text += "[[body]]\nmaterial = \"ice\"\nshape = { " + sized(form) + " }\n";
  }
  text +=
      "[[emitter]]\nname = \"spout\"\nshape = { box = { size = [0.2, 0.2, 0.2] } }\nrate = 1\nend "
      "= 1\n";
  text +=
      "[[sink]]\nname = \"pit\"\nshape = { torus = { major_radius = 0.15, minor_radius = 0.05 } "
      "}\n";
  text += "[[body]]\nname = \"points\"\nshape = { points = { file = \"" + mesh_file + "\" } }\n";
  text += "[[body]]\nname = \"mesh\"\nshape = { mesh = { file = \"" + mesh_file + "\" } }\n";
  for (const char* form : {"plane", "sphere", "box", "capsule", "cylinder", "cone", "torus"}) {
    text += "[[collider]]\nshape = { " + sized(form) + " }\n";
  }
  text += "[[collider]]\nname = \"mesh\"\nshape = { mesh = { file = \"" + mesh_file + "\" } }\n";
  text +=
      "[[collider]]\nname = \"sheet\"\nshape = { mesh_sequence = { files = \"sheet_%d.obj\", last "
      "= 2 "
      "} }\n";
  text +=
      "[[collider]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\nkeyframes = [{ time = 1 }, { "
      "time = 2 }]\n";
  text +=
      "[[view]]\n[[view]]\nname = \"close\"\ncamera = { eye = [1,1,1], target = [0,0,0] }\n"
      "clip = { point = [1, 2, 3] }\n[[mosaic]]\nname = \"wall\"\nviews = "
      "[\"close\"]\n[[export]]\nname = \"geometry\"\n"
      "bodies = [\"points\"]\n";
  return app::scene::read_scene_text(text, "full",
                                     std::filesystem::path(mesh_file).parent_path().string());
}

class RoundTrip : public testing::Test {
 protected:
  RoundTrip() {
    std::ofstream(mesh_) << test::box_obj({1, 1, 1});
    for (int k = 1; k < 6; ++k)
      folder_.write("sheet_" + std::to_string(k) + ".obj", test::box_obj({1, 1, 1}));
  }
  test::TemporaryFolder folder_;
  std::string mesh_ = (folder_ / "round_trip_é.obj").string();
};

TEST_F(RoundTrip, RoundTripKeepsEveryParameterBitForBit) {
  const app::scene::Scene plain = full_scene(mesh_);
  app::scene::Scene scene = plain;
  int count = 0;
  Perturb perturb("", count);
  app::scene::describe(perturb, scene);
  EXPECT_GT(count, 150) << "the visitor did not get everywhere";
  // Numbers that only hold together are put right.
  for (sim::shapes::Shape* shape :
       {&scene.bodies[5].shape, &scene.colliders[6].shape, &scene.sinks[0].shape}) {
    auto& torus = std::get<sim::shapes::Torus>(shape->form);
    torus.minor_radius = torus.major_radius / 3;
  }
  for (sim::Material& material : scene.materials) material.critical_compression = 1.0 / 300;
  scene.emitters[0].end = scene.emitters[0].start + 1.0 / 3;
  auto& sheet = std::get<sim::shapes::MeshSequence>(scene.colliders[8].shape.form);
  sheet.first = 3;
  sheet.last = 5;
  app::scene::Collider& moved = scene.colliders.back();
  moved.velocity.setZero();
  moved.angular_velocity.setZero();
  moved.keyframes[1].time = moved.keyframes[0].time + 1.0 / 3;
  moved.keyframes[1].rotation = *moved.keyframes[0].rotation + sim::Vec3d(10.0 / 3, 20, 30);
  // Bodies that move by themselves have a scene of their own, below: keyframes and meshes that
  // deform exclude them.
  for (app::scene::Collider& collider : scene.colliders) collider.body = {};
  scene.solver.cell_size = 10.1;
  scene.fps = 25;  // a rate that time codes have
  scene.shot.time_code = "01:02:03:04";
  const auto put_near = [](sim::shapes::Shape& shape) {
    if (auto* mesh = std::get_if<sim::shapes::Mesh>(&shape.form)) mesh->origin = {1.0 / 3, 2, 3};
  };
  for (sim::seeding::Body& body : scene.bodies) put_near(body.shape);
  for (app::scene::Collider& collider : scene.colliders) put_near(collider.shape);
  for (app::scene::View& view : scene.views) {
    view.slice.follow = "mesh";
    view.slice.isolines = 7;
    if (view.camera) view.camera->follow = "mesh", view.camera->push_in = false;
  }
  scene.camera->follow = "mesh";
  for (app::scene::Export& e : scene.exports) e.dust = false;  // it has a surface
  scene.camera->turntable.reset();                             // there is an orbit
  scene.camera->push_in = false;                               // there is an eye
  scene.views[1].camera->orbit.reset();
  scene.camera->keyframes[1].time = scene.camera->keyframes[0].time + 1.0 / 3;

  const std::string text = app::scene::write_scene(scene);
  const app::scene::Scene again = app::scene::read_scene_text(text, "written");
  const auto before = values_of(scene), after = values_of(again), unchanged = values_of(plain);
  EXPECT_EQ(before.size(), after.size());
  for (const auto& [address, bits] : before) EXPECT_EQ(after.at(address), bits) << address;
  EXPECT_EQ(app::scene::write_scene(again), text);

  // The test notices a parameter that was left alone.
  int same = 0;
  for (const auto& [address, bits] : before)
    same += unchanged.contains(address) && unchanged.at(address) == bits;
  constexpr int of_a_body = 13;
  EXPECT_EQ(same, 22 + 8 + 3 + 2 + 2 + 2 + 3 + 2 + 1 + 2 +
                      of_a_body * static_cast<int>(scene.colliders.size()))
      << "only names, materials, files, the turns and moves not taken, velocities beside keyframes "
         "and dust stay";
}

TEST_F(RoundTrip, RoundTripKeepsABodyThatMovesByItself) {
  const app::scene::Scene plain = app::scene::read_scene_text(
      "[[body]]\nshape = { sphere = { radius = 0.1 } }\n[[collider]]\nname = \"block\"\nshape = { "
      "box "
      "= { size = [0.2, 0.2, 0.2] } }\n",
      "s");
  app::scene::Scene scene = plain;
  int count = 0;
  Perturb perturb("", count);
  app::scene::describe(perturb, scene.colliders[0]);
  sim::shapes::RigidBody& body = scene.colliders[0].body;
  scene.solver.cell_size = 10.1;
  body.mass = 0;  // there is a density
  body.inertia = {1.0 / 3, 0.4, 0.5};
  body.joint = sim::shapes::Joint::hinge;
  const std::string text = app::scene::write_scene(scene);
  const app::scene::Scene again = app::scene::read_scene_text(text, "written");
  EXPECT_EQ(values_of(again), values_of(scene));
  EXPECT_EQ(app::scene::write_scene(again), text);
  const auto before = values_of(scene), unchanged = values_of(plain);
  int same = 0;
  for (const auto& [address, bits] : before)
    same += address.starts_with("collider.") && unchanged.at(address) == bits;
  EXPECT_EQ(same, 2) << "only the name and the mass stay";
}

TEST_F(RoundTrip, RoundTripKeepsAnAutomaticScene) {
  const app::scene::Scene scene = app::scene::read_scene_text(
      "[camera]\nfov = 20\n[[body]]\nshape = {box = { size = [0.2, 0.2, 0.2] }}", "s");
  const app::scene::Scene again =
      app::scene::read_scene_text(app::scene::write_scene(scene), "written");
  EXPECT_EQ(values_of(scene), values_of(again));
  EXPECT_FALSE(again.camera->eye.has_value());
  EXPECT_FALSE(again.views.at(0).camera.has_value());
  EXPECT_FALSE(again.views.at(0).size.has_value());
  EXPECT_FALSE(again.views.at(0).particles.range.has_value());
}

TEST_F(RoundTrip, RoundTripFindsMeshesFromAnywhere) {
  const app::scene::Scene scene = full_scene(mesh_);
  const std::string file = std::get<sim::shapes::Mesh>(scene.bodies.back().shape.form).file;
  EXPECT_TRUE(std::filesystem::path(file).is_absolute());
  const app::scene::Scene again =
      app::scene::read_scene_text(app::scene::write_scene(scene), "written", "/elsewhere");
  EXPECT_EQ(std::get<sim::shapes::Mesh>(again.bodies.back().shape.form).file, file);
}

TEST(NumberText, NumberTextReadsBackExactly) {
  EXPECT_EQ(app::scene::toml::number_text(5e-4), "5e-4");
  EXPECT_EQ(app::scene::toml::number_text(0.001), "0.001");
  EXPECT_EQ(app::scene::toml::number_text(1e30), "1e30");
  EXPECT_EQ(app::scene::toml::number_text(100000), "100000");
  EXPECT_EQ(app::scene::toml::number_text(-0.0), "-0.0");
  EXPECT_EQ(app::scene::toml::number_text(1e-300), "1e-300");
  EXPECT_EQ(app::scene::toml::number_text(12345678901234567890.0), "12345678901234567168.0");
  EXPECT_EQ(app::scene::toml::number_text(0.1 + 0.2), "0.30000000000000004");
}

TEST(SceneDefaults, SceneDefaultsAreThoseOfTheStructs) {
  const app::scene::Scene scene =
      app::scene::read_scene_text("[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }", "s");
  EXPECT_EQ(scene.frames, app::scene::Scene{}.frames);
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "snow");
  EXPECT_EQ(scene.materials[0].hardening, sim::Material{}.hardening);
  EXPECT_EQ(scene.bodies[0].name, "1");
  EXPECT_EQ(scene.bodies[0].material, "snow");
  ASSERT_EQ(scene.views.size(), 1u);
  EXPECT_EQ(scene.views[0].name, "snow");
  EXPECT_FALSE(scene.camera.has_value());
}

TEST(SceneReader, SceneReaderAcceptsWholeFloatsAsIntegersAndBack) {
  const app::scene::Scene scene = app::scene::read_scene_text(
      "frames = 12.0\nfps = 30\n[limits]\nmemory = \"1.5 kB\"\nparticles = 2e7\n[[body]]\nshape = "
      "{ sphere = { radius = 1 } }",
      "s");
  EXPECT_EQ(scene.frames, 12);
  EXPECT_EQ(scene.fps, 30);
  EXPECT_EQ(scene.limits.memory, 1500u);
  EXPECT_EQ(scene.limits.particles, 20'000'000u);
}

TEST(SceneReader, ASceneOverridesOnlyTheNumbersThatItNames) {
  const app::scene::Scene scene = app::scene::read_scene_text(
      "[material.snow]\nhardening = 7\n[[body]]\nshape = { sphere = { radius = 0.1 } }", "s");
  EXPECT_EQ(scene.materials.at(0).hardening, 7);
  EXPECT_EQ(scene.materials.at(0).density, sim::Material{}.density);
}

}  // namespace
}  // namespace neve::app
