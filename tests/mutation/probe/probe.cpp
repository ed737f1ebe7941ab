/// Runs the self-tests and two scenes under the watch, and prints which checks fired, as JSON.
///   probe --dt SECONDS   the first scene only, with this step
///   probe --asflip       with that transfer
/// Scene A throws a snowball on a sticky floor, scene B spins an elastic box in free flight: some
/// mistakes show only in what turns.

#include <cstdlib>
#include <exception>
#include <iostream>
#include <set>
#include <string>

#include "sim/checks/self_test.h"
#include "sim/checks/self_test_bodies.h"
#include "sim/checks/watch.h"
#include "sim/laws/list.h"

namespace {

using namespace neve::sim;

struct Scene {
  SolverSettings settings;
  Material material;
  std::vector<shapes::Collider> colliders;
  ParticleArrays particles;
  int steps = 0;
};

void add(Scene& scene, const Vec3d& x, const Vec3d& v, double m) {
  scene.particles.x.push_back(x);
  scene.particles.v.push_back(v);
  scene.particles.m.push_back(m);
}

SolverSettings settings(double dt, Transfer transfer) {
  SolverSettings s;
  s.transfer = transfer;
  s.cell_size = 0.05;
  s.precision = Precision::real64;
  s.time_step = TimeStep::fixed;
  s.dt = dt;
  return s;
}

Scene drop(double dt, Transfer transfer) {
  constexpr double radius = 0.14, pi = 3.14159265358979;
  constexpr int count = 300;
  Scene scene;
  scene.settings = settings(dt, transfer);
  scene.material.max_J_P = 1e4;  // snow that a mistake tears shows
  scene.steps = 400;
  shapes::Collider floor;
  floor.shape.form = shapes::Plane{{0, 0, 0}, {0, 1, 0}};
  floor.contact = shapes::Contact::sticky;
  scene.colliders.push_back(floor);
  checks::self_test::Numbers number(7);
  while (scene.particles.x.size() < count) {
    const Vec3d x = number.vector();
    if (x.norm() < 1)
      add(scene, radius * x + Vec3d(0, 0.16, 0), {0.5, -5, 0},
          400 * 4 * pi / 3 * radius * radius * radius / count);
  }
  return scene;
}

Scene spin(Transfer transfer) {
  constexpr int count = 220;
  const Vec3d half(0.16, 0.1, 0.08), omega(2, 1, 8);
  Scene scene;
  scene.settings = settings(1e-3, transfer);
  scene.settings.gravity.setZero();
  scene.steps = 600;
  scene.material.model = laws::model::corotated;
  scene.material.youngs_modulus = 2e4;
  checks::self_test::Numbers number(8);
  for (int p = 0; p < count; ++p) {
    const Vec3d x = number.vector().cwiseProduct(half);
    const Vec3d v(omega[1] * x[2] - omega[2] * x[1], omega[2] * x[0] - omega[0] * x[2],
                  omega[0] * x[1] - omega[1] * x[0]);
    add(scene, x, v, 400 * 8 * half.prod() / count);
  }
  return scene;
}

/// Checks that fired, in their order; "stopped" last: a rule of every run.
std::vector<std::string> watch(const Scene& scene) {
  std::vector<std::string> fired;
  bool has_stopped = false;
  checks::Watch watch(scene.settings, {scene.material});
  try {
    Simulation simulation(scene.settings, {scene.material}, scene.colliders, scene.particles, 1);
    for (int step = 0; step < scene.steps && !has_stopped; ++step) {
      if (step < 3 || step % 20 == 0) watch.look(simulation);
      simulation.step(scene.settings.dt);
      has_stopped = simulation.divergence().has_value();
    }
    if (has_stopped) watch.look(simulation);
  } catch (const std::exception& error) {
    has_stopped = true;
    std::cerr << error.what() << "\n";
  }
  for (const checks::WatchRecord& record : watch.records())
    if (record.times > 0) fired.push_back(checks::name(record.check));
  if (has_stopped) fired.push_back("stopped");
  return fired;
}

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return "[" + text + "]";
}

std::vector<std::string> failed_self_tests(Transfer transfer) {
  const checks::SelfTestCase one[] = {{Kernel::cubic, transfer, Precision::real64}};
  std::vector<std::string> failed;
  for (const checks::SelfTestResult& result : checks::self_tests(one)) {
    if (result.passed) continue;
    failed.push_back(result.name);
    std::cerr << result.name << ": " << result.detail << "\n";
  }
  return failed;
}

}  // namespace

int main(int argc, char** argv) {
  const bool has_dt = argc == 3 && std::string(argv[1]) == "--dt";
  const double dt = has_dt ? std::atof(argv[2]) : 1e-4;
  const bool is_asflip = argc == 2 && std::string(argv[1]) == "--asflip";
  const Transfer transfer = is_asflip ? Transfer::asflip : Transfer::flip;
  std::cout << "{\"self_tests\": " << list(failed_self_tests(transfer))
            << ", \"drop\": " << list(watch(drop(dt, transfer)))
            << ", \"spin\": " << (has_dt ? "[]" : list(watch(spin(transfer)))) << "}\n";
}
