#include "app/health/meanings.h"

#include <array>
#include <utility>

namespace neve::app::health {

namespace {

constexpr std::array stages{
    StageMeaning{"Particles give their mass and momentum to the nodes around them, near ones more.",
                 "step 1: m_i = sum of m_p w_ip, v_old = sum of m_p v_p w_ip / m_i"},
    StageMeaning{"In a body's first step each particle learns from the grid how much room it has.",
                 "step 2: rho_p = sum of m_i w_ip / h^3, V0 = m_p / rho_p"},
    StageMeaning{"Squeezed and stretched particles push and pull the nodes around them.",
                 "step 3, equation 6: f_i = - sum of V0 tau grad_w_ip"},
    StageMeaning{"Nodes are accelerated by these forces and by gravity.",
                 "step 4: v_free = v_old + dt (f_i / m_i + g)"},
    StageMeaning{"Nodes inside colliders take on what contact allows: no way in, and friction.",
                 "step 5: v_star from v_free"},
    StageMeaning{"Semi-implicit steps let the nodes feel the forces that they are about to make; "
                 "explicit steps skip it.",
                 "step 6: v_new solves (I + beta dt^2 H / m) v = v_star"},
    StageMeaning{
        "Each particle is deformed as the nodes around it move; beyond its limits snow "
        "yields and stays deformed.",
        "step 7, equations 11 and 12: F = (I + dt grad_v) F, then F_E clamped, rest to F_P"},
    StageMeaning{"Particles take their new velocity from the nodes: a mix of the node's velocity "
                 "(PIC) and of its change (FLIP).",
                 "step 8: v_p = (1 - alpha) v_PIC + alpha v_FLIP"},
    StageMeaning{
        "Particles that are about to enter a collider get the velocity that contact allows.",
        "step 9"},
    StageMeaning{"Particles move.", "step 10: x_p = x_p + dt v_p"},
    StageMeaning{"Colliders move along their keyframes and velocities.", "after step 10"}};

constexpr std::array symbols{
    std::pair{"id", "Number of the particle, from 0; it keeps it."},
    std::pair{"x", "Position."},
    std::pair{"v", "Velocity of the particle."},
    std::pair{"m", "Mass of the particle; it never changes."},
    std::pair{"V0", "Volume that the particle has when nothing deforms it."},
    std::pair{"F_E",
              "Elastic part of the deformation gradient: how the snow at this particle is "
              "stretched and turned now, to spring back. The identity is snow at rest."},
    std::pair{"J_E",
              "Determinant of F_E: elastic volume over volume at rest. Below 1 is squeezed."},
    std::pair{"J_P",
              "Determinant of the plastic part: lasting change of volume. Below 1 is packed "
              "and harder, above 1 is loose."},
    std::pair{"stretch_min", "Smallest stretch of F_E in any direction; theta_c bounds it."},
    std::pair{"stretch_max", "Largest stretch of F_E in any direction; theta_s bounds it."},
    std::pair{"kirchhoff",
              "Kirchhoff stress tau: the true stress times J_E. Its unit is Pa, and its "
              "negative trace a pressure."},
    std::pair{"volume", "Volume that the particle has now, V0 J_E J_P."},
    std::pair{"elastic_energy", "Energy that the deformation of the particle stores."},
    std::pair{"F_E_trial", "F_E after the motion of the step, before snow yields."},
    std::pair{"v_before", "Velocity of the particle before this stage."},
    std::pair{"mass", "Mass on the node, from the particles around it."},
    std::pair{"momentum", "Momentum on the node, from the particles around it."},
    std::pair{"v_old", "Velocity of the node before forces: momentum over mass."},
    std::pair{"force", "Elastic force of the snow on the node."},
    std::pair{"v_free",
              "Velocity of the node after forces and gravity, as if there were no collider."},
    std::pair{"dv", "Change of the node's velocity by forces and gravity."},
    std::pair{"v_star", "Velocity of the node after contact with colliders."},
    std::pair{"v_new",
              "Velocity of the node that particles take up: v_star, or the result of the "
              "semi-implicit solve."},
    std::pair{"dv_solve", "Change of v_star by the semi-implicit solve."},
    std::pair{"grad_v",
              "Velocity gradient at the particle: how fast its surroundings stretch and turn."},
    std::pair{
        "C",
        "Affine velocity of all transfers but FLIP: how the velocity varies around the particle."},
    std::pair{"stiffness", "Factor of the particle on Young's modulus, of variation."},
    std::pair{"threshold",
              "Factor of the particle on its critical stretches or strength, of variation."},
    std::pair{"node", "Number of the node along each axis, in cells."}};

}  // namespace

const StageMeaning& meaning_of(sim::Stage stage) {
  return stages[static_cast<std::size_t>(stage)];
}

std::string meaning_of(const std::string& quantity) {
  for (const auto& [name, text] : symbols)
    if (quantity == name) return text;
  return {};
}

}  // namespace neve::app::health
