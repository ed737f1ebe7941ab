#pragma once
/// The solver against the naive code: the same steps of the same snow, one thread each.

#include <vector>

#include "app/bench/bench_case.h"
#include "app/bench/bench_report.h"
#include "app/bench/naive.h"

namespace neve::app::bench {

/// All start together and are advanced in turns, so that they meet the same snow in the same
/// minute. Measured in CPU time, which other processes on the machine hardly change.
class Race {
 public:
  Race(int cells_a_side, BenchMethod method);

  /// Steps [first, last) of the case, each code in turn.
  void run(int first, int last);

  /// Median over the turns.
  double ratio(sim::Precision precision) const;
  Statistics naive_throughput() const;

  /// @throws Error when a simulation diverged, or its snow ends up elsewhere than the naive one
  void check_agreement() const;

 private:
  struct Runner {
    sim::Simulation simulation;
    std::vector<double> seconds;
  };
  static Runner make_runner(int cells_a_side, BenchMethod method, sim::Precision precision);
  void check_agreement(const Runner& runner) const;

  std::string name_;
  Runner single_, double_;
  NaiveSnow naive_;
  std::vector<double> naive_seconds_, particle_steps_;
};

}  // namespace neve::app::bench
