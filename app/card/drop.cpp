#include <algorithm>
#include <cmath>

#include "app/card/falls.h"
#include "app/record/metrics.h"
#include "app/support/text.h"

namespace neve::app::card {

Experiment drop(const Subject& subject) {
  constexpr double cell = 0.03, radius = 0.15, speed = 4;  // m, m, m/s
  constexpr int samples = 30;
  constexpr double duration = 0.5;  // s
  // A ball that swings between long and flat, the slowest of its ways: 2 pi R / (2.65 c).
  const sim::Material& m = subject.material;
  const double shear_sound = std::sqrt(sim::lame(m.youngs_modulus, m.poisson_ratio).mu / m.density);
  const int swing =
      std::min(samples / 2, swing_samples(2.37 * radius / shear_sound, duration / samples));
  Experiment e;
  e.kind = Kind::drop;
  scene::Scene stage = empty_stage(subject, cell);
  stage.solver.gravity = {0, -9.81, 0};
  add_body(stage, {sim::shapes::Sphere{{0, radius + 0.5 * cell, 0}, radius}},
           sim::seeding::Sampling::jittered);
  stage.bodies.front().velocity = {0, -speed, 0};
  add_plane(stage, "floor", {0, 0, 0}, {0, 1, 0}, sim::shapes::Contact::separate);
  sim::Simulation simulation = simulation_of(stage);
  const record::Metrics first = record::measure(simulation.particles(), stage);
  record::Metrics last = first;
  std::vector<double> heights{first.height};
  e.x.push_back(0);
  e.y.push_back(first.spread);
  for (int k = 1; k <= samples; ++k) {
    const double time = duration * k / samples;
    if (!advance(simulation, time, e)) break;
    last = record::measure(simulation.particles(), stage);
    e.x.push_back(time);
    e.y.push_back(last.spread);
    heights.push_back(last.height);
  }
  look(stage, {0.85, 0.5, 1.2}, {0, 0.06, 0});
  show(simulation, stage, e);
  const bool has_broken = record::has_broken(first, last).value_or(false);
  const double spread = mean_of_last(e.y, swing);
  e.measures = {{"spread", spread},
                {"height", mean_of_last(heights, swing)},
                {"largest_piece", last.largest_fragment},
                {"powder", last.powder},
                {"mean_J_P", last.mean_J_P}};
  const double growth = spread / first.spread;
  // Crumbs that lie in a heap touch in cells of this size, and are loose: snow that is squashed is
  // packed by it.
  constexpr double wide = 1.5, loose = 1.2;
  e.words.push_back(has_broken              ? "bursts"
                    : growth <= wide        ? "stays a ball"
                    : last.mean_J_P > loose ? "crumbles into a heap"
                                            : "squashed, in one piece");
  e.words.push_back(rough_text(growth) + " times as wide");
  if (has_broken)
    e.words.push_back(rough_text(100 * (1 - last.largest_fragment)) + " % lies apart");
  if (!e.failure.empty()) withdraw(e);
  return e;
}

}  // namespace neve::app::card
