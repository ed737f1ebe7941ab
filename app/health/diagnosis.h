#pragma once
/// Why a run went wrong: one cause, what shows it, what to do.

#include <string>

#include "app/scene/names.h"
#include "app/scene/scene.h"
#include "sim/simulation.h"

namespace neve::app::health {

enum class Cause {
  bypass,             ///< stages are skipped
  initial_state,      ///< particles that do not start at rest
  units,              ///< lengths and gravity in centimetres
  raised_limits,      ///< cfl, acoustic_cfl or strain_limit beyond what holds
  density,            ///< so light that sound outruns the step
  stiffness,          ///< so stiff that sound outruns the step
  time_step,          ///< a fixed dt above the limits of snow at rest
  hardening,          ///< packed snow became too stiff
  collider_speed,     ///< a collider that hits like a bullet
  colliders_closing,  ///< colliders leave the snow no room
  incompressible,     ///< Poisson's ratio next to 0.5
  shock,              ///< an impact faster than sound
  too_soft,           ///< snow crushed by its own impact
  law,                ///< numbers that the law of the material itself doubts
  rounding,           ///< snow so stiff that single precision does not resolve its strain
  thin,               ///< bodies that the grid does not resolve
  far_flight,         ///< out of the lattice, in good health
  unexplained
};

constexpr auto names(Cause) {
  return scene::in_order<Cause::unexplained>(
      "bypass", "initial_state", "units", "raised_limits", "density", "stiffness", "time_step",
      "hardening", "collider_speed", "colliders_closing", "incompressible", "shock", "too_soft",
      "law", "rounding", "thin", "far_flight", "unexplained");
}

struct Diagnosis {
  Cause cause = Cause::unexplained;
  std::string evidence;   ///< numbers of this run, a clause
  std::string remedy;     ///< what to change, a clause
  std::string address;    ///< of the parameter to change, may be empty
  double coarsening = 1;  ///< of the run
};

/// The first cause whose evidence this run shows, from what was wrong before the first step to what
/// only happened on the way: later trouble is mostly a symptom of earlier one.
/// @param coarsening done to the scene by --coarsen: a remedy has the numbers that --set takes
Diagnosis diagnose(const scene::Scene& scene, const sim::Divergence& divergence,
                   double coarsening = 1);

/// Writes for people: step, what the rule saw, evidence and remedy.
std::string sentence(const sim::Divergence& divergence, const Diagnosis& diagnosis);

}  // namespace neve::app::health
