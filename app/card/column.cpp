#include <algorithm>
#include <cmath>
#include <utility>

#include "app/card/falls.h"
#include "app/support/text.h"

namespace neve::app::card {

namespace {

constexpr double column_radius = 0.4, column_height = 0.8, column_cell = column_radius / 6;  // m

/// The value that a share of all is below.
double below_which(std::vector<double> values, double share) {
  const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Pile {
  double radius, height;  ///< m, of 98 % of the snow
};

Pile pile_of(const std::vector<sim::Vec3d>& x) {
  std::vector<double> radius, height;
  for (const sim::Vec3d& x_p : x) {
    radius.push_back(std::hypot(x_p.x(), x_p.z()));
    height.push_back(x_p.y());
  }
  return {below_which(std::move(radius), 0.98), below_which(std::move(height), 0.98)};
}

}  // namespace

Experiment column(const Subject& subject) {
  constexpr double duration = 1.5, at_rest = 0.02;  // s, m/s
  constexpr int samples = 30, fewest = 10;
  Experiment e;
  e.kind = Kind::column;
  scene::Scene stage = empty_stage(subject, column_cell);
  stage.solver.gravity = {0, -9.81, 0};
  stage.solver.max_dt = 5e-3;
  add_body(stage, {sim::shapes::Cylinder{{0, column_height / 2, 0}, column_radius, column_height}},
           sim::seeding::Sampling::jittered);
  add_plane(stage, "floor", {0, 0, 0}, {0, 1, 0}, sim::shapes::Contact::separate);
  sim::Simulation simulation = simulation_of(stage);
  const Pile first = pile_of(simulation.particles().x);
  Pile last = first;
  e.x.push_back(0);
  e.y.push_back(first.radius);
  for (int k = 1; k <= samples; ++k) {
    const double time = duration * k / samples;
    if (!advance(simulation, time, e)) break;
    last = pile_of(simulation.particles().x);
    e.x.push_back(time);
    e.y.push_back(last.radius);
    const sim::Summary now = simulation.summary();
    if (k >= fewest && std::sqrt(2 * now.kinetic_energy / now.mass) < at_rest) break;
  }
  look(stage, {2.1, 1.3, 3.2}, {0, 0.28, 0});
  show(simulation, stage, e);
  e.measures = {{"run_out", last.radius / first.radius - 1},
                {"height", last.height / first.height}};
  const bool stands = e.measures[0].value < 0.05 && e.measures[1].value > 0.9;
  e.words.push_back(stands ? "stands"
                           : "runs out to " + rough_text(last.radius / first.radius) +
                                 " times its radius");
  e.words.push_back("keeps " + rough_text(100 * e.measures[1].value) + " % of its height");
  if (!e.failure.empty()) withdraw(e);
  return e;
}

}  // namespace neve::app::card
