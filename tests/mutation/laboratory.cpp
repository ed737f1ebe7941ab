#include "tests/mutation/laboratory.h"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <map>
#include <stdexcept>
#include <thread>

#include "app/output/process.h"
#include "app/support/json.h"
#include "tests/mutation/edits.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {

namespace {

namespace fs = std::filesystem;

constexpr const char* kernels = "tests/mutation/probe/reduced_kernels.cpp";
/// Compiled for mistakes in its own header only.
constexpr const char* contact = "tests/mutation/probe/reduced_contact.cpp";
constexpr const char* contact_header = "sim/kernels/particle_contact_sweeps.h";

struct Trouble : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// @throws Trouble unless it succeeds
std::string run(const fs::path& program, const std::vector<std::string>& arguments,
                const fs::path& folder) {
  const app::output::ProcessResult result = app::output::run_process(program, arguments, folder);
  if (result.exit_code != 0)
    throw Trouble(program.filename().string() + " ended with " + std::to_string(result.exit_code) +
                  ": " + result.errors.substr(0, 2000));
  return result.output;
}

void compile(const std::string& source, const fs::path& object, const fs::path& copies,
             const Mistake& mistake) {
  const fs::path copy = copies / source;
  const fs::path from = fs::exists(copy) ? copy : fs::path(NEVE_SOURCE_DIR) / source;
  std::vector<std::string> command{
      "-std=c++20",        "-O1", "-w", "-ffp-contract=off", "-fno-math-errno",
      "-fno-var-tracking", "-c",  "-o", object.string(),     from.string()};
  command.insert(command.end(),
                 {"-I" + copies.string(), "-I" NEVE_SOURCE_DIR, "-isystem", NEVE_EIGEN});
  if (mistake.is_of_asflip()) command.emplace_back("-DNEVE_PROBE_ASFLIP");
  run(NEVE_COMPILER, command, copies);
}

/// Copies the files that a mistake changes, changed.
void make_copies(const Mistake& mistake, const fs::path& copies) {
  std::map<std::string, std::string> texts;
  for (const Edit& edit : mistake.edits) {
    if (!texts.contains(edit.file))
      texts[edit.file] = read_text(fs::path(NEVE_SOURCE_DIR) / edit.file);
    if (const std::string lost = lost_place(mistake, edit); !lost.empty()) throw Trouble(lost);
    texts[edit.file] = edited(texts[edit.file], edit);
  }
  for (const auto& [file, text] : texts) {
    fs::create_directories((copies / file).parent_path());
    std::ofstream(copies / file, std::ios::binary) << text;
  }
}

bool is_source(const Edit& edit) {
  return edit.file.ends_with(".cpp");
}
bool is_of_contact(const Edit& edit) {
  return edit.file == contact_header;
}
bool is_of_kernels(const Edit& edit) {
  return !is_source(edit) && !is_of_contact(edit);
}

std::vector<std::string> strings(const app::Json& json) {
  return json.get<std::vector<std::string>>();
}

}  // namespace

Laboratory::Laboratory(const fs::path& folder) : folder_(folder), kernels_(folder / "kernels.o") {
  compile(kernels, kernels_, folder_, Mistake{});
}

Finding Laboratory::examine(const Mistake& mistake) const {
  Finding finding;
  try {
    const fs::path copies = folder_ / mistake.name;
    fs::create_directories(copies);
    make_copies(mistake, copies);
    std::vector<std::string> objects;
    const auto add = [&](const std::string& source) {
      objects.push_back((copies / (fs::path(source).stem().string() + ".o")).string());
      compile(source, objects.back(), copies, mistake);
    };
    // Headers with mistakes are those of the kernels; other files see the right ones.
    const auto has = [&](bool (*is_there)(const Edit&)) {
      return std::any_of(mistake.edits.begin(), mistake.edits.end(), is_there);
    };
    if (mistake.is_of_asflip() || has(is_of_kernels))
      add(kernels);
    else
      objects.push_back(kernels_.string());
    if (has(is_of_contact)) add(contact);
    for (const Edit& edit : mistake.edits)
      if (is_source(edit) && !fs::exists(copies / (fs::path(edit.file).stem().string() + ".o")))
        add(edit.file);
    std::vector<std::string> link = objects;
    // A build that compiles many files as one has all of a changed file in its library a second
    // time; the first is taken.
    link.insert(link.end(),
                {NEVE_PROBE, NEVE_SIM, "-Wl,-z,muldefs", "-pthread", "-lz", NEVE_BULLET,
                 NEVE_BULLET_COLLISION, NEVE_BULLET_MATH, "-o", (copies / "probe").string()});
    run(NEVE_COMPILER, link, copies);
    std::vector<std::string> arguments{"60", (copies / "probe").string()};
    arguments.insert(arguments.end(), mistake.arguments.begin(), mistake.arguments.end());
    const app::Json json =
        app::parse_json(std::string_view(run("/usr/bin/timeout", arguments, copies)));
    finding = {{}, strings(json["self_tests"]), strings(json["drop"]), strings(json["spin"])};
  } catch (const std::exception& error) {
    finding.trouble = error.what();
  }
  return finding;
}

std::vector<Finding> Laboratory::examine(const std::vector<Mistake>& mistakes) const {
  std::vector<Finding> findings(mistakes.size());
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> workers;
  for (unsigned w = 0; w < std::max(1u, std::thread::hardware_concurrency()); ++w)
    workers.emplace_back([&] {
      for (std::size_t k = next++; k < mistakes.size(); k = next++)
        findings[k] = examine(mistakes[k]);
    });
  workers.clear();
  return findings;
}

}  // namespace neve::test
