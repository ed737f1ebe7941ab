#pragma once
/// One timed run of a bench case from its start, and statistics of several.

#include <string>
#include <vector>

#include "app/bench/bench_case.h"
#include "app/bench/bench_report.h"

namespace neve::app::bench {

struct TimedRun {
  double seconds = 0;        ///< wall, of all steps
  sim::PhaseSeconds phases;  ///< of all steps
  double particle_steps = 0;
  std::uint64_t bytes = 0;  ///< of the simulation
  std::size_t particles = 0;
  int threads = 0;
  std::string simd;
};

/// Times bench_steps steps of a fresh simulation, again and again until 0.1 s have passed. Making
/// it is not timed; sorting and finding the limits of dt is.
/// @param name in the error of a case that diverges
TimedRun time_run(const BenchCase& bench_case, int threads, const std::string& name);

/// The rounds of one measurement.
class Samples {
 public:
  void add(const TimedRun& run) { runs_.push_back(run); }
  const std::vector<TimedRun>& runs() const { return runs_; }

  Statistics throughput() const;
  Statistics bytes_per_particle() const;
  sim::PhaseSeconds phases() const;  ///< per particle and step, of all rounds
  /// A row with the figures that runs contain.
  BenchRow throughput_row(const std::string& name) const;

 private:
  std::vector<TimedRun> runs_;
};

/// Time per particle and step of `a` over `b`, round by round.
Statistics time_ratio(const Samples& a, const Samples& b);
/// Bytes per particle of `a` over `b`.
Statistics memory_ratio(const Samples& a, const Samples& b);

/// Steps and stops on Ctrl-C. @throws Error when the simulation diverges
void run_steps(sim::Simulation& simulation, int steps);
void check_health(const sim::Simulation& simulation, const std::string& name);

}  // namespace neve::app::bench
