/// Mistakes in what a run does around its steps: length of steps, sums, births.

#include "tests/mutation/mistakes.h"

namespace neve::test {

std::vector<Mistake> run_mistakes() {
  constexpr const char* stretches = "sim/laws/stretches.h";
  constexpr const char* sweeps = "sim/kernels/sweeps.h";
  constexpr const char* method = "sim/state/method.cpp";
  return {
      {"sound_without_hardening",
       "sound speed without hardening",
       {{stretches, "m.wave_modulus() = Real(2) * mu * row_sum_norm(b) + lambda * J * J;",
         "m.wave_modulus() = Real(2) * m.word[MaterialLanes<V>::word_mu] * row_sum_norm(b) +\n"
         "                     m.word[MaterialLanes<V>::word_lambda] * J * J;"},
        {stretches, "m.wave_modulus() = Real(2) * mu * largest + lambda * J_E * J_E;",
         "m.wave_modulus() = Real(2) * m.word[MaterialLanes<V>::word_mu] * largest +\n"
         "                     m.word[MaterialLanes<V>::word_lambda] * J_E * J_E;"}}},
      {"sound_of_the_material",
       "sound speed with the density of the material instead of m / V0",
       {{sweeps, "const V sound_squared = wave_modulus[k] * p.V0 / p.m;",
         "const V sound_squared = wave_modulus[k] / Real(400);"}}},
      {"strain_of_the_diagonal",
       "strain limit from the diagonal of ∇v",
       {{sweeps, "strain_rate = larger_lanes(strain_rate, absolute_lanes(g.grad_v[q]));",
         "if (q % 4 == 0) strain_rate = larger_lanes(strain_rate, absolute_lanes(g.grad_v[q]));"}}},
      {"look_ahead_without_colliders",
       "hardening within a step foreseen for the speed of snow, not for that of colliders",
       {{"sim/types/time_step.cpp", "std::max(0.7 * limits.max_speed, limits.max_collider_speed)",
         "0.7 * limits.max_speed"}}},
      {"share_of_another_dt",
       "FLIP's share of the dt in the settings, not of the step's",
       {{method, "flip_share(settings, dt)", "flip_share(settings, settings.dt)"}}},
      {"beta_of_another_dt",
       "semi-implicit: β dt² of the dt in the settings, not of the step's",
       {{"sim/engine/implicit_solver.cpp", "settings.beta * dt * dt",
         "settings.beta * settings.dt * settings.dt"}}},
      {"energy_without_stiffness",
       "elastic energy without a particle's factor on its stiffness",
       {{method, "static_cast<double>(p[l]->stiffness) * energy[l]", "energy[l]"}}},
      {"angular_momentum_without_C",
       "angular momentum without the affine velocity",
       {{"sim/engine/state_reader.cpp", "  if (has_C) {", "  if (has_C && m < 0) {"}},
       {"--asflip"},
       "of `transfer = \"asflip\"`"},
      {"births_in_occupied_space",
       "births where there is no room",
       {{"sim/engine/room.cpp", "return filled <= birth.room * std::pow(radius / wanted, 3);",
         "return filled >= 0;"}}},
  };
}

}  // namespace neve::test
