#include "app/bench/bench_case.h"

#include <algorithm>
#include <cmath>

#include "sim/base/hash.h"

namespace neve::app::bench {

namespace {

constexpr int particles_a_cell = 8;
constexpr double squeeze = 8;  // 1/s

struct MethodInfo {
  const char* name;
  sim::Transfer transfer;
  sim::Kernel kernel;
};
/// The methods, in the order of BenchMethod.
constexpr MethodInfo methods[] = {{"mls_quadratic", sim::Transfer::mls, sim::Kernel::quadratic},
                                  {"flip_cubic", sim::Transfer::flip, sim::Kernel::cubic},
                                  {"apic_cubic", sim::Transfer::apic, sim::Kernel::cubic},
                                  {"asflip_cubic", sim::Transfer::asflip, sim::Kernel::cubic}};

void append_particle(const sim::Vec3d& x, const sim::Vec3d& middle, BenchCase& to) {
  const double h = to.settings.cell_size, V0 = h * h * h / particles_a_cell;
  to.particles.x.push_back(x);
  to.particles.v.push_back(-squeeze * (x - middle));
  to.particles.V0.push_back(V0);
  to.particles.m.push_back(to.material.density * V0);
}

}  // namespace

const char* name(BenchMethod method) {
  return methods[static_cast<std::size_t>(method)].name;
}

sim::SolverSettings bench_settings(BenchMethod method, sim::Precision precision) {
  sim::SolverSettings s;
  s.cell_size = 0.01;
  s.time_step = sim::TimeStep::fixed;
  s.dt = 1e-4;
  s.shock_viscosity = 0;  // the naive code has none
  s.precision = precision;
  s.transfer = methods[static_cast<std::size_t>(method)].transfer;
  s.kernel = methods[static_cast<std::size_t>(method)].kernel;
  return s;
}

BenchCase packed_case(int cells_a_side, BenchMethod method, sim::Precision precision) {
  BenchCase c{bench_settings(method, precision), {}, {}};
  const double spacing = 0.5 * c.settings.cell_size;
  const sim::Vec3d middle = sim::Vec3d::Constant(cells_a_side * spacing);
  for (int i = 0; i < 2 * cells_a_side; ++i)
    for (int j = 0; j < 2 * cells_a_side; ++j)
      for (int k = 0; k < 2 * cells_a_side; ++k)
        append_particle(spacing * sim::Vec3d(i + 0.5, j + 0.5, k + 0.5), middle, c);
  return c;
}

BenchCase spray_case(int particles_a_side, double cells_apart, SprayPlaces places,
                     BenchMethod method, sim::Precision precision) {
  BenchCase c{bench_settings(method, precision), {}, {}};
  const double spacing = cells_apart * c.settings.cell_size, side = particles_a_side * spacing;
  const sim::Vec3d middle = sim::Vec3d::Constant(0.5 * side);
  const auto n = static_cast<std::uint64_t>(particles_a_side);
  for (std::uint64_t q = 0; q < n * n * n; ++q) {
    const auto at = [&](std::uint64_t axis, std::uint64_t k) {
      return places == SprayPlaces::at_random ? side * unit_double(mix64(3 * q + axis))
                                              : spacing * (static_cast<double>(k) + 0.5);
    };
    append_particle({at(0, q / n / n), at(1, q / n % n), at(2, q % n)}, middle, c);
  }
  return c;
}

BenchCase stream_case(int cells_a_side, BenchMethod method, bool flows) {
  BenchCase c = packed_case(cells_a_side, method, sim::Precision::single);
  const double h = c.settings.cell_size, side = cells_a_side * h;
  const sim::Vec3d velocity(0, -0.1 * h / c.settings.dt, 0);
  c.settings.gravity.setZero();
  std::fill(c.particles.v.begin(), c.particles.v.end(), velocity);
  if (!flows) return c;
  c.material.name = "snow";
  sim::seeding::Emitter above;
  above.material = c.material.name;
  above.shape.form = sim::shapes::Box{{0.5 * side, side + 0.5 * h, 0.5 * side}, {side, h, side}};
  above.velocity = velocity;
  above.rate = c.material.density * side * side * velocity.norm();
  sim::seeding::Sink below;
  below.shape.form =
      sim::shapes::Box{{0.5 * side, -side, 0.5 * side}, {4 * side, 2 * side, 4 * side}};
  c.flow.emitters.push_back(above);
  c.flow.sinks.push_back(below);
  return c;
}

BenchCase plate_case(int cells_a_side, BenchMethod method, bool moves) {
  BenchCase c = packed_case(cells_a_side, method, sim::Precision::single);
  const double h = c.settings.cell_size, side = cells_a_side * h, thickness = 4 * h;
  // Squeezed towards the middle of its foot.
  for (sim::Vec3d& v : c.particles.v) v.y() -= 0.5 * side * squeeze;
  sim::shapes::Collider plate;
  plate.shape.form =
      sim::shapes::Box{{0.5 * side, -0.5 * thickness, 0.5 * side}, {side, thickness, side}};
  if (moves) plate.body.density = c.material.density * side / thickness;
  c.colliders.push_back(plate);
  return c;
}

int packed_cells_a_side(double particles) {
  return std::max(1, static_cast<int>(std::lround(std::cbrt(particles / particles_a_cell))));
}

}  // namespace neve::app::bench
