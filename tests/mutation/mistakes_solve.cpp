/// Mistakes in the solve of semi-implicit steps.

#include "tests/mutation/mistakes.h"

namespace neve::test {

std::vector<Mistake> solve_mistakes() {
  constexpr const char* stretches = "sim/laws/stretches.h";
  return {
      {"hessian_sign",
       "semi-implicit: sign of the Hessian flipped",
       {{"sim/kernels/implicit_sweeps.h", "change[n] * (a.beta_dt_squared * u[n][3])",
         "change[n] * (-a.beta_dt_squared * u[n][3])"}}},
      {"rotation_held",
       "semi-implicit: δP without δR",
       {{stretches, "    solve_for_spin(e.shape, k, w);\n",
         "    (void)k;\n    w[0] = w[1] = w[2] = V{};\n"}}},
      {"cofactor_held",
       "semi-implicit: δP without δ(J F⁻ᵀ)",
       {{stretches, "const V on_transpose = -e.V0_lambda * J * (J - Real(1));",
         "const V on_transpose{};"},
        {stretches, "e.V0_lambda * J * (Real(2) * J - Real(1)) * trace",
         "e.V0_lambda * J * J * trace"}}},
      {"beta_dt",
       "semi-implicit: β dt instead of β dt²",
       {{"sim/engine/implicit_solver.cpp", "settings.beta * dt * dt", "settings.beta * dt"}}},
  };
}

}  // namespace neve::test
