#include "app/bench/bench.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "app/bench/measure.h"
#include "app/record/run_json.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "sim/kernels/simd.h"

namespace neve::app::bench {

namespace {

namespace fs = std::filesystem;

/// A way to render a scene.
struct Way {
  const char* suffix;  ///< of its rows
  std::vector<std::string> arguments;
};

const std::array<Way, 4> ways{{{"", {}},
                               {"_coarsen_2", {"--coarsen", "2"}},
                               {"_fast", {"--fast"}},
                               {"_coarsen_2_fast", {"--coarsen", "2", "--fast"}}}};

std::vector<fs::path> chosen_scenes(const BenchOptions& options) {
  const fs::path folder = default_scene().parent_path();
  if (options.is_quick && options.only.empty()) return {folder / "snowball_drop.toml"};
  std::vector<fs::path> scenes;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml" &&
        (options.only.empty() || entry.path().stem() == options.only))
      scenes.push_back(entry.path());
  if (scenes.empty())
    throw UsageError("--only", "there is no scene " + options.only,
                     "expected the name of a file in " + folder.string());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

/// Renders the scene once. @return s per s of film
double take_sample(const fs::path& scene, const Way& way, const BenchOptions& options,
                   RowSamples& rows) {
  const ScratchFolder folder;
  std::vector<std::string> arguments{scene.string()};
  arguments.insert(arguments.end(), way.arguments.begin(), way.arguments.end());
  const int last = options.is_quick ? 2 : options.frames;
  if (last > 0) arguments.insert(arguments.end(), {"--frames", std::to_string(last)});
  const double wall = seconds_of_render(scene.string(), folder.path(), options, arguments);
  const std::vector<record::FrameRecord> frames = record::read_frame_records(folder.path() / "out");
  double simulated = 0, work = 0, steps = 0, slowest = 0;
  std::size_t particles = 0;
  for (const record::FrameRecord& frame : frames) {
    if (frame.advance.steps == 0 || frame.summary.particles == 0) continue;
    simulated += frame.seconds_sim;
    work += record::particle_steps(frame);
    steps += static_cast<double>(frame.advance.steps);
    const double throughput = 1e-6 * record::particle_steps(frame) / frame.seconds_sim;
    slowest = slowest > 0 ? std::min(slowest, throughput) : throughput;
    particles = std::max(particles, frame.summary.particles);
  }
  const auto add = [&](const char* what, double value, const char* unit) {
    rows.add({scene.stem().string() + way.suffix + what,
              core_count(options.threads),
              particles,
              sim::kernels::name(sim::kernels::chosen_simd_level()),
              {},
              unit},
             value);
    return value;
  };
  const double film = add("", wall / std::max(1e-9, frames.back().time), "s per s of film");
  add("_steps", steps / std::max(1, frames.back().frame), "steps per frame");
  add("_throughput", 1e-6 * work / simulated, throughput_unit);
  add("_slowest_frame", slowest, throughput_unit);
  add("_drawing", (wall - simulated) / wall, "of the time");
  return film;
}

}  // namespace

std::vector<BenchRow> bench_scenes(const BenchOptions& options, Progress& progress) {
  progress.note("neve bench scenes");
  RowSamples rows;
  for (const fs::path& scene : chosen_scenes(options)) {
    std::array<std::vector<double>, ways.size()> films;
    for (int round = 0; round < std::max(1, options.rounds); ++round)
      for (std::size_t k = 0; k < ways.size(); ++k) {
        stop_if_interrupted();
        films[k].push_back(take_sample(scene, ways[k], options, rows));
      }
    for (std::size_t k = 0; k < ways.size(); ++k)
      progress.note(fmt::format("{}{}: {} s per s of film", scene.stem().string(), ways[k].suffix,
                                fixed_text(statistics_of(films[k]).median, 2)));
  }
  return rows.rows();
}

}  // namespace neve::app::bench
