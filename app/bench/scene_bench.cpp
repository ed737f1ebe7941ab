#include "app/bench/scene_bench.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "app/bench/measure.h"
#include "app/bench/scratch_folder.h"
#include "app/output/process.h"
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

/// The costs of a run, a sample of each for every round.
struct FilmSamples {
  std::vector<double> film, steps, throughput, slowest, drawing;
  std::size_t particles = 0;
};

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

/// Renders the scene once.
void take_sample(const fs::path& scene, const Way& way, const BenchOptions& options,
                 FilmSamples& samples) {
  const ScratchFolder folder;
  std::vector<std::string> arguments{"render",
                                     scene.string(),
                                     "--quiet",
                                     "--out",
                                     "out",
                                     "--threads",
                                     std::to_string(options.threads),
                                     "--backend",
                                     options.backend};
  arguments.insert(arguments.end(), way.arguments.begin(), way.arguments.end());
  const int last = options.is_quick ? 2 : options.frames;
  if (last > 0) arguments.insert(arguments.end(), {"--frames", std::to_string(last)});
  const Stopwatch watch;
  const output::ProcessResult result =
      output::run_process("/proc/self/exe", arguments, folder.path());
  const double wall = watch.wall();
  if (result.exit_code != exit_ok)
    throw Error(exit_internal, scene.string() + ": neve render failed: " + result.errors);
  const std::vector<record::FrameRecord> frames = record::read_frame_records(folder.path() / "out");
  double simulated = 0, work = 0, steps = 0, slowest = 0;
  for (const record::FrameRecord& frame : frames) {
    if (frame.advance.steps == 0 || frame.summary.particles == 0) continue;
    simulated += frame.seconds_sim;
    work += record::particle_steps(frame);
    steps += static_cast<double>(frame.advance.steps);
    const double throughput = 1e-6 * record::particle_steps(frame) / frame.seconds_sim;
    slowest = slowest > 0 ? std::min(slowest, throughput) : throughput;
    samples.particles = std::max(samples.particles, frame.summary.particles);
  }
  samples.film.push_back(wall / std::max(1e-9, frames.back().time));
  samples.steps.push_back(steps / std::max(1, frames.back().frame));
  samples.throughput.push_back(1e-6 * work / simulated);
  samples.slowest.push_back(slowest);
  samples.drawing.push_back((wall - simulated) / wall);
}

}  // namespace

std::vector<BenchRow> bench_scenes(const BenchOptions& options, Progress& progress) {
  progress.note("neve bench scenes");
  const int rounds = std::max(1, options.rounds);
  std::vector<BenchRow> rows;
  for (const fs::path& scene : chosen_scenes(options)) {
    std::array<FilmSamples, ways.size()> samples;
    for (int round = 0; round < rounds; ++round)
      for (std::size_t k = 0; k < ways.size(); ++k) {
        stop_if_interrupted();
        take_sample(scene, ways[k], options, samples[k]);
      }
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const auto add = [&](const char* what, const std::vector<double>& values, const char* unit) {
        BenchRow row;
        row.name = scene.stem().string() + ways[k].suffix + what;
        row.threads = core_count(options.threads);
        row.particles = samples[k].particles;
        row.simd = sim::kernels::name(sim::kernels::chosen_simd_level());
        row.value = statistics_of(values);
        row.unit = unit;
        rows.push_back(row);
      };
      add("", samples[k].film, "s per s of film");
      add("_steps", samples[k].steps, "steps per frame");
      add("_throughput", samples[k].throughput, throughput_unit);
      add("_slowest_frame", samples[k].slowest, throughput_unit);
      add("_drawing", samples[k].drawing, "of the time");
      progress.note(fmt::format("{}{}: {} s per s of film", scene.stem().string(), ways[k].suffix,
                                fixed_text(statistics_of(samples[k].film).median, 2)));
    }
  }
  return rows;
}

}  // namespace neve::app::bench
