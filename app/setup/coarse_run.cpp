#include "app/setup/coarse_run.h"

#include <algorithm>
#include <cmath>

#include "app/scene/coarsen.h"
#include "app/setup/curves.h"
#include "app/setup/seed_scene.h"
#include "app/setup/snow_pieces.h"
#include "app/support/interrupt.h"
#include "sim/laws/law.h"

namespace neve::app::setup {

namespace {

constexpr double particles_wanted = 250;
constexpr double work_budget = 1.6e6;  // steps x particles, a fraction of a second
constexpr int moments = 24;
constexpr double max_sound_speed = 45;  // m/s at rest: stiffer snow moves the same, in more steps

/// Replacement for the scene's snow in a coarse run.
enum class Substitute {
  same,      ///< the scene's own, but for a bound on its stiffness
  uncrushed  ///< no compaction: for scenes whose coarse snow is crushed out of bounds
};

/// The scene with few and large cells, and steps as long as are stable.
scene::Scene coarsened(const scene::Scene& scene, Substitute substitute) {
  scene::Scene coarse = scene::without_dust(scene);
  coarse.solver.precision = sim::Precision::single;
  coarse.solver.time_step = sim::TimeStep::adaptive;
  coarse.solver.max_dt = std::max(scene.solver.max_dt, 2e-3);
  coarse.solver.acoustic_cfl = 0.9;
  coarse.solver.beta = 0;  // softened as it is below, explicit steps do it
  const double growth = std::max(1.0, planned_particles(scene) / particles_wanted);
  coarse.solver.cell_size *= std::cbrt(growth);
  for (sim::seeding::Body& body : coarse.bodies)
    if (auto* points = std::get_if<sim::shapes::Points>(&body.shape.form))
      points->thinning *= growth;
  for (sim::Material& material : coarse.materials) {
    const double c = sim::sound_speed(material);
    if (c > max_sound_speed) material.youngs_modulus *= max_sound_speed * max_sound_speed / (c * c);
    if (substitute == Substitute::uncrushed) {
      if (sim::laws::of(material).is_snow) material.model = sim::Model{};
      material.hardening = 0;
      material.critical_compression = 0.9;
    }
  }
  // Snow that is not crushed would bounce like rubber: pure PIC takes that energy out.
  if (substitute == Substitute::uncrushed) coarse.solver.flip_ratio = 0;
  return coarse;
}

/// Bodies too thin for the coarse cells are left out of the motion.
sim::ParticleArrays seed_what_fits(const scene::Scene& coarse) {
  sim::ParticleArrays particles;
  for (std::size_t index = 0; index < coarse.bodies.size(); ++index) {
    try {
      append_body(coarse, index, particles);
    } catch (const sim::ShapeError&) {
    }
  }
  return particles;
}

/// Removes meshes too thin for the coarse cells from the scene.
sim::Simulation coarse_simulation(scene::Scene& coarse, const sim::ParticleArrays& particles) {
  try {
    return make_simulation(coarse, particles, 1);
  } catch (const sim::ShapeError&) {
    std::erase_if(coarse.colliders, [](const scene::Collider& collider) {
      return std::holds_alternative<sim::shapes::Mesh>(collider.shape.form) ||
             std::holds_alternative<sim::shapes::MeshSequence>(collider.shape.form);
    });
    return make_simulation(coarse, particles, 1);
  }
}

/// Follows the curves of the given scene, which the coarse one is no scene of a user to have. Snow
/// is not its own here: curves of it do not fit.
class CurvesOfPlaces {
 public:
  explicit CurvesOfPlaces(const scene::Scene& scene) : given_(scene) {
    std::erase_if(given_.curves, [](const scene::Curve& curve) {
      return curve.parameter != "solver.gravity" && !curve.parameter.starts_with("collider.");
    });
  }

  void follow(double time, scene::Scene& coarse, sim::Simulation& simulation) const {
    if (given_.curves.empty()) return;
    const scene::Scene now = with_curves(given_, static_cast<int>(std::lround(time * given_.fps)));
    coarse.solver.gravity = now.solver.gravity;
    for (scene::Collider& collider : coarse.colliders)
      collider = *std::ranges::find(now.colliders, collider.name, &scene::Collider::name);
    simulation.apply(coarse.solver, coarse.materials, scene::sim_colliders(coarse));
  }

 private:
  scene::Scene given_;
};

std::vector<sim::shapes::Bounds> boxes_of_bodies(const sim::Simulation& simulation) {
  std::vector<sim::shapes::Bounds> boxes;
  for (const sim::shapes::Collider& collider : simulation.colliders())
    if (collider.body.moves()) boxes.push_back(sim::shapes::bounds_at(collider, simulation.time()));
  return boxes;
}

/// A run as far as the budget lasts, or the coarse snow holds together.
struct Run {
  std::vector<CoarseMoment> seen;
  bool is_whole = false;  ///< not cut short by a divergence
};

Run run_within_budget(const scene::Scene& scene, Substitute substitute) {
  scene::Scene coarse = coarsened(scene, substitute);
  const CurvesOfPlaces curves(scene);
  const sim::ParticleArrays particles = seed_what_fits(coarse);
  Run result;
  result.is_whole = true;
  const double emitted = planned_emission(coarse, scene::duration(coarse));
  if (particles.x.empty() && emitted == 0) return result;
  sim::Simulation simulation = coarse_simulation(coarse, particles);
  const auto note = [&](double time, const std::vector<sim::Vec3d>& x) {
    if (!x.empty()) result.seen.push_back({time, x, boxes_of_bodies(simulation)});
  };
  note(0, particles.x);
  long steps_left = std::lround(work_budget / (static_cast<double>(particles.x.size()) + emitted));
  const double duration = scene::duration(coarse);
  for (int k = 1; k <= moments && duration > 0; ++k) {
    curves.follow(duration * k / moments, coarse, simulation);
    simulation.advance_to(duration * k / moments,
                          [&] { return --steps_left <= 0 || is_interrupted(); });
    result.is_whole = !simulation.divergence();
    if (!result.is_whole) break;
    note(simulation.time(), simulation.particles().x);
    if (steps_left <= 0) break;
  }
  return result;
}

}  // namespace

double planned_particles(const scene::Scene& scene) {
  double count = 0;
  for (const SnowPiece& piece : snow_pieces(scene)) count += piece.particles;
  return count;
}

std::vector<CoarseMoment> coarse_run(const scene::Scene& scene) {
  Run first = run_within_budget(scene, Substitute::same);
  if (first.is_whole || is_interrupted()) return first.seen;
  Run second = run_within_budget(scene, Substitute::uncrushed);
  const bool is_longer = second.seen.size() > first.seen.size();
  return is_longer ? second.seen : first.seen;
}

std::vector<CoarseMoment> moments_near(const std::vector<CoarseMoment>& moments,
                                       const std::vector<double>& times) {
  constexpr double known = 1.1;  // times the last moment
  std::vector<bool> is_near(moments.size(), false);
  for (const double time : times) {
    if (moments.empty() || time > known * moments.back().time) return moments;
    const auto after =
        std::lower_bound(moments.begin(), moments.end(), time,
                         [](const CoarseMoment& moment, double t) { return moment.time < t; });
    const auto at = static_cast<std::size_t>(after - moments.begin());
    if (at < moments.size()) is_near[at] = true;
    const bool is_exact = at < moments.size() && moments[at].time - time < 1e-6;
    if (at > 0 && !is_exact) is_near[at - 1] = true;
  }
  std::vector<CoarseMoment> chosen;
  for (std::size_t k = 0; k < moments.size(); ++k)
    if (is_near[k]) chosen.push_back(moments[k]);
  return chosen;
}

}  // namespace neve::app::setup
