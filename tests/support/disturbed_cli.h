#pragma once
/// Commands that are disturbed at one place, then repeated: the first time they tell the truth, the
/// second time they end as if nothing had been.

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/support/faulty_cli.h"
#include "tests/support/folder_contents.h"
#include "tests/support/killed.h"

namespace neve::test {

struct DisturbedCommand {
  const char* name;
  const char* prepare;    ///< for the shell, before each try
  const char* arguments;  ///< of neve
  const char* results;    ///< folder or file that it makes; empty: none
};

/// One place that is disturbed: what the library of tests/faults is told, by its number.
struct Disturbance {
  std::string name;
  /// Variables for the library. @param number  of the calls before it  @param way  one of `ways`
  std::string (*variables)(const std::string& name, int number, int way, const std::string& folder);
  int ways;             ///< in which each place is disturbed
  std::set<int> codes;  ///< the exit codes that tell of it
  std::string word;     ///< in the message
};

class DisturbedCli : public FaultyCli, public testing::WithParamInterface<DisturbedCommand> {
 protected:
  virtual std::string scene() const { return tiny_scene; }

  /// Prepares half a run, a whole sweep, and a script that saves.
  void SetUp() override {
    folder.write("scene.toml", scene());
    folder.write("exports.toml", scene() + "[[export]]\nname = \"points\"\nformat = \"ply\"\n");
    folder.write("clicks.txt", "1\n");
    folder.write("script.json", R"([{"click": "Frame"}, {"wait_for": "simulation frame 1"},
      {"wait": 5}, {"key": "s", "ctrl": true}, {"wait": 5}, {"quit": true}])");
    const std::string words = std::string(GetParam().prepare) + GetParam().arguments;
    if (contains(words, "half"))
      shell("\"$0\" render scene.toml --out half --frames 0-1 --checkpoint-every 1 --no-movie");
    if (contains(words, "earlier"))
      shell("\"$0\" render scene.toml --out earlier --frames 0-3 --set seed=7");
    if (contains(words, "listed"))
      shell("\"$0\" export scene.toml --out listed --frames 0-3 --format vtp --set seed=7");
    if (contains(words, "dusty")) {
      folder.write("dusty.toml",
                   scene() + std::string("[material.snow]\ndust = 0.1\n[dust]\nspeed = 0.5\n"
                                         "strain_rate = 1\n[[export]]\nname = \"cloud\"\n"
                                         "format = \"vdb\"\ndust = true\n"));
    }
    if (contains(words, "coarse_of"))
      shell(
          "\"$0\" sweep scene.toml -p seed=1,2 --frames 0-1 --coarsen 1.5 --out coarse_of --jobs "
          "1");
    if (contains(words, "made"))
      shell("\"$0\" sweep scene.toml -p seed=1,2 --frames 0-1 --out made --jobs 1");
  }

  app::output::ProcessResult shell(const std::string& line) {
    return app::output::run_process("/bin/bash", {"-c", line, NEVE_BINARY}, folder.path());
  }

  std::map<std::string, std::string> results() {
    const std::string where = GetParam().results;
    if (where.empty() || !exists(where)) return {};
    if (!std::filesystem::is_directory(folder / where)) return {{where, read_text(folder / where)}};
    return folder_contents(folder / where);
  }

  /// Disturbs it at every place, or at some. @param most  of its ways at all places
  /// @return how many
  int disturb(const Disturbance& disturbance, int most) {
    const std::map<std::string, std::string> whole = undisturbed(disturbance);
    const int all = disturbance.ways * static_cast<int>(calls()), tried = std::min(all, most);
    for (int k = 0; k < tried; ++k)
      disturb_at(disturbance, static_cast<int>(std::int64_t{all} * k / tried), whole);
    return tried;
  }

  /// Unfinished files of killed processes are removed, wherever the command writes. Runs of a sweep
  /// that have ended had finished.
  void expect_to_tidy() {
    shell(GetParam().prepare);
    EXPECT_EQ(failing("", GetParam().arguments).exit_code, 0);
    const bool is_folder = std::filesystem::is_directory(folder / GetParam().results);
    std::vector<std::filesystem::path> folders{is_folder ? folder / GetParam().results
                                                         : folder.path()};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folders[0]))
      if (entry.is_directory() && is_folder && !contains(entry.path().string(), "/runs"))
        folders.push_back(entry.path());
    leave_unfinished(folders);
    EXPECT_EQ(failing("", GetParam().arguments).exit_code, 0);
    expect_nothing_unfinished(folder.path(), GetParam().name);
  }

  /// Asks it to end, once, at random moments of the time that it takes: it does so within a second,
  /// says whether it can continue, and does.
  void interrupt_at_any_moment(int count) {
    shell(GetParam().prepare);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(failing("", GetParam().arguments).exit_code, 0);
    const std::map<std::string, std::string> whole = results();
    const std::chrono::duration<double> longest = std::chrono::steady_clock::now() - begin;
    std::mt19937 random(13);
    for (int k = 0; k < count; ++k) {
      const double seconds = std::uniform_real_distribution<>(0, longest.count())(random);
      const std::string place =
          std::string(GetParam().name) + " interrupted after " + std::to_string(seconds) + " s";
      shell(GetParam().prepare);
      const Ended ended = interrupt_after(folder.path(), GetParam().arguments, seconds);
      EXPECT_TRUE((std::set{0, 75, 130, 128 + SIGINT}.contains(ended.exit_code)))
          << ended.exit_code << " " << place;
      EXPECT_LT(ended.processor_seconds, 1) << place;
      expect_no_process(folder.path(), place);
      expect_to_continue(whole, place);
    }
  }

  /// Kills it at random moments of the time that it takes.
  void kill_at_any_moment(int kills) {
    shell(GetParam().prepare);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(failing("", GetParam().arguments).exit_code, 0);
    const std::map<std::string, std::string> whole = results();
    const std::chrono::duration<double> longest = std::chrono::steady_clock::now() - begin;
    std::mt19937 random(11);
    for (int k = 0; k < kills; ++k) {
      const double seconds = std::uniform_real_distribution<>(0, longest.count())(random);
      const std::string place =
          std::string(GetParam().name) + " killed after " + std::to_string(seconds) + " s";
      shell(GetParam().prepare);
      kill_after(folder.path(), GetParam().arguments, seconds);
      expect_no_process(folder.path(), place);
      expect_to_continue(whole, place);
    }
  }

 private:
  std::uint64_t calls() {
    std::uint64_t count = 0;
    const std::string bytes = read_text(folder / "count");
    std::memcpy(&count, bytes.data(), std::min(bytes.size(), sizeof count));
    return count;
  }

  app::output::ProcessResult run(const Disturbance& disturbance, int number, int way) {
    folder.write("count", std::string(8, '\0'));
    shell(GetParam().prepare);
    return failing("", GetParam().arguments,
                   disturbance.variables(disturbance.name, number, way, folder.path().string()));
  }

  std::map<std::string, std::string> undisturbed(const Disturbance& disturbance) {
    const auto result = run(disturbance, 1'000'000, 0);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return results();
  }

  /// @param number  of the place and its way
  void disturb_at(const Disturbance& disturbance, int number,
                  const std::map<std::string, std::string>& whole) {
    const int before = number / disturbance.ways, way = number % disturbance.ways;
    const auto result = run(disturbance, before, way);
    const std::string place = std::string(GetParam().name) + ", " + disturbance.name + " " +
                              std::to_string(before) + ", way " + std::to_string(way) + ": " +
                              result.errors + read_text(folder / "count.trace");
    if (result.exit_code == 0) {
      expect_same(whole, place);
    } else {
      EXPECT_TRUE(disturbance.codes.contains(result.exit_code))
          << "exit code " << result.exit_code << "\n"
          << place;
      EXPECT_TRUE(contains(result.errors, disturbance.word)) << place;
    }
    expect_to_continue(whole, place);
  }

  /// The same command once more, undisturbed.
  void expect_to_continue(const std::map<std::string, std::string>& whole,
                          const std::string& place) {
    const auto again = failing("", GetParam().arguments);
    EXPECT_EQ(again.exit_code, 0) << place << "\nthen\n" << again.errors;
    expect_same(whole, place + "\nthen\n" + again.errors);
    expect_nothing_unfinished(folder.path(), place);
  }

  void expect_same(const std::map<std::string, std::string>& whole, const std::string& place) {
    const std::map<std::string, std::string> found = results();
    for (const auto& [name, bytes] : whole)
      EXPECT_TRUE(found.contains(name) && found.at(name) == bytes) << name << " after " << place;
    for (const auto& [name, bytes] : found)
      EXPECT_TRUE(whole.contains(name)) << name << " is left over after " << place;
  }
};

/// The commands on a run whose arrays of particles are larger than 64 KiB.
class DisturbedMemoryCli : public DisturbedCli {
 protected:
  std::string scene() const override {
    std::string text = tiny_scene;
    return text.replace(text.find("cell_size = 0.04"), 16, "cell_size = 0.015");
  }
};

/// @param left_out  names of commands
inline std::vector<DisturbedCommand> disturbed_commands(const std::set<std::string>& left_out) {
  std::vector<DisturbedCommand> list{
      {"render", "rm -rf out",
       "render scene.toml --out out --frames 0-2 --checkpoint-every 1 --threads 2", "out"},
      {"resume", "rm -rf out; cp -r half out",
       "render scene.toml --out out --frames 0-2 --checkpoint-every 1 --resume", "out"},
      {"render_over", "rm -rf out; cp -r earlier out",
       "render scene.toml --out out --frames 0-1 --replace", "out"},
      {"export_over", "rm -rf out; cp -r listed out",
       "export scene.toml --frames 0-1 --format vtp --replace --out out", "out"},
      {"sweep", "rm -rf s", "sweep scene.toml -p seed=1,2 --frames 0-1 --out s --jobs 1", "s"},
      {"collect", "rm -rf s; cp -r made s; rm -rf s/data.csv s/sheet* s/strips* s/report.html",
       "sweep collect s", "s"},
      {"emit", "rm -rf s commands",
       "sweep scene.toml -p seed=1,2 --frames 0-1 --out s --emit commands", "s"},
      {"dump", "rm -f numbers", "dump scene.toml --at 0.01s --out numbers", "numbers"},
      {"export", "rm -rf out", "export scene.toml --frames 0-1 --format vtp,vti --out out", "out"},
      {"view", "rm -rf out", "view scene.toml --replay script.json --out out --size 640x400",
       "out"},
      {"scene_exports", "rm -rf out",
       "render exports.toml --out out --frames 0-1 --no-movie --threads 2", "out"},
      {"strip", "rm -f strip.png", "strip scene.toml --tiles 2 --frames 0-1 --out strip.png",
       "strip.png"},
      {"compare", "rm -rf c", "compare half earlier --frames 0-1 --out c", "c"},
      {"fork", "rm -rf s",
       "sweep scene.toml -p material.snow.hardening=5,7 --fork 0.05 --frames 0-3 --out s --jobs 1",
       "s"},
      {"pick", "rm -rf p",
       "pick scene.toml -p material.snow.hardening=5,20 --clicks clicks.txt --frames 0-1 "
       "--size 64x36 --out p",
       "p"},
      {"manual", "rm -rf m", "manual m", "m"},
      {"card", "rm -rf card", "card scene.toml --set solver.cell_size=0.04 --out card/c.png",
       "card"},
      {"draw_run", "rm -rf out; cp -r half out", "render out --view snow --no-movie --frames 0-1",
       "out"},
      {"replace", "rm -rf out; cp -r earlier out",
       "render scene.toml --out out --frames 0-1 --no-movie --replace --states-budget 100kB",
       "out"},
      {"dust", "rm -rf out", "render dusty.toml --out out --frames 0-1 --no-movie", "out"},
      {"dust_export", "rm -rf out", "export dusty.toml --frames 0-1 --format vdb,ply --out out",
       "out"},
      {"promote", "rm -f best.toml", "sweep promote made 0 --out best.toml", "best.toml"},
      {"refine", "rm -rf s; cp -r coarse_of s",
       "sweep scene.toml -p seed=1,2 --frames 0-1 --coarsen 1.5 --refine 1 --out s --jobs 1", "s"},
      {"pick_refine", "rm -rf p",
       "pick scene.toml -p material.snow.hardening=5,20 --clicks clicks.txt --frames 0-1 "
       "--size 64x36 --coarsen 1.5 --refine --out p",
       "p"},
      {"verify", "true", "verify half", ""},
      {"check", "true", "check scene.toml", ""}};
  std::erase_if(list,
                [&](const DisturbedCommand& command) { return left_out.contains(command.name); });
  return list;
}

inline std::string name_of(const testing::TestParamInfo<DisturbedCommand>& info) {
  return info.param.name;
}

/// The operation fails once, or from there on for ever.
inline Disturbance failing_operation(const std::string& operation) {
  const auto variables = [](const std::string& name, int number, int way,
                            const std::string& folder) {
    // Nothing needs room to be read or removed.
    std::vector<int> errors{ENOSPC, EIO, EDQUOT};
    if (name == "read" || name == "remove") errors = {EIO};
    if (name == "look") errors = {EIO, EMFILE};
    const int error = errors[static_cast<std::size_t>(number + way) % errors.size()];
    return "NEVE_FAULT_COUNT=$PWD/count NEVE_FAULT=" + name + ":" + std::to_string(error) + ":" +
           folder.substr(folder.rfind('/')) + "/:" + std::to_string(number) +
           (way == 0 ? ":1" : "");
  };
  // A file that cannot be read may be one of a run, which has a flaw then.
  const bool reads = operation == "read" || operation == "look";
  return {operation, variables, 2, reads ? std::set{6, 9} : std::set{6}, "neve: error: "};
}

inline Disturbance failing_allocation() {
  const auto variables = [](const std::string&, int number, int, const std::string&) {
    return "NEVE_ALLOCATIONS=" + std::to_string(number) + ":$PWD/count";
  };
  return {"allocation", variables, 1, {8}, "out of memory: "};
}

}  // namespace neve::test
