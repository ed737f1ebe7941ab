#pragma once
/// Forecast of the steps of a run by coarse copies of it.

#include <string>
#include <vector>

#include "app/forecast/step_cost.h"
#include "app/scene/scene.h"
#include "app/setup/plan.h"
#include "sim/types/time_step.h"

namespace neve::app::forecast {

/// Steps, seconds or work, of a run or of many. The truth lies within the range on every shipped
/// scene.
struct Cost {
  double expected = 0, least = 0, most = 0;
};
inline Cost operator+(const Cost& a, const Cost& b) {
  return {a.expected + b.expected, a.least + b.least, a.most + b.most};
}
inline Cost operator*(double factor, const Cost& cost) {
  return {factor * cost.expected, factor * cost.least, factor * cost.most};
}

/// Forecast of the steps of one frame.
struct FrameForecast {
  int frame = 0;
  double dt = 0;     ///< s
  double steps = 0;  ///< in this frame
  /// The same if the stiffest particle is as that of the copy, and if it is one that is rarer than
  /// in 19 runs of 20.
  double min_steps = 0, max_steps = 0;
  sim::DtLimit limit = sim::DtLimit::max_dt;
  double iterations = 0;  ///< of the solve of a semi-implicit step, the mean; 0: explicit
  Spread spread{};        ///< of the copy at the frame's end
  /// Cost of a step of the scene relative to the first, by the spread of the snow over the grid: in
  /// pieces as large as at the start, and in single particles.
  double cost = 1, max_cost = 1;
};

/// Snow of an emitter that finds no room, because snow fills the emitter.
struct Withheld {
  std::string emitter;
  double share = 0;  ///< of all its snow
  double time = 0;   ///< s, the time that the copy reached
};

/// Explicit steps that take as long as a semi-implicit step of so many iterations.
double explicit_steps(double iterations);

/// The steps of a run, foretold by a coarse copy of it, or by the finer one of two.
struct Forecast {
  std::vector<FrameForecast> frames;     ///< that the copy reached; those after are as the last
  double particles = 0;                  ///< of the copy; 0: there is none
  double seconds_per_particle_step = 0;  ///< of the copy, on one thread
  Spread spread{};                       ///< of the copy at the start
  std::string divergence;                ///< of the copy, a sentence; empty if it holds
  std::string ignored;                   ///< rule that the copy breaks and continues, a sentence
  std::vector<Withheld> withheld;        ///< by the copy's emitters
  double peak_force = 0;  ///< N, on one collider of the copy, mean over a frame; the largest
  double mean_J_P = 1;    ///< of the copy's particles, in the last frame that it reached
  /// Steps of the run if a single particle is crushed and rules them to the end; 0: none is to be
  /// expected.
  double crushed_steps = 0;

  Cost steps() const;  ///< of its frames
  /// Steps of its frames as those of the start: multiplied by the time of one they are seconds.
  Cost steps_of_start() const;
  /// The work of the frames after one, to the last, in explicit steps of the start, or of packed
  /// snow where steps are counted in those.
  Cost work(int after, int last) const;
  /// Fills in the cost of a step in each frame. @param start  of the scene itself at its start
  void include_spread(const Spread& start);
  /// Steps cost what those of the copy cost, over a step of packed snow: kinds of steps compare.
  void count_in_packed_steps();
};

/// Bounds the cost of the coarse copies of a forecast. Particle-steps are the same on every
/// machine.
struct ForecastBudget {
  double seconds = 0;         ///< of each copy
  double particle_steps = 0;  ///< of the first copy
  double particles = 1500;    ///< of the first copy, about
  /// Bounds a second copy, which is as fine as they allow: a few cells do not pack and harden as
  /// many do. 0: there is none.
  double fine_particle_steps = 0;
  double work = 1e300;  ///< of the run, in explicit steps of packed snow: a copy that foretells
                        ///< more need not tell how much more
};

/// @param particles of the scene
/// @param last the last frame of the run
Forecast foresee(const scene::Scene& scene, double particles, int last,
                 const ForecastBudget& budget);

/// Particles times steps that the limits on dt allow snow at rest that then meets the ground.
double work_at_rest(const scene::Scene& scene, const setup::Plan& plan);

/// Factor on lambda and mu in a particle that an impact has crushed to about half of its volume.
double crushed_hardening(const sim::Material& material);

}  // namespace neve::app::forecast
