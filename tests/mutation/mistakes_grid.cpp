/// Mistakes in weights, gradients, transfers and the update of the grid.

#include "tests/mutation/mistakes.h"

namespace neve::test {

namespace {

constexpr const char* stages = "sim/kernels/stages.h";
constexpr const char* sweeps = "sim/kernels/sweeps.h";
constexpr const char* splines = "sim/kernels/bspline.h";

/// Replaces how the force takes its gradient; `factor` without V0.
Edit force_factor(const std::string& factor) {
  return {stages, "const V factor = V0 * (-inv_h * inertia * scale);",
          "const V factor = V0 * (" + factor + ");\n  (void)inv_h;"};
}
/// Replaces how grad v is gathered: scale, then where it is put.
Edit gathered_gradient(const std::string& scale, const std::string& to = "out.grad_v + c, 3") {
  return {stages, "take(gradient + 1 + c, is_mls ? inv_h * arm_scale : inv_h, out.grad_v + c, 3);",
          "take(gradient + 1 + c, " + scale + ", " + to + ");"};
}
/// Replaces what FLIP adds to a particle's velocity, in both drivers; axis a, node n.
std::vector<Edit> flip_change(const std::string& in_fused, const std::string& in_staged) {
  return {
      {sweeps, "for (int n = 0; n < block_nodes; ++n) change[n] = v_new[n] - v_old[n];",
       "for (int n = 0; n < block_nodes; ++n)\n          for (int a = 0; a < 3; ++a) " + in_fused},
      {sweeps, "nodes_of(a, b, channel_change)[n] = nodes.v_new[n] - nodes.v_old[n];",
       "for (int k = 0; k < 3; ++k) " + in_staged}};
}

constexpr const char* cubic_slopes =
    "  dw[0] = Real(-0.5) * a * a;\n"
    "  dw[1] = (Real(1.5) * o - Real(2)) * o;\n"
    "  dw[2] = (Real(2) - Real(1.5) * a) * a;\n"
    "  dw[3] = Real(0.5) * o * o;\n";

constexpr const char* spline_call = "      spline<Real>(place, N, dN);\n";

/// Stencils of the particles where they are half a cell aside.
constexpr const char* aside =
    "V aside[3];\n"
    "          for (int axis = 0; axis < 3; ++axis)\n"
    "            aside[axis] = p.offset[axis] < Real(0.5) ? p.offset[axis] + Real(0.5)\n"
    "                                                     : p.offset[axis] - Real(0.5);\n"
    "          s.template set<!is_mls, is_affine>(0, aside, p.cell);\n";

}  // namespace

std::vector<Mistake> gradient_mistakes() {
  return {
      {"grad_v_transposed",
       "∇v transposed: ∇w ⊗ v",
       {gathered_gradient("is_mls ? inv_h * arm_scale : inv_h", "out.grad_v + 3 * c, 1")}},
      {"strain_on_the_wrong_side",
       "F (I + dt ∇v) instead of (I + dt ∇v) F",
       {{stages,
         "      const V* g = grad_v + 3 * a;\n"
         "      const V rate = fused(g[0], F_E[b], fused(g[1], F_E[3 + b], g[2] * F_E[6 + b]));",
         "      const V* f = F_E + 3 * a;\n"
         "      const V rate = fused(f[0], grad_v[b], fused(f[1], grad_v[3 + b], f[2] * grad_v[6 + "
         "b]));"}}},
      {"no_h_in_force", "1/h missing in the force only", {force_factor("-inertia * scale")}},
      {"no_h_in_grad_v",
       "1/h missing in ∇v only",
       {gathered_gradient("is_mls ? arm_scale : Real(1)")}},
      {"no_h_anywhere",
       "1/h missing everywhere",
       {force_factor("-inertia * scale"), gathered_gradient("is_mls ? arm_scale : Real(1)")}},
      {"h_twice_in_force",
       "1/h twice in the force",
       {force_factor("-inv_h * inv_h * inertia * scale")}},
      {"force_sign", "sign of the force flipped", {force_factor("inv_h * inertia * scale")}},
      {"gradient_sign",
       "sign of the gradient flipped everywhere",
       {force_factor("inv_h * inertia * scale"),
        gathered_gradient("-(is_mls ? inv_h * arm_scale : inv_h)")}},
      {"slope_without_sign",
       "N'(|x|) without the sign of x",
       {{splines, cubic_slopes,
         "  dw[0] = Real(-0.5) * a * a;\n"
         "  dw[1] = (Real(1.5) * o - Real(2)) * o;\n"
         "  dw[2] = (Real(1.5) * a - Real(2)) * a;\n"
         "  dw[3] = Real(-0.5) * o * o;\n"}}},
      {"gradients_half_a_cell_aside",
       "gradients half a cell aside",
       {{stages, spline_call,
         std::string(spline_call) +
             "      for (int k = 0; k < K; ++k) {\n"
             "        const V x = place - Real(0.5) - static_cast<Real>(k), r = "
             "absolute_lanes(x);\n"
             "        const V far = Real(-0.5) * (Real(2) - r) * (Real(2) - r);\n"
             "        V slope = r < Real(1) ? (Real(1.5) * r - Real(2)) * r : far;\n"
             "        slope = r < Real(2) ? slope : V{};\n"
             "        dN[k] = x < V{} ? -slope : slope;\n"
             "      }\n"}}},
      {"three_of_four_nodes",
       "3 of the 4 cubic nodes per axis",
       {{stages, spline_call, std::string(spline_call) + "      N[K - 1] = dN[K - 1] = V{};\n"}}},
      {"linear_hats",
       "linear hats instead of B-splines",
       {{splines, "  w[0] = a * a * a * Real(1.0 / 6.0);\n", "  w[0] = V{};\n"},
        {splines, "  w[1] = (Real(0.5) * o - Real(1)) * o * o + Real(2.0 / 3.0);\n",
         "  w[1] = a;\n"},
        {splines, "  w[3] = o * o * o * Real(1.0 / 6.0);\n", "  w[3] = V{};\n"},
        {splines, cubic_slopes,
         "  dw[0] = dw[3] = V{};\n  dw[2] = V{} + Real(1);\n  dw[1] = -dw[2];\n"}}},
  };
}

std::vector<Mistake> volume_mistakes() {
  const char* estimate = "return m * (h * h * h) / gather_value<Set>(s, q, momentum)[3];";
  return {
      {"volume_of_a_cell",
       "V0 = h³ for every particle",
       {{stages, estimate, "(void)m, (void)s, (void)q, (void)momentum;\n  return h * h * h;"}}},
      {"density_without_h3",
       "density without /h³",
       {{stages, estimate, "(void)h;\n  return m / gather_value<Set>(s, q, momentum)[3];"}}},
      {"volume_every_step",
       "V0 estimated again in every step",
       {{sweeps, "          if (!(record.flags() & needs_volume)) continue;\n", ""},
        {"sim/engine/step.cpp",
         "    a_ = state_.sweep_args(dt_, state_.method.sweeps->fused_channels);\n",
         "    kernels::SweepArgs<Real> again = state_.sweep_args(dt_, kernels::all_channels);\n"
         "    std::vector<kernels::StagedNodes<Real>> staged(\n"
         "        state_.particles.partition.node_blocks().size());\n"
         "    again.staged = staged.data();\n"
         "    state_.over_particle_blocks(state_.method.sweeps->rasterize, again);\n"
         "    state_.over_node_blocks(state_.method.sweeps->collect_momentum, again);\n"
         "    state_.over_particle_blocks(state_.method.sweeps->volumes, again);\n"
         "    a_ = state_.sweep_args(dt_, state_.method.sweeps->fused_channels);\n"}}},
  };
}

std::vector<Mistake> transfer_mistakes() {
  return {
      {"flip_without_v_old", "FLIP without − v_old: v_p += Σ w v_new",
       flip_change("change[n][a] = v_new[n][a];",
                   "nodes_of(a, b, channel_change)[n][k] = nodes.v_new[n][k];")},
      {"flip_after_gravity", "FLIP difference against the velocity after gravity",
       flip_change("change[n][a] = v_new[n][a] - v_old[n][a] - "
                   "(v_old[n][3] > Real(0) ? c.dt * c.gravity[a] : Real(0));",
                   "nodes_of(a, b, channel_change)[n][k] = nodes.v_new[n][k] - nodes.v_old[n][k] - "
                   "(nodes.momentum[n][3] > Real(0) ? a.constants.dt * a.constants.gravity[k] : "
                   "Real(0));")},
      {"velocity_not_over_mass",
       "grid velocity not divided by mass",
       {{stages, "return momentum.part[p] / mass;", "(void)mass;\n  return momentum.part[p];"}}},
      {"force_not_over_mass",
       "force not divided by mass",
       {{stages, "(force.part[p] / mass + gravity) * c.dt", "(force.part[p] + gravity) * c.dt"}}},
      {"fast_force_forgotten",
       "force forgotten in the fused driver only",
       {{sweeps, "row_v_free<has_change>(v_old, force, c)",
         "(void)force;\n    row_v_free<false>(v_old, R::zero(), c)"}},
       {},
       "not a classic: a mistake of the fused driver, while self-tests and `--validate` use the "
       "staged driver"},
      {"half_a_cell_between_transfers",
       "half a cell between P2G and G2P",
       {{sweeps,
         "s.template set<!is_mls, is_affine>(0, p.offset, p.cell);\n"
         "          kernels::gather<Set, transfer>(s, 0",
         std::string(aside) + "          kernels::gather<Set, transfer>(s, 0"},
        {sweeps,
         "s.template set<!is_mls, is_affine>(0, p.offset, p.cell);\n"
         "        Gathered<V> g{};",
         std::string(aside) + "        Gathered<V> g{};"}},
       {},
       "the shift stays in the particle's cell: half a cell up or down"},
  };
}

std::vector<Mistake> affine_mistakes() {
  const char* about = "of `transfer = \"asflip\"`";
  return {
      {"own_velocity_after_the_step",
       "ASFLIP: own velocity against the grid's after the step, v_p − Σ w v_new",
       {{stages, "own[a] = (p.v[a] - (g.v[a] - g.change[a])) * alpha;",
         "own[a] = (p.v[a] - g.v[a]) * alpha;"}},
       {"--asflip"},
       about},
      {"places_without_strain",
       "ASFLIP: packed snow, too, moves by its own velocity, which does not strain F",
       {{stages,
         "determinant(p.F_E) >= all<V>(c.separating_J_E) ? all<V>(c.beta_max) : all<V>(c.beta_min)",
         "determinant(p.F_E) >= V{} ? all<V>(c.beta_max) : all<V>(c.beta_min)"}},
       {"--asflip"},
       about},
      {"affine_velocity_transposed",
       "ASFLIP: momentum of Cᵀ (x_i − x_p) instead of C (x_i − x_p)",
       {{stages,
         "  return {{{{factor * C[0], factor * C[3], factor * C[6], V{}}},\n"
         "           {{factor * C[1], factor * C[4], factor * C[7], V{}}},\n"
         "           {{factor * C[2], factor * C[5], factor * C[8], V{}}}}};",
         "  return {{{{factor * C[0], factor * C[1], factor * C[2], V{}}},\n"
         "           {{factor * C[3], factor * C[4], factor * C[5], V{}}},\n"
         "           {{factor * C[6], factor * C[7], factor * C[8], V{}}}}};"}},
       {"--asflip"},
       about},
      {"moves_before_the_step",
       "ASFLIP: moves by the velocity before the step",
       {{stages, "v[a] = fused(beta, own[a], g.v[a]);",
         "v[a] = fused(beta, own[a], g.v[a] - g.change[a]);"}},
       {"--asflip"},
       about},
  };
}

std::vector<Mistake> step_mistakes() {
  return {
      {"dt_1_1200", "dt = 1/1200 s", {}, {"--dt", "0.000833333"}},
      {"dt_1_240", "dt = 1/240 s", {}, {"--dt", "0.004166667"}},
      {"dt_1_24", "dt = 1/24 s, a frame", {}, {"--dt", "0.041666667"}, {}, true},
  };
}

std::vector<Mistake> all_mistakes() {
  std::vector<Mistake> all;
  for (const auto& part :
       {gradient_mistakes(), stress_mistakes(), volume_mistakes(), plasticity_mistakes(),
        law_mistakes(), transfer_mistakes(), affine_mistakes(), solve_mistakes(),
        contact_mistakes(), run_mistakes(), step_mistakes()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace neve::test
