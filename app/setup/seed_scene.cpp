#include "app/setup/seed_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "app/scene/toml/value.h"
#include "app/setup/snow_pieces.h"
#include "sim/base/hash.h"
#include "sim/kernels/blocks.h"
#include "sim/shapes/variation.h"

namespace neve::app::setup {

namespace {

/// Apart from the keys of places.
constexpr std::uint64_t variation_key = 0x76617279;

/// Factors of the particles that were appended last, but for what their file says: snow that
/// continues has had them. They are left out while all are 1.
void vary_body(const scene::Scene& scene, std::size_t index, const sim::seeding::SeededBody& seeded,
               sim::ParticleArrays& particles) {
  const std::size_t material = material_index(scene, scene.bodies[index].material);
  const sim::Variation& variation = scene.materials[material].variation;
  const bool is_varied = variation.youngs_modulus > 0 || variation.thresholds > 0;
  const std::size_t end = particles.x.size(), first = end - seeded.x.size();
  if (is_varied || !particles.stiffness.empty()) {
    particles.stiffness.resize(end, 1.0);
    particles.threshold.resize(end, 1.0);
  }
  if (!is_varied && variation.density == 0) return;
  const std::uint64_t key = mix64(mix64(scene.seed, variation_key), index);
  for (std::size_t p = first; p < end; ++p) {
    const sim::shapes::Factors factors =
        sim::shapes::vary(variation, key, p - first, particles.x[p] - seeded.center);
    if (seeded.m.empty()) particles.m[p] *= factors.density;
    if (!is_varied) continue;
    if (seeded.stiffness.empty()) particles.stiffness[p] = factors.stiffness;
    if (seeded.threshold.empty()) particles.threshold[p] = factors.threshold;
  }
}

/// Appends values of the last particles, or that of their body where there are none; the list stays
/// empty while all have the usual value.
template <class T>
void append_or_default(const std::vector<T>& values, const T& usual, const T& of_body,
                       std::size_t first, std::size_t end, std::vector<T>& all) {
  if (values.empty() && all.empty() && of_body == usual) return;
  all.resize(first, usual);
  all.insert(all.end(), values.begin(), values.end());
  all.resize(end, of_body);
}

void multiply(const std::vector<double>& factors, std::size_t first, std::size_t end,
              std::vector<double>& all) {
  if (factors.empty()) return;
  all.resize(end, 1.0);
  for (std::size_t p = first; p < end; ++p) all[p] *= factors[p - first];
}

/// Appends what the snow of a file has been through, for the particles that were appended last.
void append_history(const sim::seeding::SeededBody& seeded, double J_P,
                    sim::ParticleArrays& particles) {
  const std::size_t end = particles.x.size(), first = end - seeded.x.size();
  const sim::Mat3d rest = sim::Mat3d::Identity(), still = sim::Mat3d::Zero();
  append_or_default(seeded.J_P, 1.0, J_P, first, end, particles.J_P);
  append_or_default(seeded.F_E, rest, rest, first, end, particles.F_E);
  append_or_default(seeded.C, still, still, first, end, particles.C);
  multiply(seeded.stiffness, first, end, particles.stiffness);
  multiply(seeded.threshold, first, end, particles.threshold);
  if (particles.stiffness.size() != particles.threshold.size()) {
    particles.stiffness.resize(end, 1.0);
    particles.threshold.resize(end, 1.0);
  }
}

/// Particles of a body, within the lattice. @throws sim::ShapeError that names the body
sim::seeding::SeededBody seed_checked(const scene::Scene& scene, std::size_t index) {
  const sim::seeding::Body& body = scene.bodies[index];
  const std::string at = "body." + body.name + ".shape: ";
  const double h = scene.solver.cell_size, limit = h * (4.0 * sim::kernels::block_limit - 8);
  sim::seeding::SeededBody seeded;
  try {
    seeded = sim::seeding::seed_body(body, index, scene.seed, h);
  } catch (const sim::ShapeError& error) {
    throw sim::ShapeError(at + error.what());
  }
  for (const sim::Vec3d& x : seeded.x)
    if (!(x.cwiseAbs().maxCoeff() <= limit))
      throw sim::ShapeError(at + "a particle is more than " + scene::toml::number_text(limit) +
                            " m from the origin, where the lattice ends; move it closer or enlarge "
                            "solver.cell_size");
  return seeded;
}

}  // namespace

std::size_t material_index(const scene::Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                  [&](const sim::Material& m) { return m.name == name; });
  if (found == scene.materials.end()) throw std::logic_error("no material is called " + name);
  return static_cast<std::size_t>(found - scene.materials.begin());
}

void append_body(const scene::Scene& scene, std::size_t index, sim::ParticleArrays& particles) {
  const sim::seeding::Body& body = scene.bodies[index];
  const sim::seeding::SeededBody seeded = seed_checked(scene, index);
  const std::size_t material = material_index(scene, body.material);
  const double share = seeded.volume / static_cast<double>(seeded.x.size());
  // The density on the grid says nothing about the volume before a deformation.
  const bool is_given =
      body.volumes == sim::seeding::Volumes::given || !seeded.J_P.empty() || !seeded.F_E.empty();
  for (std::size_t p = 0; p < seeded.x.size(); ++p) {
    const sim::Vec3d& x_p = seeded.x[p];
    const double volume = seeded.V.empty() ? share : seeded.V[p];
    sim::Vec3d v_p = body.velocity + body.angular_velocity.cross(x_p - seeded.center);
    if (!seeded.v.empty()) v_p += seeded.v[p];
    particles.x.push_back(x_p);
    particles.v.push_back(v_p);
    // A share of the body's space is a volume as it is now; columns of volumes are of the snow
    // before it was packed or loosened.
    const double J_P = seeded.J_P.empty() ? body.J_P : seeded.J_P[p];
    const double V0 = seeded.V.empty() ? volume / J_P : volume;
    particles.m.push_back(seeded.m.empty() ? scene.materials[material].density * V0 : seeded.m[p]);
    particles.V0.push_back(is_given ? V0 : 0.0);
    particles.material.push_back(static_cast<int>(material));
  }
  vary_body(scene, index, seeded, particles);
  append_history(seeded, body.J_P, particles);
}

std::vector<sim::Vec3d> own_places(const scene::Scene& scene, const SeededScene& seeded,
                                   std::size_t body) {
  const sim::shapes::Shape& shape = scene.bodies[body].shape;
  const sim::Mat3d to_own =
      (sim::rotation_from_degrees(shape.rotation) * sim::shapes::form_axes(shape)).transpose();
  const sim::Vec3d center = sim::shapes::center(shape);
  std::vector<sim::Vec3d> places;
  for (std::size_t p = seeded.body_begin(body); p < seeded.body_end[body]; ++p)
    places.push_back(to_own * (seeded.particles.x[p] - center));
  return places;
}

std::optional<sim::Vec3d> snow_centre(const SeededScene& seeded, std::size_t body,
                                      const sim::ParticleArrays& particles) {
  const std::size_t first = particles.first_from(seeded.body_begin(body)),
                    end = particles.first_from(seeded.body_end[body]);
  sim::Vec3d moment = sim::Vec3d::Zero();
  double mass = 0;
  for (std::size_t p = first; p < end; ++p) {
    if (!particles.x[p].allFinite()) continue;
    moment += particles.m[p] * particles.x[p];
    mass += particles.m[p];
  }
  if (!(mass > 0)) return std::nullopt;
  return sim::Vec3d(moment / mass);
}

sim::Simulation make_simulation(const scene::Scene& scene, const sim::ParticleArrays& particles,
                                int threads) {
  return sim::Simulation(scene.solver, scene.materials, scene::sim_colliders(scene), particles,
                         threads, sim::Vec3i::Zero(), flow_of(scene));
}

SeededScene seed_scene(const scene::Scene& scene) {
  SeededScene seeded;
  for (std::size_t index = 0; index < scene.bodies.size(); ++index) {
    append_body(scene, index, seeded.particles);
    seeded.body_end.push_back(seeded.particles.x.size());
    const auto centre = snow_centre(seeded, index, seeded.particles);
    seeded.body_start.push_back(centre.value_or(sim::shapes::center(scene.bodies[index].shape)));
  }
  double volume = 0;
  for (const SnowPiece& piece : snow_pieces(scene)) volume += piece.volume;
  const double count = static_cast<double>(seeded.particles.x.size()) +
                       planned_emission(scene, scene::duration(scene));
  seeded.planned = static_cast<std::size_t>(count);
  seeded.spacing = std::cbrt(volume / std::max(1.0, count));
  return seeded;
}

}  // namespace neve::app::setup
