#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/bench/bench.h"
#include "app/bench/measure.h"
#include "app/cli/command_line.h"
#include "app/options/common.h"
#include "app/options/languages.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/progress.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

void print_rows(const std::vector<bench::BenchRow>& rows, const bench::BenchOptions& options) {
  if (options.is_json)
    std::cout << to_text(bench::to_json(rows)) << "\n";
  else
    bench::print_tables(std::cout, rows, options.is_markdown);
}

/// A part of the measurements.
struct BenchPart {
  const char *name, *help;
  std::vector<bench::BenchRow> (*run)(const bench::BenchOptions&, Progress&);
  bool has_backend = true;
};

/// Prints the circumstances of the figures: the machine, the build, and the load by others.
int run_bench(const bench::BenchOptions& options, const BenchPart& part) {
  catch_interrupts();
  Progress progress(Verbosity::normal);
  progress.note(machine_text());
  if (!bench::build_fault().empty())
    progress.warning(bench::build_fault() +
                     "; its figures are meaningless. Build with -DCMAKE_BUILD_TYPE=Release");
  const bench::OtherLoad others;
  const std::vector<bench::BenchRow> rows = part.run(options, progress);
  const double share = others.share();
  if (share > 0.05)
    progress.warning(
        "other processes used " + fixed_text(100 * share, 0) +
        " % of the machine during the measurement; trust only ratios and the best of the rounds");
  if (options.is_quick)
    progress.note("neve: --quick only tests the benchmark; its figures mean little");
  print_rows(rows, options);
  return exit_ok;
}

std::vector<bench::BenchRow> measure_sim(const bench::BenchOptions& options, Progress& progress) {
  return options.is_curve ? bench::bench_curve(options, progress)
                          : bench::bench_sim(options, progress);
}

constexpr BenchPart bench_parts[] = {
    {"sim",
     "Measure particle-steps per second of each method, interleaved with naive code; time per "
     "phase, memory, spray, scaling from 1 to 2 threads",
     measure_sim, false},
    {"frame",
     "Measure seconds per frame of 300000 particles, per frame of 4000 particles with drawing, and "
     "to the first picture; and the gain of --coarsen 2",
     bench::bench_frame},
    {"render",
     "Measure milliseconds per picture at 1280x720: 4000 to a million particles, all layers, each "
     "phase, spheres by OpenGL against spheres by the CPU, PNG encoding",
     bench::bench_render},
    {"surface",
     "Measure milliseconds per mesh of the snow's surface and for the attributes of its vertices, "
     "from 4000 to a million particles",
     bench::bench_surface, false},
    {"scenes",
     "Measure seconds per second of film of the shipped scenes, also with --coarsen 2 and --fast; "
     "steps, throughput and the share of drawing",
     bench::bench_scenes},
    {"sweep",
     "Measure the share of the cores that many small runs use, and the overhead of each run",
     bench::bench_sweep},
    {"view",
     "Measure pictures per second of neve view during a simulation of 97000 particles, and "
     "milliseconds from input to picture",
     bench::bench_view}};

void describe_part(options::Command& visit, bench::BenchOptions& o, const BenchPart& part) {
  const std::string name = part.name;
  visit.about("bench " + name, part.help);
  visit.other_place = "set TMPDIR to a folder that may be written";
  visit("--rounds", o.rounds, options::number<int>("N", 1, 1000, "a whole number from 1 to 1000"),
        "Repetitions of each measurement; the table shows median, min and max");
  options::describe_threads(visit, o.threads);
  visit("--quick", o.is_quick, "Use few particles and rounds, to test the benchmark itself");
  visit("--markdown", o.is_markdown, "Print Markdown tables, as in docs/performance.md")
      .excludes({"--json"}, "give one of the two");
  visit("--json", o.is_json, "Print a JSON list, one object per row");
  if (name == "sim") {
    visit("--particles", o.particles,
          options::number<double>("N", 1, 1e9, "a number from 1 to 1e9"),
          "Number of particles instead of 97336; with --curve, of the last point");
    visit("--curve", o.is_curve,
          "Measure throughput from 1000 to 5 million particles instead, as memory allows");
  }
  if (name == "scenes") {
    visit("--only", o.only, options::text("NAME", "press"),
          "Measure only the scene of this name, as in press");
    visit("--frames", o.frames,
          options::number<int>("N", 0, 1000000, "a number of frames, or 0 for all"),
          "Measure the first N frames of each film");
  }
  if (part.has_backend) options::describe_backend(visit, o.backend);
}

}  // namespace

Entry bench_entry() {
  Entry bench;
  bench.command.about("bench", "Measure how fast this machine simulates and draws");
  for (const BenchPart& part : bench_parts) {
    const auto options = std::make_shared<bench::BenchOptions>();
    Entry& entry = bench.parts.emplace_back();
    describe_part(entry.command, *options, part);
    entry.run = [options, &part] { return run_bench(*options, part); };
  }
  return bench;
}

}  // namespace neve::app::cli
