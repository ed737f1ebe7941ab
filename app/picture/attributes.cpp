#include "app/picture/attributes.h"

#include <Eigen/LU>
#include <cmath>

#include "app/picture/snapshot.h"
#include "app/setup/auto_ranges.h"
#include "sim/health/diagnostics.h"
#include "sim/laws/threshold_cell.h"

namespace neve::app::picture {

namespace {

using sim::Mat3d;

double J_E(const Snapshot& s, std::size_t p) {
  return s.particles.F_E.empty() ? 1.0 : s.particles.F_E[p].determinant();
}

double J_P(const Snapshot& s, std::size_t p) {
  return s.particles.J_P.empty() ? 1.0 : s.particles.J_P[p];
}

/// Density at the start: of the volume the solver uses, or of the material before it is known.
double rho_0(const scene::Scene& scene, const Snapshot& s, std::size_t p) {
  if (!s.particles.V0.empty() && s.particles.V0[p] > 0) return s.particles.m[p] / s.particles.V0[p];
  const int material = s.particles.material.empty() ? 0 : s.particles.material[p];
  return scene.materials[static_cast<std::size_t>(material)].density;
}

sim::Material material_of(const scene::Scene& scene, const Snapshot& s, std::size_t p) {
  return s.particles.material.empty() ? scene.materials[0]
                                      : s.particles.material_of(p, scene.materials);
}

double J(const Snapshot& s, std::size_t p) {
  return J_E(s, p) * J_P(s, p);
}

/// Cauchy stress from Kirchhoff stress: sigma = tau / J.
Mat3d sigma(const Snapshot& s, std::size_t p) {
  return s.kirchhoff[p] / J(s, p);
}

double von_mises(const Mat3d& stress) {
  const Mat3d deviator = stress - stress.trace() / 3 * Mat3d::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

double attribute(const scene::Scene& scene, scene::ColorBy color_by, const Snapshot& s,
                 std::size_t p) {
  switch (color_by) {
    case scene::ColorBy::snow:
      return 0;
    case scene::ColorBy::speed:
      return s.particles.v[p].norm();
    case scene::ColorBy::density:
      return rho_0(scene, s, p) / J(s, p);
    case scene::ColorBy::J_E:
      return J_E(s, p);
    case scene::ColorBy::J_P:
      return J_P(s, p);
    case scene::ColorBy::pressure:
      return -sigma(s, p).trace() / 3;
    case scene::ColorBy::von_mises:
      return von_mises(sigma(s, p));
    case scene::ColorBy::p0:
      // Laws yield in Kirchhoff stress; this one is seen beside the pressure.
      return sim::health::consolidation_pressure(material_of(scene, s, p), J_P(s, p)) / J(s, p);
    case scene::ColorBy::yield:
      return s.particles.F_E.empty()
                 ? 0
                 : sim::health::nearness_to_yield(
                       sim::laws::in_cells(material_of(scene, s, p), scene.solver),
                       s.particles.F_E[p], J_P(s, p));
    case scene::ColorBy::id:
      return s.particles.id_of(p);
  }
  return 0;
}

}  // namespace

AttributeName attribute_name(scene::ColorBy color_by) {
  switch (color_by) {
    case scene::ColorBy::snow:
      return {"", ""};
    case scene::ColorBy::speed:
      return {"speed", "m/s"};
    case scene::ColorBy::density:
      return {"density", "kg/m3"};
    case scene::ColorBy::J_E:
      return {"J_E, elastic volume", ""};
    case scene::ColorBy::J_P:
      return {"J_P, plastic volume", ""};
    case scene::ColorBy::pressure:
      return {"pressure", "Pa"};
    case scene::ColorBy::von_mises:
      return {"von Mises stress", "Pa"};
    case scene::ColorBy::p0:
      return {"p0, pressure that packs", "Pa"};
    case scene::ColorBy::yield:
      return {"nearness to yielding", ""};
    case scene::ColorBy::id:
      return {"particle", ""};
  }
  return {"", ""};
}

AttributeName attribute_name(scene::ScalarField field) {
  if (field == scene::ScalarField::mass) return {"mass density of the grid", "kg/m3"};
  return attribute_name(setup::attribute_of(field));
}

AttributeName attribute_name(scene::VectorField field) {
  switch (field) {
    case scene::VectorField::velocity:
      return {"velocity", "m/s"};
    case scene::VectorField::momentum:
      return {"momentum", "kg m/s"};
    case scene::VectorField::force:
      return {"force", "N"};
    case scene::VectorField::v_free:
      return {"v_free, after forces", "m/s"};
    case scene::VectorField::v_star:
      return {"v_star, after collisions", "m/s"};
    case scene::VectorField::v_new:
      return {"v_new, after the solve", "m/s"};
  }
  return {"", ""};
}

std::vector<double> attribute_values(const scene::Scene& scene, scene::ColorBy color_by,
                                     const Snapshot& snapshot) {
  std::vector<double> values;
  if (color_by == scene::ColorBy::snow) return values;
  values.reserve(snapshot.particles.x.size());
  for (std::size_t p = 0; p < snapshot.particles.x.size(); ++p)
    values.push_back(attribute(scene, color_by, snapshot, p));
  return values;
}

}  // namespace neve::app::picture
