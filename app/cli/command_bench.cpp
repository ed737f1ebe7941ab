#include <unistd.h>

#include <iostream>

#include "app/bench/frame_bench.h"
#include "app/bench/measure.h"
#include "app/bench/render_bench.h"
#include "app/bench/scene_bench.h"
#include "app/bench/sim_bench.h"
#include "app/bench/surface_bench.h"
#include "app/bench/sweep_bench.h"
#include "app/bench/view_bench.h"
#include "app/cli/commands.h"
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
  else if (options.is_markdown)
    bench::print_markdown(std::cout, rows);
  else
    bench::print_table(std::cout, rows);
}

/// Prints the circumstances of the figures: the machine, the build, and the load by others.
template <class Bench>
int run_bench(const bench::BenchOptions& options, const Bench& bench) {
  catch_interrupts();
  Progress progress(std::cerr, Verbosity::normal, can_update_lines(STDERR_FILENO));
  progress.note(machine_text());
  if (!bench::build_fault().empty())
    progress.warning(bench::build_fault() +
                     "; its figures are meaningless. Build with -DCMAKE_BUILD_TYPE=Release");
  const bench::OtherLoad others;
  const std::vector<bench::BenchRow> rows = bench(options, progress);
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

}  // namespace

int run_bench_sim(const bench::BenchOptions& options) {
  return run_bench(options, options.is_curve ? bench::bench_curve : bench::bench_sim);
}

int run_bench_frame(const bench::BenchOptions& options) {
  return run_bench(options, bench::bench_frame);
}

int run_bench_render(const bench::BenchOptions& options) {
  return run_bench(options, bench::bench_render);
}

int run_bench_scenes(const bench::BenchOptions& options) {
  return run_bench(options, bench::bench_scenes);
}

int run_bench_surface(const bench::BenchOptions& options) {
  return run_bench(options, bench::bench_surface);
}

int run_bench_sweep(const bench::BenchOptions& options) {
  return run_bench(options, bench::bench_sweep);
}

int run_bench_view(const bench::BenchOptions& options) {
  return run_bench(options, bench::bench_view);
}

}  // namespace neve::app::cli
