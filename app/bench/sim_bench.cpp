#include "app/bench/bench.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "app/bench/bench_case.h"
#include "app/bench/race.h"
#include "app/bench/timed_run.h"
#include "app/support/errors.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "sim/laws/law.h"

namespace neve::app::bench {

namespace {

constexpr double common_particles = 97336, quick_particles = 4096;
constexpr double longest_curve = 4'913'000;
/// Cells on a side of the packed cube that thin spray is compared with: 10 648 particles.
constexpr int thin_cells = 11;

/// Spray with more than a cell to a particle.
struct ThinSpray {
  const char* name;
  double cells_apart;
  SprayPlaces places;
};
/// Particles that share no node; and as many in 310^3 cells to 10 000 particles, a tenth of which
/// share some.
constexpr ThinSpray thin_sprays[] = {{"spray_lattice", 14, SprayPlaces::on_a_lattice},
                                     {"spray_thin", 14.39, SprayPlaces::at_random}};

struct Variant {
  BenchMethod method;
  sim::Precision precision;
  sim::Model model{};
};

/// The methods in the tables, and those with a naive counterpart.
constexpr BenchMethod main_methods[] = {BenchMethod::mls_quadratic, BenchMethod::flip_cubic};
std::vector<Variant> all_variants() {
  using enum sim::Precision;
  std::vector<Variant> all{
      {BenchMethod::mls_quadratic, single}, {BenchMethod::flip_cubic, single},
      {BenchMethod::apic_cubic, single},    {BenchMethod::asflip_cubic, single},
      {BenchMethod::mls_quadratic, real64}, {BenchMethod::flip_cubic, real64}};
  for (const sim::laws::Law& law : sim::laws::every())
    for (const BenchMethod method : main_methods)
      if (law.is_benched) all.push_back({method, single, law.model});
  return all;
}

std::string variant_name(const Variant& v) {
  const std::string law =
      v.model == sim::Model{} ? "" : std::string("_") + sim::laws::of(v.model).name;
  return std::string(name(v.method)) + law +
         (v.precision == sim::Precision::single ? "_float" : "_double");
}

/// "spray_time" is about the paper's method; the other one says which it is.
std::string name_for(const std::string& what, BenchMethod method) {
  return method == BenchMethod::flip_cubic ? what : what + "_" + name(method);
}

/// @throws LimitError when `bytes` are more than 80 % of the available memory
void check_memory(double bytes) {
  const auto allowed = static_cast<double>(usable_memory());
  if (bytes <= allowed) return;
  throw LimitError("refused: about " + bytes_text(static_cast<std::uint64_t>(bytes)) +
                       " of memory are more than 80 % of the available memory; measure fewer "
                       "particles with --particles",
                   "--particles", "measure fewer particles with --particles");
}

/// A simulation and the arrays it is made from.
double memory_of(double particles, sim::Precision precision, int threads) {
  return static_cast<double>(
             sim::estimate_memory(static_cast<std::size_t>(particles), 8,
                                  bench_settings(BenchMethod::flip_cubic, precision), threads)) +
         particles * 600;
}

class SimBench {
 public:
  SimBench(const BenchOptions& options, Progress& progress);
  std::vector<BenchRow> run();

 private:
  void measure_variants();
  void measure_spray();
  void measure_pairs();
  void measure_scaling();
  void measure_naive(int round);
  void gather_rows();
  BenchRow& add(const std::string& name, int threads, const Statistics& value,
                const std::string& unit);
  void add_throughput(const Variant& variant, int threads, const std::string& suffix = "");
  void add_memory_and_spray(BenchMethod method);

  Progress& progress_;
  int rounds_, threads_, cells_;
  std::size_t particles_ = 0;
  std::string simd_;
  std::map<std::string, Samples> runs_;  ///< by name: one for each round
  std::map<BenchMethod, Race> races_;
  std::vector<BenchRow> rows_;
};

SimBench::SimBench(const BenchOptions& options, Progress& progress)
    : progress_(progress),
      rounds_(std::min(options.rounds_or(2, 5), bench_steps)),
      threads_(options.threads),
      cells_(packed_cells_a_side(options.particles > 0 ? options.particles
                                 : options.is_quick    ? quick_particles
                                                       : common_particles)) {
  const double particles = 8.0 * cells_ * cells_ * cells_;
  // Two races of three codes each wait while a simulation is timed.
  check_memory(5 * memory_of(particles, sim::Precision::real64, threads_));
  const BenchCase c = packed_case(cells_, BenchMethod::flip_cubic, sim::Precision::single);
  const sim::Simulation probe(c.settings, {c.material}, {}, c.particles, threads_);
  threads_ = probe.threads();
  simd_ = probe.simd();
  particles_ = probe.particle_count();
  for (const BenchMethod method : main_methods) races_.try_emplace(method, cells_, method);
}

std::vector<BenchRow> SimBench::run() {
  progress_.note("neve bench sim: " + std::to_string(particles_) + " particles, " +
                 std::to_string(bench_steps) + " steps, " + std::to_string(rounds_) + " rounds, " +
                 std::to_string(threads_) + (threads_ == 1 ? " thread, " : " threads, ") + simd_);
  for (int round = 0; round < rounds_; ++round) {
    measure_variants();
    measure_spray();
    measure_pairs();
    measure_scaling();
    measure_naive(round);
    progress_.note("round " + std::to_string(round + 1) + " of " + std::to_string(rounds_));
  }
  for (const auto& [method, race] : races_) race.check_agreement();
  gather_rows();
  return rows_;
}

void SimBench::measure_variants() {
  for (const Variant& variant : all_variants()) {
    BenchCase c = packed_case(cells_, variant.method, variant.precision);
    c.material.model = variant.model;
    runs_[variant_name(variant)].add(time_run(c, threads_, variant_name(variant)));
  }
}

void SimBench::measure_spray() {
  for (const BenchMethod method : main_methods) {
    // Twice as many cells a side: eight times the cells for the same particles.
    const auto add = [&](const std::string& name, const BenchCase& c) {
      runs_[name_for(name, method)].add(time_run(c, threads_, name));
    };
    const auto single = sim::Precision::single;
    add("spray", spray_case(2 * cells_, 1, SprayPlaces::at_random, method, single));
    const int cells = std::min(cells_, thin_cells);
    add("packed", packed_case(cells, method, single));
    for (const ThinSpray& thin : thin_sprays)
      add(thin.name, spray_case(2 * cells, thin.cells_apart, thin.places, method, single));
  }
}

/// Snow that flows through and snow that only falls, on a body that moves and on a plate.
void SimBench::measure_pairs() {
  for (const BenchMethod method : main_methods)
    for (const bool has : {false, true}) {
      runs_[name_for(has ? "flow" : "stream", method)].add(
          time_run(stream_case(cells_, method, has), threads_, "flow"));
      runs_[name_for(has ? "body" : "plate", method)].add(
          time_run(plate_case(cells_, method, has), threads_, "body"));
    }
}

void SimBench::measure_scaling() {
  for (const BenchMethod method : main_methods) {
    const BenchCase c = packed_case(cells_, method, sim::Precision::single);
    const std::string name = variant_name({method, sim::Precision::single});
    // Reuses the result of measure_variants() with the same number of threads.
    const TimedRun& measured = runs_.at(name).runs().back();
    const auto with = [&](int threads) {
      return threads == threads_ ? measured : time_run(c, threads, name);
    };
    runs_[name + "_1_thread"].add(with(1));
    if (threads_ > 1) runs_[name + "_2_threads"].add(with(2));
  }
}

void SimBench::measure_naive(int round) {
  for (auto& [method, race] : races_)
    race.run(bench_steps * round / rounds_, bench_steps * (round + 1) / rounds_);
}

BenchRow& SimBench::add(const std::string& name, int threads, const Statistics& value,
                        const std::string& unit) {
  return rows_.emplace_back(BenchRow{name, threads, particles_, simd_, value, unit});
}

void SimBench::add_throughput(const Variant& variant, int threads, const std::string& suffix) {
  const Samples& samples = runs_.at(variant_name(variant) + suffix);
  BenchRow& row =
      add(variant_name(variant) + suffix, threads, samples.throughput(), throughput_unit);
  row.phases = samples.phases();
  const auto race = races_.find(variant.method);
  if (race != races_.end() && variant.model == sim::Model{})
    row.ratio_to_naive = race->second.ratio(variant.precision);
}

void SimBench::add_memory_and_spray(BenchMethod method) {
  const Samples& packed = runs_.at(variant_name({method, sim::Precision::single}));
  const Samples& spray = runs_.at(name_for("spray", method));
  add(name_for("memory_per_particle", method), threads_, packed.bytes_per_particle(), "B");
  add(name_for("spray_time", method), threads_, time_ratio(spray, packed), "x packed").phases =
      spray.phases();
  add(name_for("spray_memory", method), threads_, memory_ratio(spray, packed), "x packed");
  for (const ThinSpray& thin : thin_sprays) {
    const Samples& samples = runs_.at(name_for(thin.name, method));
    const auto add_thin = [&](const char* what, const Statistics& value,
                              const char* unit) -> BenchRow& {
      BenchRow& row = add(name_for(std::string(thin.name) + what, method), threads_, value, unit);
      row.particles = samples.runs().back().particles;
      return row;
    };
    add_thin("_time", time_ratio(samples, runs_.at(name_for("packed", method))), "x packed")
        .phases = samples.phases();
    add_thin("_memory", samples.bytes_per_particle(), "B");
  }
}

void SimBench::gather_rows() {
  const auto single = sim::Precision::single;
  const auto add_ratio = [&](const char* name, int threads, BenchMethod method, const Samples& a,
                             const Samples& b, const char* unit) {
    add(name_for(name, method), threads, time_ratio(a, b), unit);
  };
  for (const Variant& variant : all_variants()) add_throughput(variant, threads_);
  for (const BenchMethod method : main_methods) add_throughput({method, single}, 1, "_1_thread");
  for (const BenchMethod method : main_methods)
    add(std::string("naive_") + name(method), 1, races_.at(method).naive_throughput(),
        throughput_unit)
        .simd = "none";
  // One core cannot tell.
  if (threads_ > 1)
    for (const BenchMethod method : main_methods) {
      const std::string name = variant_name({method, single});
      add_ratio("scaling_2_threads", 2, method, runs_.at(name + "_1_thread"),
                runs_.at(name + "_2_threads"), "x one thread");
    }
  for (const BenchMethod method : main_methods) add_memory_and_spray(method);
  for (const auto& [name, with, without] :
       {std::array{"flow_time", "flow", "stream"}, {"body_time", "body", "plate"}})
    for (const BenchMethod method : main_methods)
      add_ratio(name, threads_, method, runs_.at(name_for(with, method)),
                runs_.at(name_for(without, method)), "x without");
}

}  // namespace

std::vector<BenchRow> bench_sim(const BenchOptions& options, Progress& progress) {
  return SimBench(options, progress).run();
}

std::vector<BenchRow> bench_curve(const BenchOptions& options, Progress& progress) {
  const int rounds = options.rounds_or(1, 3);
  const double most = options.particles > 0 ? options.particles
                      : options.is_quick    ? quick_particles
                                            : longest_curve;
  std::vector<BenchRow> rows;
  for (const int cells : {5, 7, 11, 16, 23, 34, 50, 63, 85}) {
    const double particles = 8.0 * cells * cells * cells;
    if (particles > most && !rows.empty()) break;
    const double bytes = memory_of(particles, sim::Precision::single, options.threads);
    if (bytes > static_cast<double>(usable_memory())) {
      progress.note("the curve ends before " + fixed_text(particles, 0) +
                    " particles: they need about " + bytes_text(static_cast<std::uint64_t>(bytes)) +
                    " of memory");
      break;
    }
    for (const BenchMethod method : main_methods) {
      const std::string name = "curve_" + variant_name({method, sim::Precision::single});
      const BenchCase c = packed_case(cells, method, sim::Precision::single);
      Samples samples;
      for (int round = 0; round < rounds; ++round) samples.add(time_run(c, options.threads, name));
      rows.push_back(samples.throughput_row(name));
      progress.note(name + ": " + fixed_text(particles, 0) + " particles, " +
                    fixed_text(rows.back().value.median, 2) + " " + throughput_unit);
    }
  }
  return rows;
}

}  // namespace neve::app::bench
