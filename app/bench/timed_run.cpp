#include "app/bench/timed_run.h"

#include <algorithm>

#include "app/bench/measure.h"
#include "app/support/errors.h"

namespace neve::app::bench {

namespace {

constexpr double shortest_measurement = 0.1;  // s

template <class Value>
Statistics of_each(const std::vector<TimedRun>& runs, const Value& value) {
  std::vector<double> samples;
  for (const TimedRun& run : runs) samples.push_back(value(run));
  return statistics_of(samples);
}

double bytes_a_particle(const TimedRun& w) {
  return static_cast<double>(w.bytes) / static_cast<double>(w.particles);
}

template <class Value>
Statistics ratio_of_each(const Samples& a, const Samples& b, const Value& value) {
  std::vector<double> ratios;
  const std::size_t rounds = std::min(a.runs().size(), b.runs().size());
  for (std::size_t r = 0; r < rounds; ++r)
    ratios.push_back(value(a.runs()[r]) / value(b.runs()[r]));
  return statistics_of(ratios);
}

}  // namespace

void run_steps(sim::Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) {
    simulation.step(simulation.choose_dt(1).dt);
    stop_if_interrupted();
  }
}

void check_health(const sim::Simulation& simulation, const std::string& name) {
  if (!simulation.divergence()) return;
  throw Error(exit_diverged,
              "the bench case " + name + " " + simulation.divergence()->sentence +
                  "; its time would be meaningless",
              name, "this is an error in neve: please report it");
}

TimedRun time_run(const BenchCase& bench_case, int threads, const std::string& name) {
  TimedRun run;
  do {
    sim::Simulation simulation(bench_case.settings, {bench_case.material}, bench_case.colliders,
                               bench_case.particles, threads, sim::Vec3i::Zero(), bench_case.flow);
    const Stopwatch watch;
    run_steps(simulation, bench_steps);
    run.seconds += watch.wall();
    const sim::PhaseSeconds taken = simulation.phase_seconds();
    for (const Phase& p : phases) run.phases.*p.seconds += taken.*p.seconds;
    run.particles = simulation.particle_count();
    run.particle_steps += static_cast<double>(run.particles) * bench_steps;
    run.bytes = simulation.memory_bytes();
    run.threads = simulation.threads();
    run.simd = simulation.simd();
    // The end of a frame is where energy is added up.
    simulation.advance_to(simulation.time() + bench_case.settings.dt);
    check_health(simulation, name);
  } while (run.seconds < shortest_measurement);
  return run;
}

Statistics Samples::throughput() const {
  return of_each(runs_, [](const TimedRun& w) { return 1e-6 * w.particle_steps / w.seconds; });
}

Statistics Samples::bytes_per_particle() const {
  return of_each(runs_, bytes_a_particle);
}

sim::PhaseSeconds Samples::phases() const {
  sim::PhaseSeconds sum;
  double particle_steps = 0;
  for (const TimedRun& run : runs_) {
    for (const Phase& p : bench::phases) sum.*p.seconds += run.phases.*p.seconds;
    particle_steps += run.particle_steps;
  }
  for (const Phase& p : bench::phases) sum.*p.seconds /= particle_steps;
  return sum;
}

BenchRow Samples::throughput_row(const std::string& name) const {
  const TimedRun& last = runs_.back();
  return {name, last.threads, last.particles, last.simd, throughput(), throughput_unit,
          {},   phases()};
}

Statistics time_ratio(const Samples& a, const Samples& b) {
  return ratio_of_each(a, b, [](const TimedRun& w) { return w.seconds / w.particle_steps; });
}

Statistics memory_ratio(const Samples& a, const Samples& b) {
  return ratio_of_each(a, b, bytes_a_particle);
}

}  // namespace neve::app::bench
