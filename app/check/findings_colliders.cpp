/// What can be found about colliders before a run.

#include <algorithm>
#include <memory>

#include "app/check/findings.h"
#include "app/text.h"
#include "sim/solid.h"

namespace neve::app {

namespace {

using sim::Vec3d;

/// Whether a place is in a collider at the start.
class Inside {
 public:
  explicit Inside(const sim::Collider& collider)
      : pose_(sim::pose_at(collider, 0)),
        start_(sim::rotation_from_degrees(collider.shape.rotation)),
        center_(sim::center(collider.shape)) {
    if (const auto* plane = std::get_if<sim::Plane>(&collider.shape.form))
      normal_ = pose_.rotation * plane->normal;
    else
      solid_ = std::make_unique<sim::Solid>(collider.shape);
  }

  bool operator()(const Vec3d& x) const {
    if (!solid_) return (x - pose_.point).dot(normal_) < 0;
    // Keyframes may have moved it: where the place is from the shape as it is written.
    return solid_->contains(center_ + start_ * (pose_.rotation.transpose() * (x - pose_.point)));
  }

 private:
  sim::Pose pose_;
  sim::Mat3d start_;
  Vec3d center_, normal_{0, 1, 0};
  std::unique_ptr<sim::Solid> solid_;
};

}  // namespace

void check_collider_overlaps(const Scene& scene, const sim::ParticleArrays& particles,
                             const std::vector<std::size_t>& body_end,
                             std::vector<Finding>& findings) {
  for (const sim::Collider& collider : scene.colliders) {
    const Inside is_inside(collider);
    std::size_t first = 0;
    for (std::size_t body = 0; body < body_end.size(); ++body) {
      std::size_t inside = 0;
      for (std::size_t p = first; p < body_end[body]; ++p) inside += is_inside(particles.x[p]);
      const double count = static_cast<double>(body_end[body] - first);
      first = body_end[body];
      if (inside == 0) continue;
      findings.push_back({Severity::warning, "body." + scene.bodies[body].name + ".shape",
                          percent_text(static_cast<double>(inside) / count) + " of " +
                              called("body", scene.bodies[body].name) + " starts inside " +
                              "collider " + collider.name,
                          "move it out: contact stops snow at surfaces, it does not push it out "
                          "(solver.push_out does, and leaves it crushed)"});
    }
  }
}

void check_motion(const Scene& scene, const Checkup& checkup, std::vector<Finding>& findings) {
  const sim::SolverSettings& s = scene.solver;
  const double dt = s.time_step == sim::TimeStep::fixed ? s.dt : s.max_dt;
  for (const sim::Collider& collider : scene.colliders) {
    const double speed = sim::largest_speed(collider), cells = speed * dt / s.cell_size;
    const double c = checkup.start.max_sound_speed;
    const bool spins = collider.velocity.norm() < 0.5 * speed;
    const std::string at = "collider." + collider.name +
                           (!collider.keyframes.empty() ? ".keyframes"
                            : spins                     ? ".angular_velocity"
                                                        : ".velocity");
    if (cells > 0.5)
      findings.push_back(
          {Severity::warning, at,
           called("collider", collider.name) + " moves up to " + rough_text(speed) +
               " m/s: " + rough_text(cells) + " cells in a step, it runs over snow at rest",
           std::string(s.time_step == sim::TimeStep::fixed ? "solver.dt" : "solver.max_dt") +
               " = " + rough_text(0.4 * s.cell_size / speed)});
    else if (c > 0 && speed > c)
      findings.push_back({Severity::warning, at,
                          called("collider", collider.name) + " moves up to " + rough_text(speed) +
                              " m/s, faster than sound in the snow (" + rough_text(c) +
                              " m/s): it crushes what it hits",
                          "slower, or a larger youngs_modulus"});
  }
}

}  // namespace neve::app
