#include "app/bench/race.h"

#include <cmath>

#include "app/bench/measure.h"
#include "app/bench/timed_run.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::bench {

namespace {

NaiveSnow make_naive(int cells_a_side, BenchMethod method) {
  const BenchCase c = packed_case(cells_a_side, method, sim::Precision::real64);
  return {c.settings, c.material, c.particles};
}

/// Results on which both codes must agree.
struct Outcome {
  double mean_J_P = 0, mean_speed = 0;
};

Outcome outcome_of(const sim::ParticleArrays& p) {
  Outcome sum;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    sum.mean_J_P += p.J_P[q];
    sum.mean_speed += p.v[q].norm();
  }
  const auto count = static_cast<double>(p.x.size());
  return {sum.mean_J_P / count, sum.mean_speed / count};
}

}  // namespace

Race::Runner Race::make_runner(int cells_a_side, BenchMethod method, sim::Precision precision) {
  const BenchCase c = packed_case(cells_a_side, method, precision);
  return {sim::Simulation(c.settings, {c.material}, {}, c.particles, 1), {}};
}

Race::Race(int cells_a_side, BenchMethod method)
    : name_(name(method)),
      single_(make_runner(cells_a_side, method, sim::Precision::single)),
      double_(make_runner(cells_a_side, method, sim::Precision::real64)),
      naive_(make_naive(cells_a_side, method)) {}

void Race::run(int first, int last) {
  for (Runner* runner : {&single_, &double_}) {
    const Stopwatch watch;
    run_steps(runner->simulation, last - first);
    runner->seconds.push_back(watch.cpu());
  }
  const double dt = bench_settings(BenchMethod::flip_cubic, sim::Precision::single).dt;
  const Stopwatch watch;
  for (int k = first; k < last; ++k) {
    naive_.step(dt);
    stop_if_interrupted();
  }
  naive_seconds_.push_back(watch.cpu());
  particle_steps_.push_back(static_cast<double>(single_.simulation.particle_count()) *
                            (last - first));
}

double Race::ratio(sim::Precision precision) const {
  const Runner& runner = precision == sim::Precision::single ? single_ : double_;
  std::vector<double> ratios;
  for (std::size_t turn = 0; turn < naive_seconds_.size(); ++turn)
    ratios.push_back(naive_seconds_[turn] / runner.seconds[turn]);
  return statistics_of(ratios).median;
}

Statistics Race::naive_throughput() const {
  std::vector<double> samples;
  for (std::size_t turn = 0; turn < naive_seconds_.size(); ++turn)
    samples.push_back(1e-6 * particle_steps_[turn] / naive_seconds_[turn]);
  return statistics_of(samples);
}

void Race::check_agreement() const {
  check_agreement(single_);
  check_agreement(double_);
}

void Race::check_agreement(const Runner& runner) const {
  check_health(runner.simulation, name_);
  const Outcome a = outcome_of(runner.simulation.particles()), b = outcome_of(naive_.particles());
  // Single precision leaves 1e-5 of difference after these steps; other physics much more.
  constexpr double tolerance = 1e-3;
  const bool agree = std::abs(a.mean_J_P - b.mean_J_P) <= tolerance * b.mean_J_P &&
                     std::abs(a.mean_speed - b.mean_speed) <= tolerance * b.mean_speed;
  if (agree) return;
  throw Error(exit_check_failed,
              "the solver and the naive code disagree on " + name_ + ": mean J_P " +
                  fixed_text(a.mean_J_P, 6) + " and " + fixed_text(b.mean_J_P, 6) +
                  ", mean speed " + fixed_text(a.mean_speed, 6) + " and " +
                  fixed_text(b.mean_speed, 6) + " m/s; their times cannot be compared",
              name_, "this is an error in neve: please report it");
}

}  // namespace neve::app::bench
