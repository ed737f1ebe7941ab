#include "app/card/stage.h"

#include <algorithm>
#include <cmath>

#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"

namespace neve::app::card {

namespace {

/// Steps times particles, some seconds: an experiment that takes more is stopped, and shows what it
/// has seen.
constexpr std::size_t max_work = 80'000'000;

}  // namespace

scene::Scene empty_stage(const Subject& subject, double cell_size) {
  scene::Scene stage;
  stage.seed = subject.seed;
  stage.materials = {subject.material};
  stage.solver = subject.solver;
  stage.solver.cell_size = cell_size;
  stage.solver.threshold_cell = 0;
  stage.solver.beta = 0;
  stage.solver.time_step = sim::TimeStep::adaptive;
  stage.solver.on_divergence = sim::OnDivergence::stop;
  stage.solver.bypass.clear();
  return stage;
}

void add_body(scene::Scene& stage, const sim::shapes::Shape& shape,
              sim::seeding::Sampling sampling) {
  sim::seeding::Body body;
  body.name = "snow";
  body.material = stage.materials.front().name;
  body.shape = shape;
  body.sampling = sampling;
  if (sampling == sim::seeding::Sampling::lattice) body.volumes = sim::seeding::Volumes::given;
  stage.bodies.push_back(body);
}

void add_plane(scene::Scene& stage, const std::string& name, const sim::Vec3d& point,
               const sim::Vec3d& normal, sim::shapes::Contact contact) {
  scene::Collider plane;
  plane.name = name;
  plane.shape.form = sim::shapes::Plane{point, normal};
  plane.contact = contact;
  stage.colliders.push_back(plane);
}

sim::Simulation simulation_of(const scene::Scene& stage) {
  return setup::make_simulation(stage, setup::seed_scene(stage).particles, 1);
}

bool advance(sim::Simulation& simulation, double time, Experiment& experiment,
             sim::AdvanceReport* report) {
  const std::size_t max_steps = max_work / std::max<std::size_t>(1, simulation.particle_count());
  const sim::AdvanceReport made = simulation.advance_to(
      time, [] { return is_interrupted(); }, max_steps);
  if (report) *report = made;
  if (is_interrupted()) throw Error(exit_interrupted, "interrupted; no card was written");
  if (simulation.divergence())
    experiment.failure = "it diverged by the rule " + simulation.divergence()->rule;
  else if (simulation.time() < time)
    experiment.failure = "stiff: stopped after " + rough_text(simulation.time()) + " s";
  return experiment.failure.empty();
}

void withdraw(Experiment& experiment) {
  for (Measure& measure : experiment.measures) measure.value = NAN;
  experiment.words.clear();
}

void show(const sim::Simulation& simulation, scene::Scene stage, Experiment& experiment) {
  stage.views = {scene::View{}};
  stage.views.front().layers = {scene::Layer::ground, scene::Layer::colliders,
                                scene::Layer::particles};
  experiment.seeded.spacing = stage.solver.cell_size / std::cbrt(8.0);
  experiment.shown = picture::take_snapshot(stage, stage.views, simulation, 0);
  experiment.stage = std::move(stage);
}

void look(scene::Scene& stage, const sim::Vec3d& eye, const sim::Vec3d& target,
          const sim::Vec3d& up) {
  stage.camera.emplace();
  stage.camera->eye = eye;
  stage.camera->target = target;
  stage.camera->up = up;
}

}  // namespace neve::app::card
