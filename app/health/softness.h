#pragma once
/// Snow that is too soft for its impact, and the stiffness that would hold.

#include <optional>
#include <string>

#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::health {

/// Young's modulus, in Pa, with which snow that a body's impact packed to J_P stays above a quarter
/// of its volume. Yielding snow bears p(J_P) = g E e^(xi (1 - J_P)) / J_P, where g depends on the
/// threshold and Poisson's ratio. At J_P = 1/4 it has to bear
///   - as much as when it was packed to J_P;
///   - three times the pressure rho v^2 / (1 - J) behind a plane shock that stops snow of the given
///     speed: edges, and nodes held by a collider, focus it.
/// Thresholds are those in the cells of the settings.
/// Check: Softness.ImpactHoldsWithTheStiffnessThatIsAdvised
double stiffness_that_holds(const sim::Material& material, const sim::SolverSettings& settings,
                            double J_P, double speed);

/// m/s, of the fastest body that hits something, or collider.
double load_speed(const scene::Scene& scene);

/// A body or an emitter whose snow begins packed denser than ice.
struct DenseBirth {
  std::string address;  ///< of its J_P: "emitter.jet.J_P"
  double J_P = 1;
  double density = 0;        ///< kg/m3, at the start
  double J_P_of_ice = 1;     ///< with which it would be as dense as ice
  std::size_t material = 0;  ///< its number in the scene
};
/// The densest. Packed denser than ice from the start, snow says nothing of its stiffness.
/// Check: Softness.SnowThatBeginsDenserThanIceIsNotCalledSoft
std::optional<DenseBirth> dense_birth(const scene::Scene& scene);

/// "emitter.jet.J_P = 0.15 packs snow to 2670 kg/m3 before it moves, ..."
std::string evidence_text(const DenseBirth& birth);
/// "emitter.jet.J_P = 1 ..."
std::string advice_text(const DenseBirth& birth);

/// Warns of a run whose snow was packed to the limit and yielded on, or is denser than ice. Returns
/// nothing if none was, or if the run diverged: its diagnosis says more.
std::optional<std::string> softness_warning(const scene::Scene& scene,
                                            const sim::Simulation& simulation);

}  // namespace neve::app::health
