/// Changed values in the user's own file: the value changes, all else stays.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "app/scene/edit_text.h"
#include "app/scene/flat.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace neve::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* edited_scene = R"(# A ball. « névé »

title  = "Ball"        # shown
frames = 10

[solver]               # how
cell_size = 0.05       # m
gravity   = [0,        # none
             -9.81,    # down
             0]

# The snow of
# the day.
[material.snow]
youngs_modulus = 1.4e5 # "stiff" # a bit

[[body]]
name  = "ball"
shape = { sphere = { center = [0, 0.5, 0], radius = 0.1 } } # round
[[body]]
shape.box.size = [1, 1, 1]
velocity = [0,0,0]
[[collider]]
  shape = { plane = {} }
  friction = 0.5
[camera]
fov = 30
)";

std::string edit(const std::vector<std::string>& sets, const std::string& text = edited_scene) {
  std::vector<app::scene::Override> overrides;
  for (const std::string& set : sets) overrides.push_back(app::scene::parse_override(set));
  return app::scene::edit_scene_text(text, overrides);
}

/// The text with one part replaced.
std::string with(const std::string& part, const std::string& other,
                 std::string text = edited_scene) {
  const auto at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), other);
}

TEST(EditText, NoChangesLeaveTheTextTheSame) {
  EXPECT_EQ(edit({}), edited_scene);
}

TEST(EditText, OnlyTheValueOfAKeyIsReplaced) {
  EXPECT_EQ(edit({"title=Snow"}), with("\"Ball\"", "\"Snow\""));
  EXPECT_EQ(edit({"title=Schnee « 1 »"}), with("\"Ball\"", "\"Schnee « 1 »\""));
  EXPECT_EQ(edit({"frames=48"}), with("frames = 10", "frames = 48"));
  EXPECT_EQ(edit({"solver.cell_size=2.50e-2"}), with("0.05 ", "2.50e-2 "));
  EXPECT_EQ(
      edit({"solver.gravity=[0, -1.62, 0]"}),
      with("[0,        # none\n             -9.81,    # down\n             0]", "[0, -1.62, 0]"));
  EXPECT_EQ(edit({"material.snow.youngs_modulus=2e5"}), with("1.4e5 #", "2e5 #"));
  EXPECT_EQ(edit({"body.ball.shape.sphere.radius=0.2"}), with("radius = 0.1", "radius = 0.2"));
  EXPECT_EQ(edit({"body.2.shape.box.size=[2, 1, 1]"}), with("[1, 1, 1]", "[2, 1, 1]"));
  EXPECT_EQ(edit({"body.2.velocity=[0, -5, 0]"}), with("[0,0,0]", "[0, -5, 0]"));
  EXPECT_EQ(edit({"collider.1.friction=0"}), with("friction = 0.5", "friction = 0"));
  EXPECT_EQ(edit({"body.ball.shape={ box = { size = [0.2, 0.2, 0.2] } }"}),
            with("{ sphere = { center = [0, 0.5, 0], radius = 0.1 } }",
                 "{ box = { size = [0.2, 0.2, 0.2] } }"));
}

TEST(EditText, NewKeysGoBelowTheLastOneOfTheirTable) {
  EXPECT_EQ(edit({"fps=30"}), with("frames = 10\n", "frames = 10\nfps    = 30\n"));
  EXPECT_EQ(edit({"solver.cfl=0.3"}),
            with("             0]\n", "             0]\ncfl       = 0.3\n"));
  EXPECT_EQ(edit({"material.snow.hardening=5"}),
            with("\"stiff\" # a bit\n", "\"stiff\" # a bit\nhardening = 5\n"));
  EXPECT_EQ(edit({"body.ball.velocity=[0, -5, 0]"}),
            with("# round\n", "# round\nvelocity = [0, -5, 0]\n"));
  EXPECT_EQ(edit({"collider.1.contact=sticky"}),
            with("  friction = 0.5\n", "  friction = 0.5\n  contact = \"sticky\"\n"));
  EXPECT_EQ(edit({"collider.1.shape.plane.point=[0, 1, 0]"}),
            with("plane = {}", "plane = { point = [0, 1, 0] }"));
  EXPECT_EQ(edit({"body.ball.shape.sphere.rotation=[0, 0, 9]"}),
            with("radius = 0.1 }", "radius = 0.1, rotation = [0, 0, 9] }"));
  EXPECT_EQ(edit({"body.2.shape.box.center=[0, 1, 0]"}),
            with("velocity = [0,0,0]\n", "velocity = [0,0,0]\nshape.box.center = [0, 1, 0]\n"));
  EXPECT_EQ(edit({"camera.eye=[1, 1, 1]", "camera.target=[0, 0, 0]"}),
            with("fov = 30\n", "fov = 30\neye = [1, 1, 1]\ntarget = [0, 0, 0]\n"));
}

TEST(EditText, NewTablesGetASectionAtTheEnd) {
  const std::string text = edited_scene;
  EXPECT_EQ(edit({"output.size=[640, 360]", "output.background=transparent"}),
            text + "\n[output]\nsize = [640, 360]\nbackground = \"transparent\"\n");
  EXPECT_EQ(edit({"view.smoke.smoke.density_scale=2"}),
            text +
                "\n[[view]]\nname = \"snow\"\n\n[[view]]\nname = \"smoke\"\n"
                "smoke = { density_scale = 2 }\n");
  const std::string bare = "[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }";
  EXPECT_EQ(edit({"material.snow.hardening=5"}, bare), bare + "\n\n[material.snow]\nhardening = 5");
  EXPECT_EQ(edit({"camera={ fov = 20 }"}, bare), bare + "\n\n[camera]\nfov = 20");
}

/// The snow that every scene has comes first, so its section does too.
TEST(EditText, MaterialsKeepTheirOrder) {
  const std::string text =
      "[[body]]\nmaterial = \"wet\"\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n\n# "
      "Rain.\n[material.wet]\ndensity = "
      "500\n";
  EXPECT_EQ(edit({"material.snow.hardening=5"}, text),
            with("# Rain.", "[material.snow]\nhardening = 5\n\n# Rain.", text));
}

TEST(EditText, TheFirstKeyOfADocumentIsAboveItsFirstHeader) {
  const std::string text =
      "# My scene.\n\n# A body.\n[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n";
  EXPECT_EQ(edit({"frames=3"}, text), with("# A body.", "frames = 3\n\n# A body.", text));
}

TEST(EditText, ValuesSetToNoneAreRemovedWithTheirLine) {
  EXPECT_EQ(edit({"camera=none"}), with("[camera]\nfov = 30\n", ""));
  const std::string text = with("fov = 30\n", "fov = 30\norbit = 90   # degrees\nup = [0, 1, 0]\n");
  EXPECT_EQ(edit({"camera.orbit=none"}, text), with("orbit = 90   # degrees\n", "", text));
  const std::string one_line =
      with("[camera]\nfov = 30\n", "[[view]]\nname = \"a\"\ncamera = { orbit = 90, fov = 20 }\n");
  EXPECT_EQ(edit({"view.a.camera.orbit=none"}, one_line), with("orbit = 90, ", "", one_line));
  EXPECT_EQ(edit({"view.a.camera=none"}, one_line),
            with("camera = { orbit = 90, fov = 20 }\n", "", one_line));
  EXPECT_EQ(edit({"camera.turntable=none"}), edited_scene);
}

TEST(EditText, SectionsAndDottedKeysGiveWayToAWholeTable) {
  EXPECT_EQ(edit({"camera={ fov = 20, orbit = 9 }"}),
            with("[camera]\nfov = 30\n", "\n[camera]\nfov = 20\norbit = 9\n"));
  EXPECT_EQ(edit({"body.2.shape={ sphere = { radius = 0.1 } }"}),
            with("shape.box.size = [1, 1, 1]\nvelocity = [0,0,0]\n",
                 "velocity = [0,0,0]\nshape = { sphere = { radius = 0.1 } }\n"));
}

TEST(EditText, EditingKeepsLineEndsAndTheLackOfALastOne) {
  std::string text;
  for (const char c : std::string(edited_scene))
    text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const std::string edited = edit({"fps=30", "light.ambient=2", "frames=7"}, text);
  EXPECT_EQ(edited.find("\n"), edited.find("\r\n") + 1);
  for (std::size_t at = 0; (at = edited.find('\n', at)) != std::string::npos; ++at)
    EXPECT_EQ(edited[at - 1], '\r');
  EXPECT_NE(edited.find("frames = 7\r\nfps    = 30\r\n"), std::string::npos);
  EXPECT_TRUE(edited.ends_with("fov = 30\r\n\r\n[light]\r\nambient = 2\r\n"));
  const std::string cut(edited_scene, std::string(edited_scene).size() - 1);
  EXPECT_EQ(edit({"camera.fov=20"}, cut), with("fov = 30", "fov = 20", cut));
  EXPECT_EQ(edit({"camera.orbit=20"}, cut), cut + "\norbit = 20");
  EXPECT_EQ(
      edit({"fps=30"}, "\xEF\xBB\xBF# b\n[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n"),
      "\xEF\xBB\xBF"
      "fps = 30\n\n# b\n[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n");
}

TEST(EditText, StringsAndCommentsThatLookLikeTomlAreLeftAlone) {
  const std::string text =
      "title = '''\n[solver]\ncfl = 1 # no\n'''\n# [camera]\n# fov = 3\n[[body]] # [camera]\n"
      "shape = { box = { size = [0.2, 0.2, 0.2] } } # } ]\nname = \"a#b\\\"]\" \n";
  // A name must be a word: such a file is refused, not damaged.
  EXPECT_THROW(edit({"frames=3"}, text), app::scene::toml::SceneError);
  const std::string good = with("name = \"a#b\\\"]\" \n", "material = \"snow\"\n", text);
  EXPECT_EQ(edit({"solver.cfl=0.2", "camera.fov=20"}, good),
            good + "\n[solver]\ncfl = 0.2\n\n[camera]\nfov = 20\n");
}

TEST(EditText, AKeyOfTheSameNameElsewhereIsNotTakenForIt) {
  const std::string text =
      "body = [{ shape = { box = { size = [0.2, 0.2, 0.2] } }, velocity = [1, 0, 0] }, { name = "
      "\"b\", shape = { sphere = "
      "{ radius = 0.1 } } }]\n";
  EXPECT_EQ(edit({"body.b.velocity=[2, 0, 0]"}, text),
            with("{ sphere = { radius = 0.1 } } }]",
                 "{ sphere = { radius = 0.1 } }, velocity = [2, 0, 0] }]", text));
  EXPECT_EQ(edit({"body.1.velocity=[2, 0, 0]"}, text), with("[1, 0, 0]", "[2, 0, 0]", text));
}

TEST(EditText, BadChangesAndFilesAreRefused) {
  EXPECT_THROW(edit({"solver.nonsense=1"}), app::UsageError);
  EXPECT_THROW(edit({"solver.cfl=-1"}), app::UsageError);
  EXPECT_THROW(edit({"frames=1"}, "[[body]"), app::scene::toml::SceneError);
  EXPECT_THROW(edit({"frames=1"}, "frames = 1"), app::scene::toml::SceneError);
  // Views as one array cannot be added to line by line.
  EXPECT_THROW(edit({"view.smoke.smoke.density_scale=2"},
                    "view = [{}]\n[[body]]\nshape = { box = { size = [0.2, 0.2, 0.2] } }\n"),
               app::UsageError);
}

/// Another value that is valid; nothing for what cannot be told.
std::string other_value(const app::scene::FlatParam& param) {
  if (param.type == "choice")
    return app::scene::toml::toml_string(
        param.choices[param.text() == app::scene::toml::toml_string(param.choices[0]) ? 1 : 0]);
  if (param.type == "integer" || param.type == "number") {
    const double x = param.value ? std::stod(param.text()) : 1;
    for (const double other : {x + 1, x - 1, 0.5 * x + 0.1, x / 2})
      if (param.valid.contains(other) && param.type == "number")
        return app::scene::toml::number_text(other);
      else if (param.valid.contains(std::floor(other)))
        return app::scene::toml::number_text(std::floor(other));
  }
  if (param.type == "vector") return "[0.25, -0.5, 1]";
  if (param.type == "range") return "[0.5, 7]";
  if (param.type == "size") return "[128, 64]";
  return {};
}

/// Every parameter of every scene that comes with the program, one at a time and then all at once:
/// the text reads as the scene with that value (edit_scene_text compares), and all the rest of it
/// stays, line by line.
TEST(EditText, EveryParameterOfEverySceneCanBeSaved) {
  int edits = 0;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(NEVE_SOURCE_DIR) / "scenes"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  ASSERT_GE(files.size(), 7u);
  for (const fs::path& file : files) {
    const std::string text = test::read_text(file), folder = file.parent_path().string();
    const app::scene::Scene scene = app::scene::read_scene_text(text, file.string(), folder);
    std::vector<app::scene::Override> all;
    for (const app::scene::FlatParam& param : app::scene::flatten(scene)) {
      const std::string value = other_value(param);
      if (value.empty()) continue;
      const app::scene::Override change{param.address, value};
      try {
        app::scene::read_scene_text(text, file.string(), folder, {change});
      } catch (const std::exception&) {
        continue;  // does not go together with the rest, as an eye without a target
      }
      std::string edited;
      EXPECT_NO_THROW(edited = app::scene::edit_scene_text(text, {change}, file.string(), folder))
          << file << " " << param.address << " = " << value;
      // Nothing is lost: without the part that differs, the old text is a part of the new one.
      std::size_t begin = 0, end = 0;
      while (begin < text.size() && begin < edited.size() && text[begin] == edited[begin]) ++begin;
      while (end < text.size() - begin && end + begin < edited.size() &&
             text[text.size() - 1 - end] == edited[edited.size() - 1 - end])
        ++end;
      const std::string gone = text.substr(begin, text.size() - begin - end);
      EXPECT_EQ(gone.find('#'), std::string::npos) << param.address << ": " << gone;
      EXPECT_EQ(gone.find('='), std::string::npos) << param.address << ": " << gone;
      EXPECT_EQ(gone.find('\n'), std::string::npos) << param.address << ": " << gone;
      ++edits;
      all.push_back(change);
    }
    try {
      app::scene::read_scene_text(text, file.string(), folder, all);
    } catch (const std::exception&) {
      continue;
    }
    EXPECT_NO_THROW(app::scene::edit_scene_text(text, all, file.string(), folder)) << file;
  }
  EXPECT_GT(edits, 500);
}

TEST(EditText, ForAnotherFolderATextFindsItsFiles) {
  const test::TemporaryFolder folder;
  folder.write("grains.csv", "x,y,z,volume\n0,0.1,0,1e-6\n0,0.2,0,1e-6\n");
  const std::string text =
      "# mine\nframes = 3\n[solver]\ncell_size = 0.1\n[[body]]\nname = \"grains\"\n"
      "shape = { points = { file = \"grains.csv\" } }\n";
  const std::string file = folder.write("scene.toml", text).string();
  const auto changed = [&](const fs::path& out) {
    const std::string made = app::scene::changed_scene_text(
        text, app::scene::parse_overrides({"frames=7"}), file, out.string());
    const app::scene::Scene scene =
        app::scene::read_scene_text(made, out.string(), out.parent_path().string());
    EXPECT_EQ(scene.frames, 7);
    return made;
  };
  EXPECT_TRUE(changed(folder / "other.toml").starts_with("# mine"));
  const std::string there = changed(folder / "shots" / "scene.toml");
  EXPECT_TRUE(there.starts_with("# mine")) << there;
  EXPECT_NE(there.find((folder / "grains.csv").string()), std::string::npos) << there;
}

/// Any bytes lead to an error or to a text that reads back, never to a crash.
TEST(EditText, HostileFilesAreRefusedOrEditedRightly) {
  int refused = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(NEVE_SOURCE_DIR) / "tests/corpus/toml")) {
    const std::string text = test::read_text(entry.path());
    try {
      edit({"frames=3", "solver.cfl=0.2", "camera.fov=20", "view.smoke.smoke.density_scale=3"},
           text);
    } catch (const app::scene::toml::SceneError&) {
      ++refused;
    } catch (const app::UsageError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 30);
}

}  // namespace
}  // namespace neve::app
