#pragma once
/// The parts of `neve bench`, and their options.

#include <string>
#include <vector>

#include "app/bench/bench_report.h"
#include "app/support/progress.h"

namespace neve::app::bench {

struct BenchOptions {
  int rounds = 0;        ///< 0: as many as are usual
  double particles = 0;  ///< 0: the common case, or the end of the curve
  bool is_curve = false;
  std::string only;  ///< name of a scene; "": all that are shipped
  int frames = 0;    ///< of a scene's film; 0: all
  int threads = 0;   ///< 0: one per core
  std::string backend = "auto";
  bool is_quick = false;
  bool is_json = false;
  bool is_markdown = false;

  int rounds_or(int quick, int usual) const {
    return rounds > 0 ? rounds : is_quick ? quick : usual;
  }
};

/// `neve bench frame`: how long users wait, for frames, the first picture and coarsened scenes.
/// @throws render::ContextError where nothing can be drawn, Error when a scene diverges
std::vector<BenchRow> bench_frame(const BenchOptions& options, Progress& progress);

/// `neve bench render`: milliseconds per picture, those of its phases, and OpenGL's spheres against
/// those of the CPU. @throws render::ContextError where nothing can be drawn
std::vector<BenchRow> bench_render(const BenchOptions& options, Progress& progress);

/// `neve bench scenes`: how long users wait for the films of the shipped scenes. Renders each by
/// the program itself: at its own resolution, with --coarsen 2, with --fast, and with both, in
/// turns.
/// @throws UsageError for a scene that does not exist, Error when one fails
std::vector<BenchRow> bench_scenes(const BenchOptions& options, Progress& progress);

/// `neve bench sim`: the common case in all variants against the naive code, spray, scaling.
/// @throws Error when the case diverges, the codes disagree or memory does not suffice
std::vector<BenchRow> bench_sim(const BenchOptions& options, Progress& progress);
/// `neve bench sim --curve`: throughput from a thousand particles to the most that fit.
std::vector<BenchRow> bench_curve(const BenchOptions& options, Progress& progress);

/// `neve bench surface`: makes the mesh of a ball on a slab from 4000 to a million particles, and
/// the attributes of its vertices; also at one thread.
std::vector<BenchRow> bench_surface(const BenchOptions& options, Progress& progress);

/// `neve bench sweep`: the share of the cores that a sweep uses, and the overhead of a run.
/// @throws IoError, render::ContextError, Error when a run fails
std::vector<BenchRow> bench_sweep(const BenchOptions& options, Progress& progress);

/// `neve bench view`: how quickly the interactive view answers, pictures compressed as the web page
/// gets them; without a network. @throws render::ContextError, Error
std::vector<BenchRow> bench_view(const BenchOptions& options, Progress& progress);

}  // namespace neve::app::bench
