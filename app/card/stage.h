#pragma once
/// The small scenes of a card, built by value, and their simulations.

#include "app/card/experiment.h"
#include "sim/simulation.h"

namespace neve::app::card {

/// A scene with one material and the solver of the subject, without bodies and colliders. Its
/// steps are explicit and adaptive. Thresholds are as they are written, whatever the cells.
scene::Scene empty_stage(const Subject& subject, double cell_size);

/// A body of the material. On a lattice it is uniform, and its volume that of its shape.
void add_body(scene::Scene& stage, const sim::shapes::Shape& shape,
              sim::seeding::Sampling sampling);

void add_plane(scene::Scene& stage, const std::string& name, const sim::Vec3d& point,
               const sim::Vec3d& normal, sim::shapes::Contact contact);

/// Makes a simulation on one thread: experiments share the cores.
sim::Simulation simulation_of(const scene::Scene& stage);

/// Advances to a time. @return whether it got there; otherwise the experiment says why not
/// @throws Error after an interrupt
bool advance(sim::Simulation& simulation, double time, Experiment& experiment,
             sim::AdvanceReport* report = nullptr);

/// Takes back what an experiment found that did not get to its end: it is no verdict.
void withdraw(Experiment& experiment);

/// Keeps the present state for the picture. @param stage  what is seen of the scene
void show(const sim::Simulation& simulation, scene::Scene stage, Experiment& experiment);

/// A camera that stays.
void look(scene::Scene& stage, const sim::Vec3d& eye, const sim::Vec3d& target,
          const sim::Vec3d& up = sim::Vec3d(0, 1, 0));

}  // namespace neve::app::card
