/// Files of strangers: read as they are or refused, whatever they hold.

#include <sys/stat.h>

#include <chrono>
#include <cstring>

#include "app/output/checkpoint.h"
#include "sim/state/progress.h"
#include "tests/support/resume.h"

namespace neve::test {
namespace {

class Strangers : public Cli {
 protected:
  app::output::ProcessResult shell(const std::string& line) {
    return app::output::run_process("/bin/bash", {"-c", line, NEVE_BINARY}, folder.path());
  }
};

TEST_F(Strangers, PipesAndDevicesAsInputsEndAtOnce) {
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(neve({"info", "pipe"}).exit_code, 6);
  EXPECT_EQ(neve({"info", "/dev/zero"}).exit_code, 6);
  const auto scene = neve({"render", "pipe"});
  EXPECT_EQ(scene.exit_code, 3);
  EXPECT_TRUE(contains(scene.errors, "is a pipe")) << scene.errors;
  EXPECT_EQ(neve({"render", "/dev/zero"}).exit_code, 3);
  EXPECT_EQ(neve({"compare", "pipe", "pipe"}).exit_code, 6);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(Strangers, ASceneFromACommandIsReadWhole) {
  std::string text = "frames = 3\n" + std::string(tiny_scene).substr(std::string("\n").size());
  text.replace(text.find("frames = 4"), 10, "");
  std::string comments;
  while (comments.size() < 20'000) comments += "# a comment of some length, to fill the pipe\n";
  folder.write("long.toml", comments + text);
  const auto result = shell("\"$0\" render <(cat long.toml) --dry-run");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(contains(result.output, "frames     0 to 3")) << result.output;
}

TEST_F(Strangers, EscapesInTextsAreWrittenOut) {
  std::string text = tiny_scene;
  text.replace(text.find("Tiny"), 4, "\\u001b]0;owned\\u0007\\u009b31m");
  folder.write("scene.toml", text);
  ASSERT_EQ(neve({"render", "scene.toml", "--out", "out", "--frames", "0"}).exit_code, 0);
  const auto is_clean = [](const std::string& output) {
    return output.find_first_of("\x1b\x07") == std::string::npos && !contains(output, "\xc2\x9b");
  };
  const std::string forged = "{\"status\": \"ok\", \"version\": \"\\u001b]0;owned\\u0007\"}";
  folder.write("forged/run.json", forged);
  const auto info = neve({"info", "forged"});
  EXPECT_TRUE(is_clean(info.output)) << info.output;
  EXPECT_TRUE(contains(info.output, "\\x1b]0;owned\\x07")) << info.output;
  EXPECT_TRUE(is_clean(neve({"info", "out/particles/0000.png"}).output));
  const auto missing = neve({"info", "\x1b]0;owned\x07.png"});
  EXPECT_TRUE(is_clean(missing.errors)) << missing.errors;
}

TEST_F(Strangers, ClosedStandardStreamsAreNoFiles) {
  EXPECT_EQ(shell("\"$0\" params --json >&-").exit_code, 6);
  EXPECT_EQ(
      shell("\"$0\" render scene.toml --frames 0-1 --quiet --no-movie <&- >&- 2>&-").exit_code, 0);
  EXPECT_EQ(neve({"verify", "out/scene"}).exit_code, 0);
}

/// The suggestion comes first: nothing listens yet that one could be warned of.
TEST_F(Strangers, APortIsNoAddressAndNothingElseIsSaid) {
  folder.write("clicks.txt", "1\n");
  for (const char* command :
       {"\"$0\" view scene.toml --listen 8000",
        "\"$0\" pick scene.toml -p material.snow.hardening=5,7 --listen 8000"}) {
    const auto result = shell(command);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_TRUE(contains(result.errors, "did you mean --listen 127.0.0.1:8000?")) << result.errors;
    EXPECT_FALSE(contains(result.errors, "warning")) << result.errors;
  }
}

/// Its author wrote them: so long a script is played, but not without a word.
TEST_F(Strangers, ALongScriptSaysHowLongItTakes) {
  std::string steps = "[";
  for (int k = 0; k < 40'000; ++k) steps += "{\"move\": [5, 5]},\n";
  folder.write("long.json", steps + "{\"quit\": true}]");
  folder.write("waits.json", "[{\"wait\": 1000000}, {\"quit\": true}]");
  folder.write("short.json", "[{\"wait\": 3}, {\"quit\": true}]");
  const auto view = [&](const std::string& script) {
    return shell("\"$0\" view scene.toml --size 320x200 --frames 5 --replay " + script).errors;
  };
  EXPECT_TRUE(contains(view("long.json"), "40001 steps take 28 s or more; Ctrl-C ends them"));
  EXPECT_TRUE(contains(view("waits.json"), "2 steps take 4 h 37 min or more"));
  EXPECT_FALSE(contains(view("short.json"), "steps take"));
}

/// Resumes from forged checkpoints, whose checksums are right.
class ForgedCheckpoint : public Strangers {
 protected:
  void SetUp() override {
    Strangers::SetUp();
    ASSERT_EQ(render({"--frames", "0-2"}).exit_code, 0);
    good = *app::output::find_checkpoint(folder / "out").checkpoint;
  }
  app::output::ProcessResult render(const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", "scene.toml", "--out", "out", "--no-movie"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }
  template <class Change>
  void expect_refused(const Change& change, const std::string& word) {
    app::output::Checkpoint forged = good;
    change(forged);
    app::output::remove_checkpoints(folder / "out");
    app::output::write_checkpoint(folder / "out", forged);
    const auto result = render({"--resume"});
    EXPECT_EQ(result.exit_code, 6) << word << ": " << result.errors;
    EXPECT_TRUE(contains(result.errors, word)) << word << ": " << result.errors;
    EXPECT_TRUE(contains(result.errors, "out/checkpoint/")) << result.errors;
  }
  template <class T>
  void expect_state_refused(std::size_t place, T value, const std::string& word) {
    expect_refused([&](auto& c) { std::memcpy(c.state.data() + place, &value, sizeof value); },
                   word);
  }

  app::output::Checkpoint good;
};

TEST_F(ForgedCheckpoint, NumbersThatNoRunHasWrittenAreRefusedByName) {
  using app::Json;
  expect_refused([](auto& c) { c.frame = 3; }, "history has 3 rows");
  expect_refused([](auto& c) { c.frame = 2'147'483; }, "history has 3 rows");
  expect_refused([](auto& c) { c.steps = ~std::size_t{0}; }, "holds another moment");
  const auto replace = [&](const char* place, const Json& value) {
    return [=](auto& c) { c.progress[Json::json_pointer(place)] = value; };
  };
  expect_refused(replace("/history/0/5", 77), "history limit = 77");
  expect_refused(replace("/history/1/4", -1), "history steps = -1");
  expect_refused(replace("/history/1/1", nullptr), "history kinetic_energy");
  expect_refused(replace("/advance/steps", -5), "advance steps = -5");
  expect_refused(replace("/advance/ruled/0", 1e300), "advance ruled");
  expect_refused(replace("/frames/1/frame", -5), "frames frame = -5");
  expect_refused(replace("/frames/1/frame", 0), "frames in order");
  expect_refused(replace("/frames/2/steps", 1e18), "frames steps");
  expect_refused(replace("/frames", "none"), "cannot resume");
  expect_refused(replace("/exports", Json::array({1})), "cannot resume");
  const std::size_t progress = 64, records = progress + sizeof(sim::engine::Progress);
  expect_state_refused(progress, -1e308, "time = -1e+308");
  expect_state_refused(progress, 1e9, "another moment");
  expect_state_refused(progress + 16, ~std::uint64_t{0}, "steps = ");
  expect_state_refused(progress + 24, ~std::uint64_t{0}, "next_id = ");
  expect_state_refused(records + 4 * 27, 64 << 16, "model = 64");
  expect_state_refused(records + 4 * 27, 255 << 16, "model = 255");
  app::output::remove_checkpoints(folder / "out");
  app::output::write_checkpoint(folder / "out", good);
  EXPECT_EQ(render({"--resume"}).exit_code, 0);
}

/// The frame of a file's name and JSON, which read() refuses as it refuses a wrong checksum.
TEST_F(ForgedCheckpoint, ImpossibleFramesAreDamage) {
  for (const int frame : {-5, 2'147'483'647}) {
    app::output::Checkpoint forged = good;
    forged.frame = frame;
    app::output::remove_checkpoints(folder / "out");
    app::output::write_checkpoint(folder / "out", forged);
    const auto result = render({"--resume", "--frames", "0-1"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(contains(result.errors, "invalid frame number")) << result.errors;
  }
}

TEST_F(Strangers, ManifestsWithImpossibleNumbersAreRefused) {
  ASSERT_EQ(neve({"sweep", "scene.toml", "-p", "seed=1,2", "--frames", "0-1", "--out", "s",
                  "--emit", "commands"})
                .exit_code,
            0);
  const app::Json good = json_of("s/manifest.json");
  const auto code = [&](const char* place, const app::Json& value) {
    app::Json forged = good;
    forged[app::Json::json_pointer(place)] = value;
    folder.write("s/manifest.json", app::to_text(forged));
    const int collected = neve({"sweep", "collect", "s"}).exit_code;
    return collected == neve({"verify", "s"}).exit_code ? collected : -1;
  };
  for (const char* place : {"/tile/0", "/tile/1", "/fps", "/runs/1/run", "/runs/0/last_frame",
                            "/runs/1/coordinates/0", "/columns"})
    for (const app::Json& value : {app::Json(-7), app::Json(2'000'000'000), app::Json("x")})
      EXPECT_EQ(code(place, value), 3) << place << " " << value;
  for (const char* place : {"/timeout", "/memory", "/runs/0/memory_bytes", "/runs/1/work"})
    for (const app::Json& value : {app::Json(-7), app::Json(1e300), app::Json("x")})
      EXPECT_EQ(code(place, value), 3) << place << " " << value;
  for (const char* view : {"../../x", "/etc", "", "a/b"}) EXPECT_EQ(code("/view", view), 3) << view;
  EXPECT_EQ(code("/runs", app::Json::array()), 3);
  EXPECT_EQ(code("/title", "the same"), 9) << "not as neve sweep wrote it";
}

TEST_F(Strangers, AxesWithTooManyValuesAreRefusedBeforeTheyAreMade) {
  std::string text = "[sweep]\nscene = \"scene.toml\"\n[axis]\n";
  for (int k = 0; k < 400; ++k)
    text += "\"view.v" + std::to_string(k) + ".size\" = { linspace = [1, 2], num = 99999 }\n";
  folder.write("wide.toml", text);
  const auto result = shell("ulimit -v 4000000; \"$0\" sweep wide.toml --dry-run");
  EXPECT_EQ(result.exit_code, 8) << result.errors;
  EXPECT_TRUE(contains(result.errors, "at most 100000 are allowed")) << result.errors;
}

TEST_F(Strangers, NoSceneRaisesTheCapsOfWhoeverStartsTheProgram) {
  folder.write("greedy.toml",
               std::string("limits.memory = \"1TiB\"\n") + "limits.particles = 1e9\n" + tiny_scene);
  for (const char* command : {"render", "check", "dump", "export"}) {
    std::vector<std::string> words{command, "greedy.toml"};
    if (words[0] == "dump") words.insert(words.end(), {"--at", "0.01s"});
    if (words[0] == "export") words.insert(words.end(), {"--format", "csv"});
    if (words[0] == "render") words.emplace_back("--dry-run");
    EXPECT_EQ(neve(words).exit_code, 0) << command;
    const auto capped = [&](const char* flag, const char* value) {
      std::vector<std::string> more = words;
      more.insert(more.end(), {flag, value});
      return neve(more);
    };
    for (const auto& [flag, value] :
         {std::pair{"--max-particles", "100"}, {"--max-memory", "1MB"}}) {
      const auto result = capped(flag, value);
      EXPECT_EQ(result.exit_code, 8) << command << " " << flag;
      EXPECT_TRUE(contains(result.errors, flag)) << result.errors;
      EXPECT_TRUE(contains(result.errors, "a scene cannot raise it")) << result.errors;
      EXPECT_EQ(capped(flag, "8e9").exit_code, 0) << command << " " << flag;
      EXPECT_EQ(capped(flag, "many").exit_code, 2) << command << " " << flag;
    }
  }
  EXPECT_EQ(shell("NEVE_MAX_PARTICLES=100 \"$0\" render greedy.toml").exit_code, 8);
  EXPECT_EQ(shell("NEVE_MAX_MEMORY=1MB \"$0\" render greedy.toml --max-memory 8GiB").exit_code, 8)
      << "a flag only lowers the cap";
  EXPECT_EQ(shell("NEVE_MAX_MEMORY=some \"$0\" render greedy.toml").exit_code, 2);
  const auto emitted = shell(
      "NEVE_MAX_MEMORY=2GiB \"$0\" sweep greedy.toml -p seed=1,2 --frames 0-1 --out e "
      "--max-particles 100 --emit commands --quiet");
  EXPECT_EQ(emitted.exit_code, 0) << emitted.errors;
  EXPECT_TRUE(contains(read_text(folder.path() / "commands"),
                       "--max-memory 2GiB --max-particles 100 --threads 1 --quiet\n"))
      << "commands that run elsewhere keep the caps";
  const auto sweep =
      shell("\"$0\" sweep greedy.toml -p seed=1,2 --frames 0-1 --out s --max-particles 100 --json");
  EXPECT_EQ(sweep.exit_code, 7) << sweep.errors;
  EXPECT_EQ(json_of("s/runs/0000/status.json")["state"], "refused");
}

TEST_F(Strangers, TheMemoryOfManyViewsIsForeseen) {
  const auto memory_with = [&](int views) {
    std::string text = tiny_scene;
    for (int k = 0; k < views; ++k)
      text += "[[view]]\nname = \"v" + std::to_string(k) + "\"\nlayers = [\"particles\"]\n" +
              "size = [1280, 720]\n";
    folder.write("views.toml", text);
    const auto plan = neve({"render", "views.toml", "--dry-run", "--json"});
    return app::parse_json(std::string_view(plan.output))["memory_bytes"].get<double>();
  };
  EXPECT_GE(memory_with(201) - memory_with(1), 200 * 1280 * 720 * 3.0);
  EXPECT_LE(memory_with(201) - memory_with(1), 200 * 1280 * 720 * 4.5);
}

}  // namespace
}  // namespace neve::test
