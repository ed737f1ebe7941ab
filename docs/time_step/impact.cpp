/// The runs of docs/time_step.md: a snowball of 0.15 m hits a floor at 5 m/s; one line of numbers
/// every 1/120 s. ./study in this folder compiles it and runs the whole study.
///   impact [snow=paper|dry] [n=8] [transfer=flip|mls] [acoustic_cfl=0.5] [flip_reference_dt=5e-4]
///          [seed=1] [speed=5] [youngs_modulus=] [model=snow|corotated]
///          [beta=0] [dt=0] [max_dt=1e-3] [contact_at=particles|nodes] [collide_after_solve=0]
///          [solve_tolerance=1e-2] [time=0.125]
/// n is the radius in cells. FLIP is cubic, MLS quadratic. dt > 0: fixed steps. The last line but
/// one tells what the solve took; seconds are CPU time.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>

#include "sim/laws/list.h"
#include "sim/seeding/seeding.h"
#include "sim/simulation.h"

using namespace neve::sim;
using namespace neve::sim::seeding;
using namespace neve::sim::shapes;

namespace {

constexpr double radius = 0.15, lines_per_second = 120;

using Arguments = std::map<std::string, std::string>;

Simulation make_simulation(Arguments& a) {
  const auto number = [&](const char* key) { return std::atof(a[key].c_str()); };
  const bool is_flip = a["transfer"] == "flip";
  SolverSettings s;
  s.cell_size = radius / number("n");
  s.transfer = is_flip ? Transfer::flip : Transfer::mls;
  s.kernel = is_flip ? Kernel::cubic : Kernel::quadratic;
  s.acoustic_cfl = number("acoustic_cfl");
  s.flip_reference_dt = number("flip_reference_dt");
  s.beta = number("beta");
  s.contact_at = a["contact_at"] == "nodes" ? ContactAt::nodes : ContactAt::particles;
  s.collide_after_solve = number("collide_after_solve") > 0;
  s.max_dt = number("max_dt");
  s.solve_tolerance = number("solve_tolerance");
  if (number("dt") > 0) {
    s.time_step = TimeStep::fixed;
    s.dt = number("dt");
  }

  Material material;
  if (a["snow"] == "dry") {
    material.youngs_modulus = 2e5;
    material.critical_compression = 0.03;
    material.critical_stretch = 0.005;
  }
  if (number("youngs_modulus") > 0) material.youngs_modulus = number("youngs_modulus");
  if (a["model"] == "corotated") material.model = laws::model::corotated;
  Body ball;
  ball.shape.form = Sphere{{0, radius + 0.02, 0}, radius};
  const Vec3d velocity(0.5, -number("speed"), 0);
  const SeededBody seeded =
      seed_body(ball, 0, static_cast<std::uint64_t>(number("seed")), s.cell_size);
  const double mass = material.density * seeded.volume / static_cast<double>(seeded.x.size());
  ParticleArrays particles;
  for (const Vec3d& x_p : seeded.x) {
    particles.x.push_back(x_p);
    particles.v.push_back(velocity);
    particles.m.push_back(mass);
  }
  Collider floor;
  floor.shape.form = Plane{};
  floor.friction = 0.5;
  return Simulation(s, {material}, {floor}, particles, 1);
}

void print_state(const Simulation& simulation, double dt_min, double dt_max, const char* limit) {
  const Summary sum = simulation.summary();
  const ParticleArrays p = simulation.particles();
  const auto count = static_cast<double>(p.x.size());
  double spread = 0, J_P = 0, torn = 0, packed = 0;
  std::vector<double> height;
  for (std::size_t q = 0; q < p.x.size(); ++q) {
    const Vec3d r = p.x[q] - sum.centre_of_mass;
    spread += r.x() * r.x() + r.z() * r.z();
    J_P += p.J_P[q];
    torn += p.J_P[q] > 1.1;
    packed += p.J_P[q] < 0.9;
    height.push_back(p.x[q].y());
  }
  const auto top = height.begin() + static_cast<std::ptrdiff_t>(0.98 * count);
  std::nth_element(height.begin(), top, height.end());
  std::printf("%.4f %zu %.3g %.3g %s ", simulation.time(), simulation.steps(), dt_min, dt_max,
              limit);
  std::printf("%.6g %.6g %.6g %.6g ", sum.centre_of_mass.x(), sum.centre_of_mass.y(),
              std::sqrt(spread / count), *top);
  std::printf("%.5g %.5g %.5g %.5g %.5g ", sum.min_J_P, J_P / count, sum.max_J_P, torn / count,
              packed / count);
  std::printf("%.6g %.6g\n", sum.kinetic_energy, sum.elastic_energy);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a{{"snow", "paper"},
              {"n", "8"},
              {"transfer", "flip"},
              {"acoustic_cfl", "0.5"},
              {"flip_reference_dt", "5e-4"},
              {"seed", "1"},
              {"speed", "5"},
              {"youngs_modulus", ""},
              {"model", "snow"},
              {"beta", "0"},
              {"dt", "0"},
              {"max_dt", "1e-3"},
              {"contact_at", "particles"},
              {"collide_after_solve", "0"},
              {"solve_tolerance", "1e-2"},
              {"time", "0.125"}};
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || !a.count(word.substr(0, equals))) {
      std::fprintf(stderr, "impact: error: cannot use %s\n", argv[i]);
      return 2;
    }
    a[word.substr(0, equals)] = word.substr(equals + 1);
  }
  Simulation simulation = make_simulation(a);
  std::printf(
      "# time steps dt_min dt_max limit x y spread height min_J_P mean_J_P max_J_P torn "
      "packed kinetic elastic\n");
  const int lines = static_cast<int>(std::lround(std::atof(a["time"].c_str()) * lines_per_second));
  const std::clock_t start = std::clock();
  SolveReport solve;
  double rise = 0;  // m/s, the fastest of the centre of mass
  for (int line = 0; line <= lines; ++line) {
    const AdvanceReport report = simulation.advance_to(line / lines_per_second);
    if (report.solve) solve.add(*report.solve);
    const Summary sum = simulation.summary();
    rise = std::max(rise, sum.momentum.y() / sum.mass);
    if (line == lines)
      std::printf(
          "# rise %.3g m/s, at worst %d iterations to %.2g, %zu cut short, %zu given up, "
          "%.3g s\n",
          rise, solve.iterations, solve.residual, simulation.warnings().solves_cut_short,
          simulation.warnings().solves_given_up,
          static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    print_state(simulation, report.dt_min, report.dt_max,
                report.steps == 0 ? "-" : name(report.limit()));
    if (!simulation.divergence()) continue;
    std::printf("# diverged: %s\n", simulation.divergence()->sentence.c_str());
    return 5;
  }
}
