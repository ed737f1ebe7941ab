// Text that broke a parser once, or could: a SceneError each, never anything else.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "app/scene/read.h"

namespace neve::app {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

void expect_scene_error(const std::string& text, const std::string& name) {
  try {
    app::scene::read_scene_text(text, name);
    ADD_FAILURE() << name << " was read";
  } catch (const app::scene::toml::SceneError& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with(name + ":")) << what;
    EXPECT_LT(what.size(), 2000u) << name;
  }
}

TEST(TomlCorpus, EveryFileIsASceneError) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(NEVE_SOURCE_DIR "/tests/corpus/toml")) {
    expect_scene_error(bytes_of(entry.path()), entry.path().filename().string());
    ++count;
  }
  EXPECT_GE(count, 30);
}

/// Inputs whose size is the point are made here instead of kept.
TEST(TomlCorpus, DeepAndLongInputIsASceneError) {
  const auto repeated = [](const std::string& what, int times) {
    std::string text;
    for (int k = 0; k < times; ++k) text += what;
    return text;
  };
  expect_scene_error("[a" + repeated(".a", 200000) + "]", "deep_header");
  expect_scene_error("a" + repeated(".a", 200000) + " = 1", "deep_key");
  expect_scene_error("a = " + repeated("[", 20000), "brackets");
  expect_scene_error("a = " + repeated("[", 20000) + repeated("]", 20000), "closed_brackets");
  expect_scene_error("a = " + repeated("{a=", 20000), "braces");
  expect_scene_error(repeated("[a]\n", 20000), "many_headers");
  expect_scene_error("title = \"" + repeated("é", 400000) + "\"\nx", "long_string");
  expect_scene_error(repeated("x", 1 << 21), "two_megabytes");
  expect_scene_error("a = [" + repeated("{" + repeated("a.", 60) + "a = [\n", 16), "dots_in_lines");
  expect_scene_error(repeated("[[body]]\n", 50000), "many_bodies");
}

constexpr const char* seed_text = R"(# Boule de névé
title = "Boule de \"névé\" \u00e9"
frames = 48
fps = 24.0
seed = 0x1F
[solver]
cell_size = 2e-2
kernel = 'cubic'
gravity = [0, -9.81, 0]
[limits]
memory = "8GiB"
[material.snow]
poisson_ratio = 0.2
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.6, 0], radius = 0.15, rotation = [0, 0, 90] } }
velocity = [0, -3, 0]
sampling = "poisson"
[[body]]
shape = { torus = { major_radius = 0.2, minor_radius = 0.1 } }
[[collider]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
contact = "sticky"
[camera]
eye = [0, 1, 2]
target = [0, 0, 0]
[[view]]
name = """close"""
layers = ["ground", "caption"]
particles = { color_by = "speed", range = [0, 1] }
[output]
size = [1280, 720]
)";

/// Makes the same mutations on every machine.
class Mutator {
 public:
  std::string operator()(std::string text) {
    for (int k = pick(1, 3); k > 0; --k) mutate(text);
    return text;
  }

 private:
  int pick(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
  }

  void mutate(std::string& text) {
    static const std::string pieces[] = {
        "\"",  "'",    "\"\"\"", "'''", "\\",  "\n",   "\r\n", "[",   "]",    "{",      "}",  "=",
        ".",   ",",    "#",      "é",   "😀",   "\xFF", "\x1b", "nan", "-inf", "1e308",  "0",  "-1",
        "\\u", "true", "[[",     "]]",  "1e9", "\t",   "_",    "0x",  "9e99", "\\\n é", "\\é"};
    if (text.empty()) return;
    const auto at = static_cast<std::size_t>(pick(0, static_cast<int>(text.size()) - 1));
    const auto length = static_cast<std::size_t>(pick(1, 20));
    switch (pick(0, 5)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(at, length));
        break;
      case 2:
        text[at] = static_cast<char>(pick(0, 255));
        break;
      case 3:
        text.resize(at);
        break;
      case 4:
        text.insert(
            at, text.substr(static_cast<std::size_t>(pick(0, static_cast<int>(text.size()) - 1)),
                            length));
        break;
      default:
        text.insert(at, pieces[static_cast<std::size_t>(pick(0, 34))]);
    }
  }

  std::mt19937 random_{12345};
};

TEST(TomlFuzz, MutatedScenesAreReadOrSceneErrors) {
  ASSERT_NO_THROW(app::scene::read_scene_text(seed_text, "seed"));
  Mutator mutate;
  int read = 0, refused = 0;
  for (int k = 0; k < 4000; ++k) {
    const std::string text = mutate(seed_text);
    try {
      const app::scene::Scene scene = app::scene::read_scene_text(text, "mutant");
      // A scene that was read can be written and read again.
      EXPECT_NO_THROW(app::scene::read_scene_text(app::scene::write_scene(scene), "again")) << text;
      ++read;
    } catch (const app::scene::toml::SceneError& error) {
      EXPECT_GE(error.line, 1) << text;
      EXPECT_GE(error.column, 1) << text;
      ++refused;
    }
  }
  EXPECT_GT(read, 50);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace neve::app
