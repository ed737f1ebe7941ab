#include <unistd.h>

#include <iostream>

#include "app/bench/frame_bench.h"
#include "app/bench/measure.h"
#include "app/bench/render_bench.h"
#include "app/bench/sim_bench.h"
#include "app/bench/sweep_bench.h"
#include "app/bench/view_bench.h"
#include "app/commands.h"
#include "app/errors.h"
#include "app/interrupt.h"
#include "app/machine.h"
#include "app/progress.h"
#include "app/text.h"

namespace neve::app {

namespace {

void print_rows(const std::vector<BenchRow>& rows, const BenchOptions& options) {
  if (options.is_json)
    std::cout << to_text(to_json(rows)) << "\n";
  else if (options.is_markdown)
    print_markdown(std::cout, rows);
  else
    print_table(std::cout, rows);
}

/// Says what a reader of the figures has to know: the machine, the build, and who else was there.
template <class Bench>
int run_bench(const BenchOptions& options, const Bench& bench) {
  catch_interrupts();
  Progress progress(std::cerr, Verbosity::normal, can_update_lines(STDERR_FILENO));
  progress.note(machine_text());
  if (!build_fault().empty())
    progress.warning(build_fault() +
                     "; its figures mean nothing. Build with -DCMAKE_BUILD_TYPE=Release");
  const OtherLoad others;
  const std::vector<BenchRow> rows = bench(options, progress);
  const double share = others.share();
  if (share > 0.05)
    progress.warning("other processes used " + fixed_text(100 * share, 0) +
                     " % of the machine meanwhile; trust ratios and the best of the rounds");
  if (options.is_quick)
    progress.note("neve: --quick looks whether it works; its figures mean little");
  print_rows(rows, options);
  return exit_ok;
}

}  // namespace

int run_bench_sim(const BenchOptions& options) {
  return run_bench(options, options.is_curve ? bench_curve : bench_sim);
}

int run_bench_frame(const BenchOptions& options) {
  return run_bench(options, bench_frame);
}

int run_bench_render(const BenchOptions& options) {
  return run_bench(options, bench_render);
}

int run_bench_sweep(const BenchOptions& options) {
  return run_bench(options, bench_sweep);
}

int run_bench_view(const BenchOptions& options) {
  return run_bench(options, bench_view);
}

}  // namespace neve::app
