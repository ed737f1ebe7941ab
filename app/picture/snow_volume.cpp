#include "app/picture/snow_volume.h"

#include <Eigen/LU>
#include <algorithm>

namespace neve::app::picture {

namespace {

/// Volume of the loosest snow that is a solid, over its volume at rest: a share of the surface's
/// level is left of it then.
constexpr double loosest = 2;

}  // namespace

double snow_volume(const scene::Scene& scene, const sim::ParticleArrays& particles, std::size_t p) {
  const double J = particles.F_E[p].determinant() * particles.J_P[p];
  const double at_rest = particles.m[p] / scene.materials[particles.material[p]].density;
  return at_rest * std::min(J, loosest);
}

}  // namespace neve::app::picture
