/// Mistakes in contact with colliders.

#include "tests/mutation/mistakes.h"

namespace neve::test {

std::vector<Mistake> contact_mistakes() {
  constexpr const char* contact = "sim/kernels/contact.h";
  constexpr const char* of_nodes = "sim/kernels/stages.h";
  constexpr const char* at_particles = "sim/kernels/particle_contact_sweeps.h";
  constexpr const char* bodies = "sim/engine/body_contact.cpp";
  return {
      {"contact_half_a_cell_off",
       "surface of colliders half a cell outside",
       {{of_nodes, "static_cast<Real>(node_depth) * c.h, work, loads,",
         "Real(-0.5) * c.h, work, loads,"}}},
      {"reach_of_contact",
       "colliders looked for a cell too near to a block",
       {{of_nodes, "find_near<Set>(near, c, key, Real(1.5), Real(2.7));",
         "find_near<Set>(near, c, key, Real(1.5), Real(1.7));"}}},
      {"friction_on_absolute_velocity",
       "friction on v instead of v − v_co",
       {{contact, "const Vec3<V> v_t = v_rel - n * v_n;",
         "const Vec3<V> v_t = v - n * dot(v, n);"}}},
      {"late_collider",
       "colliders one step late",
       {{"sim/state/state.cpp", "colliders.place(method.lattice, progress.time, *pool);",
         "colliders.place(method.lattice, progress.time - dt, *pool);"}}},
      {"contact_work_only_gained",
       "work of colliders only where they give energy",
       {{of_nodes, "done += mass * dot(v - before, surface_velocity(colliders[k], r));",
         "done += larger_lanes(mass * dot(v - before, surface_velocity(colliders[k], r)), V{});"}}},
      {"contact_not_held",
       "semi-implicit: contact not held in the solve",
       {{"sim/kernels/held.h", "if (count == Real(0)) return x;",
         "if (count >= Real(0)) return x;"}},
       {},
       {},
       true},
      {"gap_forgotten",
       "contact at particles: stopped where they are found, not where they touch",
       {{at_particles, "return gap > V{} ? -gap / c.dt :", "return gap > V{} ? V{} :"}}},
      {"friction_without_impulse",
       "contact at particles: friction bounded by the coefficient alone",
       {{at_particles, "return c.collider < I{} ? c.friction : c.friction * c.impulse;",
         "return c.friction;"}}},
      {"impulses_forgotten",
       "contact at particles: every step begins without the impulses of the last, two passes are "
       "all",
       {{"sim/engine/particle_contact.cpp",
         "a.carried = static_cast<Real>(std::min(longer, max_carried));",
         "a.carried = static_cast<Real>(std::min(longer, 0.0));"}}},
      {"rest_of_the_solve_in_no_book",
       "semi-implicit: colliders get the impulses of their springs alone, not what the solve left "
       "over",
       {{"sim/engine/particle_contact.cpp", "  share(unexplained);", "  share(0 * unexplained);"}}},
      {"torque_about_the_cell",
       "contact at particles: torque from the cell of a particle, not from its place",
       {{at_particles, "(static_cast<double>(c.offset[x][l]) - pose.offset[x])",
         "(0.0 - pose.offset[x])"}}},
      {"body_whole_at_each_contact",
       "bodies that snow moves: each contact pushes the whole mass, not its part of it",
       {{bodies, "static_cast<Real>(seen.gives) * static_cast<Real>(std::max(seen.count, 1));",
         "static_cast<Real>(seen.gives);"}}},
      {"body_does_not_answer",
       "bodies that snow moves: their surfaces keep the velocity of the start of the step",
       {{bodies, "contact.surface[x] = seen.velocity[x] + turned[x];",
         "static_cast<void>(turned[x]);"}}},
      {"body_seems_free",
       "bodies that snow moves: what holds them up does not count in contact",
       {{bodies, "seen.gives = std::clamp(done / free, 0.0, 1.0);", "seen.gives = 1;"},
        {bodies, "narrowed<Real>(bodies_->after(b).velocity);",
         "narrowed<Real>(seen.free_velocity + pushes_[b].impulse / bodies_->mass(b).mass);"},
        {bodies, "narrowed<Real>(bodies_->after(b).spin);",
         "narrowed<Real>(seen.free_spin + seen.inverse_inertia * pushes_[b].moment);"}}},
      {"moment_about_the_point",
       "bodies that snow moves: turned about the shape's centre, not the centre of mass",
       {{"sim/state/moving_colliders.cpp", "push.moment += bodies_.point(b).cross(push.impulse);",
         ""}}},
  };
}

}  // namespace neve::test
