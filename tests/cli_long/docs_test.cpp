/// Every command of the README and of docs/ runs: with fewer frames and pixels, where that is all
/// that is saved.

#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include "app/output/atomic_file.h"
#include "render/image/image.h"
#include "tests/cli/run_neve.h"

namespace neve::test {
namespace {

namespace fs = std::filesystem;

struct Command {
  std::string place, text;
};

/// "./neve render a.toml \" and the lines after it, without comments.
std::vector<Command> commands_of(const fs::path& page) {
  std::vector<Command> found;
  std::istringstream lines(read_text(page));
  bool is_code = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```")) is_code = !is_code;
    const bool is_ours = line.starts_with("./neve ") || line.starts_with("neve ");
    if (!is_code || !is_ours) continue;
    while (line.ends_with('\\')) {
      std::string more;
      std::getline(lines, more);
      ++number;
      line.pop_back();
      line += more;
    }
    line = line.substr(line.find("neve ") + 5);
    if (const std::size_t comment = line.find(" #"); comment != std::string::npos)
      line.resize(comment);
    found.push_back({page.filename().string() + ":" + std::to_string(number), line});
  }
  return found;
}

std::vector<Command> commands_of_pages() {
  std::vector<Command> all = commands_of(fs::path(NEVE_SOURCE_DIR) / "README.md");
  for (const char* folder : {"docs", "docs/reports"})
    for (const auto& entry : fs::directory_iterator(fs::path(NEVE_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".md")
        for (Command& command : commands_of(entry.path())) all.push_back(std::move(command));
  return all;
}

/// The command with what makes it short; empty for one that cannot be run here.
std::string shortened(std::string command) {
  const std::string name = command.substr(0, command.find(' '));
  if (name == "test" || name == "export") return "";
  if (name == "new") return "new made_here";
  if (name == "compare") return command;
  if (command.find(" --from ") != std::string::npos)
    return std::regex_replace(command, std::regex("--from [^ ]+"), "--from 0.03s") +
           (name == "sweep" ? " --dry-run" : " --size 64x36 --no-movie");
  // Nine tiny runs, and one click; each search has its folder.
  if (name == "pick")
    return std::regex_replace(command, std::regex("scenes/[^ ]+|--(coarsen|frames) [^ ]+"), "") +
           " --clicks clicks.txt scene.toml --out picked_" +
           std::to_string(std::hash<std::string>()(command));
  if (command.find(" --plate ") != std::string::npos)
    command = std::regex_replace(command, std::regex("--size [^ ]+"), "");
  // The run of a page is that of another scene here.
  command = std::regex_replace(
      command, std::regex("^([a-z]+) out/(snowball|castle_hit|mesh_body|my_scene|preview)(?= |$)"),
      "$1 out/a");
  // A page of another host cannot be replayed.
  if (command.find("--public-url") != std::string::npos) return "";
  // A test of Slurm submits what the page of farms does.
  if (command.find("--engine slurm") != std::string::npos) return "";
  command =
      std::regex_replace(command, std::regex("sweep collect [^ ]+"), "sweep collect elsewhere");
  const bool is_tiny = command.find(" scene.toml") != std::string::npos;
  // It ends after a sixth of a second, those of the pages later.
  if (is_tiny || command.find(" out/") != std::string::npos)
    command = std::regex_replace(command, std::regex("--at [^ ]+"), "--at 0.1s");
  // Each render has a folder of its own: existing files are not replaced.
  const std::string own = "--out drawn_" + std::to_string(std::hash<std::string>()(command));
  command = std::regex_replace(command, std::regex("--out [^ ]+"),
                               name == "dump"     ? "--out dumped"
                               : name == "card"   ? "--out elsewhere.png"
                               : name == "render" ? own
                                                  : "--out elsewhere");
  const auto add = [&](const std::string& flag, const std::string& value = "") {
    if (command.find(flag) == std::string::npos)
      command += " " + flag + (value.empty() ? "" : " " + value);
  };
  if (name == "bench") add("--help");
  const bool is_collected = command.starts_with("sweep collect");
  if (name == "sweep" && !is_tiny && !is_collected) add("--dry-run");
  if (name == "view") add("--replay", "wait.json");
  const bool is_run =
      name == "view" || name == "dump" || name == "check" || name == "sweep" || name == "strip";
  const bool has_cells = std::regex_search(command, std::regex("^[a-z]+ out/[a-z]+( |$)"));
  const bool has_own_cells = command.find("--live") != std::string::npos;
  if (is_run && !is_tiny && !is_collected && !has_cells && !has_own_cells) add("--coarsen", "3");
  if (name != "render") return command;
  const bool is_picture = std::regex_search(command, std::regex("^render [^ ]+\\.(png|exr)"));
  if (!is_picture) add("--frames", "0");
  if (!is_tiny && !has_cells) add("--coarsen", "3");
  const bool is_resumed = has_cells && command.find(" --resume") != std::string::npos;
  if (!is_picture && !is_resumed && command.find("--out ") == std::string::npos)
    command += " " + own;
  add("--size", "64x36");
  if (command.find("--movie ") == std::string::npos) add("--no-movie");
  return command;
}

/// The scene of the tutorial: its first block of TOML.
std::string scene_of_tutorial() {
  const std::string page = read_text(fs::path(NEVE_SOURCE_DIR) / "docs/tutorial.md");
  const std::size_t start = page.find("```toml\n") + 8;
  return page.substr(start, page.find("```", start) - start);
}

class CommandsOfDocs : public Cli {
 protected:
  CommandsOfDocs() {
    for (const char* name : {"scenes", "docs"})
      fs::create_directory_symlink(fs::path(NEVE_SOURCE_DIR) / name, folder / name);
    folder.write("my_scene.toml", scene_of_tutorial());
    folder.write("wait.json", "[{\"wait\": 1}]");
    folder.write("clicks.txt", "1\n");
  }

  /// Runs that commands start from.
  void make_runs() {
    for (const char* out : {"out/a", "out/b", "out/hard", "out/soft", "out/wedge"})
      EXPECT_EQ(neve({"render", "scene.toml", "--out", out, "--quiet", "--no-movie", "--passes",
                      "all", "--size", "64x36"})
                    .exit_code,
                0);
    fs::create_directory(folder / "street");
    for (const char* plate : {"street.png", "street/0000.png"})
      fs::copy_file(folder / "out/a/particles/0000.png", folder / plate);
  }

  /// The picture that a command starts from; runs before it may have removed it.
  void make_picture(const std::string& command) {
    std::smatch found;
    if (!std::regex_search(command, found, std::regex("out/[^ ]+\\.(png|exr)"))) return;
    const fs::path file = folder / found.str();
    fs::create_directories(file.parent_path());
    fs::copy_file(folder / ("out/a/particles/0000." + found[1].str()), file,
                  fs::copy_options::overwrite_existing);
  }
};

TEST_F(CommandsOfDocs, EveryCommandOfTheDocumentationRuns) {
  const std::vector<Command> commands = commands_of_pages();
  EXPECT_GT(commands.size(), 40u) << "the pages are not read as they are written";
  make_runs();
  for (const Command& command : commands) {
    const std::string text = shortened(command.text);
    if (text.empty()) continue;
    make_picture(text);
    fs::remove(folder / "made_here.toml");
    const auto result = app::output::run_process(
        "/bin/sh", {"-c", "exec '" NEVE_BINARY "' " + text}, folder.path());
    EXPECT_EQ(result.exit_code, 0) << command.place << ": neve " << text << "\n" << result.errors;
  }
}

/// Share of the width between the outermost columns that show snow, which is the only white there.
double white_share(const render::Image& image) {
  int left = image.width, right = -1;
  for (int x = 0; x < image.width; ++x) {
    int white = 0;
    for (int y = 0; y < image.height; ++y)
      white += image.pixels[(std::size_t(y) * image.width + x) * image.channels] > 170;
    if (white < image.height / 50) continue;  // single crumbs are no more than dots
    left = std::min(left, x);
    right = std::max(right, x);
  }
  return double(right - left + 1) / image.width;
}

/// A wall that stands, in the preview or in the film, would be a bad first afternoon.
TEST_F(CommandsOfDocs, TheSceneOfTheTutorialBreaksInThePreviewAndInTheFilm) {
  for (const bool is_preview : {true, false}) {
    std::vector<std::string> words{
        "render",       "my_scene.toml", "--no-movie",
        "--no-caption", "--size",        "320x180",
        "--quiet",      "--out",         is_preview ? "preview" : "film"};
    if (is_preview) words.insert(words.end(), {"--coarsen", "2"});
    const auto result = neve(words);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "") << "nobody begins with a warning";
    const fs::path out = folder / words[8];
    const app::Json last = json_of((out / "run.json").string())["frames"].back();
    // The wall has 0.5 m; in the end the preview has 0.24 m and 14 pieces, the film 0.21 m and 274.
    EXPECT_LT(last["height"].get<double>(), 0.35);
    EXPECT_GT(last["fragments"].get<int>(), is_preview ? 5 : 100);
    EXPECT_GT(white_share(render::decode_png(app::output::read_file(out / "snow/0036.png"))), 0.4);
  }
}

}  // namespace
}  // namespace neve::test
