/// The change of each particle by a stage.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "app/view/session/stage_summary.h"

namespace neve::app::view::session {

namespace {

using sim::Vec3d;

/// The result of a stage of the grid at the node next to each particle; zero if there is none.
template <class Value>
std::vector<Vec3d> at_particles(const dump::StepInspection& inside, Value value) {
  const sim::NodeFields& nodes = inside.step.nodes;
  const double h = inside.scene.solver.cell_size;
  std::map<std::array<int, 3>, std::size_t> index;
  for (std::size_t n = 0; n < nodes.node.size(); ++n)
    index[{nodes.node[n].x(), nodes.node[n].y(), nodes.node[n].z()}] = n;
  std::vector<Vec3d> values;
  for (const Vec3d& x : inside.before.x) {
    const auto near = [&](double place) {
      return static_cast<int>(std::lround(std::clamp(place / h, -1e9, 1e9)));
    };
    const auto found = index.find({near(x.x()), near(x.y()), near(x.z())});
    values.push_back(found == index.end() ? Vec3d::Zero() : Vec3d(value(found->second)));
  }
  return values;
}

std::vector<Vec3d> differences(const std::vector<Vec3d>& before, const std::vector<Vec3d>& after) {
  std::vector<Vec3d> change;
  for (std::size_t k = 0; k < std::min(before.size(), after.size()); ++k)
    change.push_back(after[k] - before[k]);
  return change;
}

picture::StageChange of_vectors(std::string title, std::string unit, bool is_of_nodes,
                                std::vector<Vec3d> vectors) {
  picture::StageChange change{
      std::move(title), std::move(unit), {}, std::move(vectors), is_of_nodes};
  for (const Vec3d& vector : change.vector) change.magnitude.push_back(vector.norm());
  return change;
}

picture::StageChange of_deformation(const dump::StepInspection& inside) {
  picture::StageChange change{"change of F_E", "", {}, {}, false};
  for (std::size_t k = 0; k < inside.before.F_E.size(); ++k)
    change.magnitude.push_back((inside.step.after.F_E[k] - inside.before.F_E[k]).norm());
  return change;
}

}  // namespace

std::optional<picture::StageChange> change_of_stage(const dump::StepInspection& inside,
                                                    sim::Stage stage) {
  using enum sim::Stage;
  const sim::NodeFields& nodes = inside.step.nodes;
  const sim::StagedStep& step = inside.step;
  const auto of_nodes = [&](const char* title, const std::vector<Vec3d>& before,
                            const std::vector<Vec3d>& after) {
    if (before.size() != after.size()) return picture::StageChange{};  // an explicit step has none
    return of_vectors(title, "m/s", true, at_particles(inside, [&](std::size_t n) {
                        return Vec3d(after[n] - before[n]);
                      }));
  };
  switch (stage) {
    case rasterize:
      return of_vectors("v_old of the nodes", "m/s", true,
                        at_particles(inside, [&](std::size_t n) { return nodes.v_old[n]; }));
    case elastic_forces:
      return of_vectors("force over mass", "m/s2", true, at_particles(inside, [&](std::size_t n) {
                          return Vec3d(nodes.force[n] / nodes.mass[n]);
                        }));
    case grid_velocities:
      return of_nodes("v_free - v_old", nodes.v_old, nodes.v_free);
    case grid_collisions:
      return of_nodes("v_star - v_free", nodes.v_free, nodes.v_star);
    case implicit_solve:
      return of_nodes("v_new - v_star", nodes.v_star, nodes.v_new);
    case deformation:
      return of_deformation(inside);
    case particle_velocities:
      return of_vectors("change of v", "m/s", false,
                        differences(inside.before.v, step.v_before_collision));
    case particle_collisions:
      return of_vectors("change of v", "m/s", false,
                        differences(step.v_before_collision, step.after.v));
    case advection:
      return of_vectors("way", "m", false, differences(inside.before.x, step.after.x));
    case volumes:
    case colliders:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace neve::app::view::session
