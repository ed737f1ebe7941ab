/// Edits of anybody who has the token: whatever they are, the program continues, and no file but
/// those of the scene is read or written.

#include <random>
#include <set>

#include "app/scene/flat.h"
#include "tests/support/whole_counts.h"
#include "tests/view/view_support.h"

namespace neve::test {
namespace {

using app::view::session::Workbench;

class RandomEdits : public testing::Test {
 protected:
  RandomEdits() {
    folder.write("secret.csv", "password\nhunter2\n");
    folder.write("scene/points.csv", "x,y,z,volume\n0,0.1,0,1e-6\n0,0.2,0,1e-6\n");
    app::view::session::WorkbenchOptions options;
    options.folder = folder / "scene/out";
    options.is_remote = true;
    const std::string text =
        "limits.particles = 3000\nlimits.memory = \"300MB\"\n" + std::string(tiny_scene) +
        "[[body]]\nname = \"cloud\"\nshape = { points = { file = \"points.csv\" } }\n"
        "[[emitter]]\nname = \"spout\"\nvelocity = [0, -1, 0]\n"
        "shape = { sphere = { center = [0, 0.6, 0], radius = 0.05 } }\n"
        "[[view]]\nname = \"slice\"\n[[view]]\nname = \"smoke\"\n";
    bench = std::make_unique<Workbench>(
        app::view::session::open_document(folder.write("scene/scene.toml", text), {}, 1).document,
        options, std::function<void()>{});
  }

  std::size_t below(std::size_t end) { return random() % end; }

  /// Numbers, words and tables that readers like least, and numbers near the present one.
  std::string value_for(const app::scene::FlatParam& param) {
    static const char* const odd[] = {"0",
                                      "-1",
                                      "1e-300",
                                      "1e308",
                                      "nan",
                                      "inf",
                                      "-inf",
                                      "none",
                                      "2147483648",
                                      "1e17",
                                      "true",
                                      "\"\"",
                                      "[]",
                                      "{}",
                                      "[0, 0, 0]",
                                      "[1, 2, 3]",
                                      "[1e308, -1e308, 1e308]",
                                      "[16384, 16384]",
                                      "[[[[[[[[",
                                      "{ box = { center = [0, 0, 0] } }",
                                      "{ sphere = { center = [0, 1, 0], radius = 0.1 } }",
                                      "'''",
                                      "[\"particles\", \"smoke\"]",
                                      "\"\\u001b]0;x\\u0007\""};
    const std::string secret = "\"" + (folder / "secret.csv").string() + "\"";
    switch (below(8)) {
      case 0:
        return odd[below(std::size(odd))];
      case 1:
        return secret;
      case 2:
        return "{ points = { \"f\\u0069le\" = " + secret + " } }";
      case 3:
        return param.choices.empty() ? odd[below(std::size(odd))]
                                     : param.choices[below(param.choices.size())];
      case 4:
        return std::to_string(std::ldexp(1.0, int(below(60)) - 40));
      default: {
        const double factor = std::exp(std::uniform_real_distribution<>(-2, 2)(random));
        double number = 1;
        if (param.value)
          if (const double* x = std::get_if<double>(&param.value->data)) number = *x;
        return std::to_string(number * factor);
      }
    }
  }

  void act() {
    app::view::session::Session& session = bench->session();
    switch (below(24)) {
      case 0:
        return bench->undo();
      case 1:
        return bench->redo();
      case 2:
        return bench->reset();
      case 3:
        return session.next_frame();
      case 4:
        return session.next_step();
      case 5:
        return session.next_stage();
      case 6:
        return session.run();
      case 7:
        return session.pause();
      case 8:
        return bench->continue_from_here();
      case 9:
        static_cast<void>(bench->save_scene(folder / "scene/out/saved.toml"));
        return;
      case 10:
        static_cast<void>(bench->save_scene(folder / "stolen.toml"));
        return;
      default: {
        const auto list = app::scene::flatten(*bench->document().scene());
        const app::scene::FlatParam& param = list[below(list.size())];
        if (below(20) == 0) return bench->forget(param.address);
        if (below(40) == 0) static_cast<void>(bench->sweep_around(param.address));
        bench->set(param.address, value_for(param), below(5));
      }
    }
  }

  /// Asks for what the viewer asks for in every picture, and for one that is kept.
  void look() {
    const auto live = bench->session().latest();
    bench->session().taken(live->number);
    const app::scene::Scene shown = bench->display_scene(*live);
    try {
      if (!shown.views.empty()) bench->picture_record(*live, shown.views.front());
    } catch (const std::exception& error) {  // the viewer says so, too
      bench->say(app::view::session::Message::Kind::error, error.what());
    }
    for (const auto& message : bench->messages())
      ASSERT_FALSE(contains(message.text, "hunter2")) << message.text;
  }

  std::set<std::string> files() {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
      if (entry.is_regular_file() && !contains(entry.path().string(), "/scene/out/"))
        found.insert(entry.path().lexically_relative(folder.path()).string());
    return found;
  }

  TemporaryFolder folder;
  std::mt19937 random{11};
  std::unique_ptr<Workbench> bench;
};

TEST_F(RandomEdits, NoEditEndsTheProgramOrReachesAnotherFile) {
  const std::set<std::string> before = files();
  const int count = count_or_whole(600, 10'000);
  for (int k = 0; k < count && !HasFatalFailure(); ++k) {
    act();
    look();
  }
  EXPECT_EQ(files(), before);
  EXPECT_GT(bench->errors_said(), static_cast<std::uint64_t>(count) / 20);
  // The workbench is as good as before.
  while (bench->document().can_undo()) bench->undo();
  bench->reset();
  wait_for(bench->session(),
           [](const auto& live) { return live.frame == 0 && live.error.empty(); });
  bench->session().next_frame();
  rest_at(bench->session(), 1);
}

}  // namespace
}  // namespace neve::test
