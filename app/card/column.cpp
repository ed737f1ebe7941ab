#include <algorithm>
#include <cmath>
#include <numeric>
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

/// s, of a bar that stands on its end and swings along its height.
double period_of(const sim::Material& m) {
  return 4 * column_height / std::sqrt(m.youngs_modulus / m.density);
}

}  // namespace

int swing_samples(double period, double sample) {
  return static_cast<int>(std::clamp(period / sample, 1.0, 60.0));
}

double mean_of_last(const std::vector<double>& values, int samples) {
  const auto count = std::min(values.size(), static_cast<std::size_t>(samples));
  return std::accumulate(values.end() - static_cast<std::ptrdiff_t>(count), values.end(), 0.0) /
         static_cast<double>(count);
}

Experiment column(const Subject& subject) {
  constexpr double sample_time = 0.05, at_rest = 0.02;  // s, m/s
  constexpr int fewest = 10, usual = 30;
  const int swing = swing_samples(period_of(subject.material), sample_time);
  const int samples = std::max(usual, 2 * swing);
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
  std::vector<double> heights{first.height};
  e.x.push_back(0);
  e.y.push_back(first.radius);
  for (int k = 1, calm = 0; k <= samples; ++k) {
    const double time = sample_time * k;
    if (!advance(simulation, time, e)) break;
    const Pile pile = pile_of(simulation.particles().x);
    e.x.push_back(time);
    e.y.push_back(pile.radius);
    heights.push_back(pile.height);
    const sim::Summary now = simulation.summary();
    // A pile that swings stands still where it turns.
    calm = std::sqrt(2 * now.kinetic_energy / now.mass) < at_rest ? calm + 1 : 0;
    if (k >= fewest && calm >= swing) break;
  }
  look(stage, {2.1, 1.3, 3.2}, {0, 0.28, 0});
  show(simulation, stage, e);
  const double growth = mean_of_last(e.y, swing) / first.radius;
  e.measures = {{"run_out", growth - 1}, {"height", mean_of_last(heights, swing) / first.height}};
  const bool stands = growth < 1.05 && e.measures[1].value > 0.9, sags = growth < 1.2;
  e.words.push_back((stands ? "stands"
                     : sags ? "sags, " + rough_text(growth) + " times as wide"
                            : "runs out to " + rough_text(growth) + " times its radius"));
  e.words.push_back("keeps " + rough_text(100 * e.measures[1].value) + " % of its height");
  if (!e.failure.empty()) withdraw(e);
  return e;
}

}  // namespace neve::app::card
