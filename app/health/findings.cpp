#include "app/health/findings.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "app/health/point_findings.h"
#include "app/health/softness.h"
#include "app/scene/coarsen.h"
#include "app/scene/toml/value.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/camera_path.h"
#include "app/setup/seed_scene.h"
#include "app/setup/snow_pieces.h"
#include "app/support/round_number.h"
#include "app/support/text.h"
#include "sim/laws/law.h"
#include "sim/shapes/deforming_mesh.h"
#include "sim/shapes/solid.h"
#include "sim/types/time_step.h"

namespace neve::app::health {

namespace {

using sim::Vec3d;
using sim::health::Law;
using sim::health::limits_of;

/// Returns the value of a law beyond which the check warns.
double line(Law law) {
  return limits_of(law).check_warning;
}

Vec3d extent(const sim::shapes::Shape& shape) {
  const sim::shapes::Bounds box = sim::shapes::bounds(shape);
  return box.max - box.min;
}

bool is_plane(const sim::shapes::Shape& shape) {
  return std::holds_alternative<sim::shapes::Plane>(shape.form);
}

/// A shape that the cells do not resolve.
struct Thin {
  std::string address, name;
  double cells;  ///< across its thinnest part
};

struct ThinAdvice {
  std::string bound;     ///< cells that would do, as text
  std::string remedy;    ///< before the cells that would do
  double size_per_cell;  ///< m, of those cells, for each cell that it is thick
  double warned;         ///< cells; a thinner one is a warning
  double coarsening;     ///< of the scene
};

/// All of a kind in one finding, of the thinnest.
void report_thin(const std::vector<Thin>& thin, const ThinAdvice& advice,
                 std::vector<Finding>& findings) {
  if (thin.empty()) return;
  const auto worst = std::min_element(
      thin.begin(), thin.end(), [](const Thin& a, const Thin& b) { return a.cells < b.cells; });
  std::vector<std::string> others;
  for (auto other = thin.begin(); other != thin.end(); ++other)
    if (other != worst) others.push_back(other->name);
  std::string what = fmt::format("{} is {} cells thick", worst->name, rough_text(worst->cells));
  if (!others.empty())
    what += fmt::format(" (also under {}: {})", advice.bound, first_joined(others));
  findings.push_back(
      {worst->cells < advice.warned ? Severity::warning : Severity::note, worst->address + ".shape",
       what,
       advice.remedy + "; " +
           scene::setting_text("solver.cell_size", worst->cells * advice.size_per_cell,
                               advice.coarsening)});
}

void check_material_units(const sim::Material& m, std::vector<Finding>& findings) {
  const std::string at = "material." + m.name + ".", density = rough_text(m.density),
                    modulus = rough_text(m.youngs_modulus);
  if (sim::laws::of(m).is_granular) return;  // another density, another stiffness
  if (m.density > 0.03 && m.density < 2)
    findings.push_back(
        {Severity::warning, at + "density",
         fmt::format("density {} kg/m3 is lighter than foam", density),
         fmt::format("in g/cm3 it would be {} kg/m3", rough_text(1000 * m.density))});
  else if (m.density < line(Law::low_density) || m.density > line(Law::high_density))
    findings.push_back({Severity::warning, at + "density",
                        fmt::format("density {} kg/m3 is not snow, which has 50 to 917", density),
                        "powder has 50 to 200, packed snow 300 to 550"});
  if (m.youngs_modulus < line(Law::low_stiffness))
    findings.push_back(
        {Severity::warning, at + "youngs_modulus",
         fmt::format("youngs_modulus {} Pa is softer than jelly", modulus),
         fmt::format("in {} it would be {} Pa; the paper's snow has 1.4e5",
                     m.youngs_modulus < 1 ? "MPa" : "kPa",
                     rough_text((m.youngs_modulus < 1 ? 1e6 : 1e3) * m.youngs_modulus))});
  else if (m.youngs_modulus > line(Law::high_stiffness))
    findings.push_back({Severity::warning, at + "youngs_modulus",
                        fmt::format("youngs_modulus {} Pa makes sound run at {} m/s", modulus,
                                    rough_text(sim::sound_speed(m))),
                        "steps shorten with its square root; the paper's snow has 1.4e5"});
}

/// Index of a grid cell.
using CellIndex = std::array<long, 3>;

std::map<CellIndex, std::map<std::size_t, int>> bodies_in_cells(const scene::Scene& scene,
                                                                const setup::SeededScene& seeded) {
  const double h = scene.solver.cell_size;
  std::map<CellIndex, std::map<std::size_t, int>> cells;
  for (std::size_t body = 0; body < seeded.body_end.size(); ++body) {
    for (std::size_t p = seeded.body_begin(body); p < seeded.body_end[body]; ++p) {
      const Vec3d& x = seeded.particles.x[p];
      ++cells[{std::lround(std::floor(x.x() / h)), std::lround(std::floor(x.y() / h)),
               std::lround(std::floor(x.z() / h))}][body];
    }
  }
  return cells;
}

bool boxes_touch(const sim::shapes::Shape& a, const sim::shapes::Shape& b) {
  const sim::shapes::Bounds p = sim::shapes::bounds(a), q = sim::shapes::bounds(b);
  return (p.min.array() < q.max.array()).all() && (q.min.array() < p.max.array()).all();
}

void check_body_overlaps(const scene::Scene& scene, const setup::SeededScene& seeded,
                         std::vector<Finding>& findings) {
  bool may_overlap = false;
  for (std::size_t a = 0; a < scene.bodies.size(); ++a)
    for (std::size_t b = a + 1; b < scene.bodies.size(); ++b)
      may_overlap = may_overlap || boxes_touch(scene.bodies[a].shape, scene.bodies[b].shape);
  if (!may_overlap) return;
  std::vector<double> per_cell;
  for (const sim::seeding::Body& body : scene.bodies)
    per_cell.push_back(particles_in_cell(body, scene.solver.cell_size));
  // In a cell that both fill, each has most of the particles that it has where it is alone.
  std::map<std::pair<std::size_t, std::size_t>, double> shared;
  for (const auto& [cell, counts] : bodies_in_cells(scene, seeded))
    for (auto a = counts.begin(); a != counts.end(); ++a)
      for (auto b = std::next(a); b != counts.end(); ++b) {
        const double in_a = a->second / per_cell[a->first];
        const double in_b = b->second / per_cell[b->first];
        if (in_a + in_b > 1.5) shared[{a->first, b->first}] += std::min(in_a, in_b);
      }
  for (const auto& [pair, cells] : shared) {
    if (cells < 1) continue;
    const std::string &first = scene.bodies[pair.first].name,
                      &second = scene.bodies[pair.second].name;
    findings.push_back(
        {Severity::warning, fmt::format("body.{}.shape", second),
         fmt::format("{} and {} overlap in about {} cells: these have twice the mass, and one "
                     "velocity for both bodies",
                     display_name("body", first), display_name("body", second), rough_text(cells)),
         "move them apart"});
  }
}

/// @param impact  m/s, of the snow's own: colliders have a finding of theirs
void check_fixed_steps(const sim::SolverSettings& s, double impact, const Check& check,
                       std::vector<Finding>& findings) {
  const double h = s.cell_size;
  // Semi-implicit steps bear faster sound: it counts as the slower one of an explicit step.
  const double sound_speed = check.start.max_sound_speed / sim::acoustic_stretch(s);
  // One step that keeps both limits: the advice of either finding is enough.
  const double holds = std::min(line(Law::acoustic_cfl) * h / std::max(1e-9, sound_speed),
                                s.cfl * h / std::max(1e-9, impact));
  const auto report = [&](Law law, double cfl, const char* what) {
    if (!(cfl > line(law))) return;
    const bool is_error = cfl > limits_of(law).check_error;
    findings.push_back(
        {is_error ? Severity::error : Severity::warning, "solver.dt",
         fmt::format("fixed steps of {} s: {} crosses {} cells in a step{}", rough_text(s.dt), what,
                     rough_text(cfl), is_error ? ", the run will diverge" : ""),
         scene::setting_text("solver.dt", holds, check.coarsening) +
             " holds, or time_step = \"adaptive\""});
  };
  report(Law::acoustic_cfl, sound_speed * s.dt / h, "sound");
  report(Law::speed_cfl, impact * s.dt / h, "snow at impact");
}

/// Adaptive steps are as long as acoustic_cfl says, also where nothing can hold them.
void check_adaptive_steps(const sim::SolverSettings& s, const Check& check,
                          std::vector<Finding>& findings) {
  if (s.is_implicit() || !(s.acoustic_cfl > sim::SolverSettings{}.acoustic_cfl)) return;
  const double cells = check.start.max_sound_speed * check.dt_start / s.cell_size;
  if (!(cells > limits_of(Law::acoustic_cfl).check_error)) return;
  findings.push_back(
      {Severity::error, "solver.acoustic_cfl",
       fmt::format("{} allows steps of {} s, in which sound crosses {} cells: the run will diverge",
                   rough_text(s.acoustic_cfl), rough_text(check.dt_start), rough_text(cells)),
       scene::setting_text("solver.acoustic_cfl", sim::SolverSettings{}.acoustic_cfl, 1) +
           " holds"});
}

/// Reports the damping of semi-implicit steps: a wave loses beta w^2 dt of its energy per second.
void check_implicit_steps(const sim::SolverSettings& s, const Check& check,
                          std::vector<Finding>& findings) {
  if (!s.is_implicit() || check.start.max_sound_speed <= 0) return;
  const double dt = check.dt_start, pi = 3.14159265358979323846;
  const double w = 2 * pi * check.start.max_sound_speed / (10 * s.cell_size);
  findings.push_back(
      {Severity::note, "solver.beta",
       fmt::format("semi-implicit steps: a wave 10 cells long keeps {} of its energy "
                   "after a period; the first steps {}",
                   percent_text(std::exp(-s.beta * w * w * dt * 2 * pi / w)),
                   std::isfinite(check.solve.residual)
                       ? fmt::format("took {} iterations to a residual of {}",
                                     check.solve.iterations, rough_text(check.solve.residual))
                       : "could not be solved, and shorter ones replaced them"),
       ""});
  if (check.solve.residual > s.solve_tolerance)
    findings.push_back(
        {Severity::warning, "solver.solve_iterations",
         "the solve ends above solve_tolerance = " + scene::toml::number_text(s.solve_tolerance),
         "try more iterations, or a smaller dt"});
}

/// A camera's view of the particles of a moment.
struct Seen {
  double outside = 0;  ///< share of them that it does not see
  double height = 0;   ///< of all that is before it, as a share of the picture's
};

Seen seen_by(const scene::CameraSettings& camera, double aspect,
             const setup::CoarseMoment& moment) {
  const Vec3d forward = (*camera.target - *camera.eye).normalized();
  const Vec3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
  const double half = std::tan(0.5 * camera.fov * 3.14159265358979323846 / 180);
  std::size_t inside = 0;
  double low = 1, high = -1, left = 1, wide = -1;
  for (const Vec3d& x : moment.x) {
    const Vec3d d = x - *camera.eye;
    const double z = d.dot(forward);
    if (!(z > 0)) continue;
    const double u = d.dot(right) / (half * z), v = d.dot(up) / (half * z);
    inside += std::abs(v) < 1 && std::abs(u) < aspect;
    low = std::min(low, v), high = std::max(high, v);
    left = std::min(left, u), wide = std::max(wide, u);
  }
  const std::size_t all = moment.x.size();
  return {static_cast<double>(all - inside) / static_cast<double>(std::max<std::size_t>(1, all)),
          0.5 * std::max(high - low, wide - left)};
}

/// Moves a camera that turns about its target to its place at a time, but not one with keyframes.
scene::CameraSettings moved(scene::CameraSettings camera, double time, double duration) {
  if (!camera.keyframes.empty()) return camera;
  const setup::CameraPlace place = setup::camera_at(camera, time, duration);
  camera.eye = place.eye;
  camera.target = place.target;
  camera.fov = place.fov;
  return camera;
}

}  // namespace

std::vector<Finding> law_findings(const sim::Material& m) {
  std::vector<sim::laws::Concern> concerns;
  if (const auto find = sim::laws::of(m).concerns) find(m, concerns);
  std::vector<Finding> findings;
  for (const sim::laws::Concern& concern : concerns)
    findings.push_back({Severity::warning, "material." + m.name + "." + concern.key,
                        filled(concern.text, concern.numbers),
                        filled(concern.remedy, {round_up(concern.remedy_number)})});
  return findings;
}

std::string vector_text(const Vec3d& v) {
  using scene::toml::number_text;
  return fmt::format("[{}, {}, {}]", number_text(v.x()), number_text(v.y()), number_text(v.z()));
}

std::string display_name(const std::string& kind, const std::string& name) {
  const bool is_number =
      std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
  return is_number ? kind + " " + name : name;
}

std::string percent_text(double share) {
  return fixed_text(100 * share, share < 0.1 ? 1 : 0) + " %";
}

double thickness(const sim::shapes::Shape& shape) {
  if (const auto* box = std::get_if<sim::shapes::Box>(&shape.form)) return box->size.minCoeff();
  if (const auto* torus = std::get_if<sim::shapes::Torus>(&shape.form))
    return 2 * torus->minor_radius;
  if (const auto* capsule = std::get_if<sim::shapes::Capsule>(&shape.form))
    return 2 * capsule->radius;
  if (const auto* c = std::get_if<sim::shapes::Cylinder>(&shape.form))
    return std::min(2 * c->radius, c->height);
  if (const auto* c = std::get_if<sim::shapes::Cone>(&shape.form))
    return std::min(2 * c->radius, c->height);
  if (const auto* sequence = std::get_if<sim::shapes::MeshSequence>(&shape.form))
    return sim::shapes::deforming_mesh(*sequence)->thickness();
  if (std::holds_alternative<sim::shapes::Terrain>(shape.form)) return INFINITY;
  if (const auto* cover = std::get_if<sim::shapes::Cover>(&shape.form)) return cover->depth;
  sim::shapes::Shape level = shape;
  level.rotation.setZero();
  return extent(level).minCoeff();
}

void check_units(const scene::Scene& scene, std::vector<Finding>& findings, double coarsening) {
  const std::vector<setup::SnowPiece> pieces = setup::snow_places(scene);
  std::vector<std::string> idle;
  for (const sim::Material& material : scene.materials) {
    const bool is_used =
        std::any_of(pieces.begin(), pieces.end(),
                    [&](const setup::SnowPiece& piece) { return piece.material == &material; });
    if (is_used) {
      check_material_units(material, findings);
      const std::vector<Finding> doubts = law_findings(material);
      findings.insert(findings.end(), doubts.begin(), doubts.end());
    } else if (material.name != sim::Material{}.name) {  // snow is there in every scene
      idle.push_back(material.name);
    }
  }
  if (!idle.empty())
    findings.push_back({Severity::warning, "material." + idle.front(),
                        fmt::format("no body and no emitter is of {}: {} numbers do nothing",
                                    first_joined(idle), idle.size() == 1 ? "its" : "their"),
                        fmt::format("{}.material = \"{}\"", pieces.front().address, idle.front())});
  if (const auto birth = dense_birth(scene))
    findings.push_back(
        {Severity::warning, birth->address, evidence_text(*birth), advice_text(*birth)});
  check_senses(scene, findings);
  const double g = scene.solver.gravity.norm();
  if (g > line(Law::gravity))
    findings.push_back({Severity::warning, "solver.gravity",
                        fmt::format("gravity of {} m/s2 is {} times that of the earth",
                                    rough_text(g), rough_text(g / 9.81)),
                        "981 would be cm/s2; lengths are in metres"});
  const double largest = setup::largest_extent(scene), cells = scene.solver.cell_size / coarsening;
  if (!setup::is_too_large(scene)) return;
  // With fewer cells than this across the snow, cell_size is in the same wrong unit.
  constexpr double few = 200;
  std::string hint = fmt::format("lengths are in metres: in centimetres it would be {} m",
                                 rough_text(0.01 * largest));
  if (largest < few * cells)
    hint += fmt::format(", with solver.cell_size = {}", scene::toml::number_text(0.01 * cells));
  findings.push_back({Severity::warning, pieces.front().address + ".shape",
                      fmt::format("the largest piece of snow is {} m across", rough_text(largest)),
                      hint});
}

/// True if a shape is thinner by more than rounding, as of 3 cells of 0.07 m and 0.21 m.
bool is_thinner(const sim::shapes::Shape& shape, double length) {
  return thickness(shape) < (1 - 1e-9) * length;
}

void check_resolution(const scene::Scene& scene, std::vector<Finding>& findings,
                      double coarsening) {
  const double h = scene.solver.cell_size;
  // From this thickness on, nodes have hardly any weight on both sides of a wall.
  const double apart = scene.solver.kernel == sim::Kernel::cubic ? 3 : 2.5;
  constexpr double coupled = 2;
  std::vector<Thin> bodies, colliders;
  for (const sim::seeding::Body& body : scene.bodies) {
    if (is_thinner(body.shape, 4 * h))
      bodies.push_back(
          {"body." + body.name, display_name("body", body.name), thickness(body.shape) / h});
    if (is_from_points(body)) {
      check_point_distance(body, h, coarsening, findings);
    } else if (body.particles_per_cell < line(Law::particles_per_cell)) {
      findings.push_back({Severity::warning, "body." + body.name + ".particles_per_cell",
                          rough_text(body.particles_per_cell) +
                              " particles per cell leave gaps, and snow breaks at them",
                          "8 is usual"});
    } else if (body.particles_per_cell > max_useful_per_cell) {
      const bool is_slip = body.particles_per_cell > 4 * max_useful_per_cell;
      findings.push_back({is_slip ? Severity::warning : Severity::note,
                          "body." + body.name + ".particles_per_cell",
                          rough_text(body.particles_per_cell) +
                              " particles per cell are more than the grid resolves, and each takes "
                              "its time",
                          "8 is usual; smaller cells show more"});
    }
  }
  for (const sim::shapes::Collider& collider : scene.colliders)
    if (!is_plane(collider.shape) && is_thinner(collider.shape, apart * h))
      colliders.push_back({"collider." + collider.name, display_name("collider", collider.name),
                           thickness(collider.shape) / h});
  report_thin(
      bodies,
      {"4", "weights reach 2 cells; use at least 6 to show its shape", h / 6, 4, coarsening},
      findings);
  report_thin(colliders,
              {rough_text(apart),
               "if snow lies on both of its sides, what slides on one side drags what lies on the "
               "other, because nodes reach over less than " +
                   rough_text(apart) + "; make it thicker",
               h / apart, coupled, coarsening},
              findings);
}

void check_overlaps(const scene::Scene& scene, const setup::SeededScene& seeded,
                    std::vector<Finding>& findings) {
  check_body_overlaps(scene, seeded, findings);
  check_collider_overlaps(scene, seeded, findings);
  check_points(scene, seeded, findings);
}

/// m/s, that a body may have at the end of the scene: what it would hit later counts for nothing.
double reachable_speed(const scene::Scene& scene) {
  double start = 0;
  for (const sim::seeding::Body& body : scene.bodies) start = std::max(start, body.velocity.norm());
  for (const auto& emitter : scene.emitters) start = std::max(start, emitter.velocity.norm());
  constexpr double rounding = 1.01;
  return rounding * (start + setup::largest_gravity(scene) * scene::duration(scene));
}

void check_steps(const scene::Scene& scene, const Check& check, std::vector<Finding>& findings) {
  if (scene.solver.time_step == sim::TimeStep::fixed)
    check_fixed_steps(scene.solver, setup::impact_speed(scene), check, findings);
  else
    check_adaptive_steps(scene.solver, check, findings);
  check_implicit_steps(scene.solver, check, findings);
  check_transfer(scene, check, findings);
  const setup::Impact& impact = check.hardest;
  const double c = check.sound_at_hardest();
  if (c > 0 && has_something_to_hit(scene) && impact.speed <= reachable_speed(scene) &&
      impact.speed > line(Law::impact_mach) * c)
    findings.push_back({Severity::warning, impact.address,
                        fmt::format("snow hits something at {} m/s, faster than its sound of {} "
                                    "m/s: a shock will crush it",
                                    rough_text(impact.speed), rough_text(c)),
                        "make it slower, or youngs_modulus larger"});
}

/// Neither "stop" nor "retry" has a rule for fixed steps: a single crushed particle may pass the
/// limit in a run that is good otherwise.
std::string unstable_steps(const sim::SolverSettings& settings, const sim::Warnings& warnings) {
  const sim::health::Limits& law = limits_of(Law::acoustic_cfl);
  const double worst = warnings.worst_acoustic_cfl;
  if (settings.time_step != sim::TimeStep::fixed || !(worst > law.stop)) return "";
  return fmt::format(
      "fixed steps: the acoustic CFL reached {}, and steps above {} are unstable: speeds, packing "
      "and energy of that snow, or of all, are false, though no rule stops{} fixed steps for it; "
      "try solver.time_step = \"adaptive\", or a solver.dt that is {} times shorter",
      fixed_text(worst, 1), rough_text(law.stop),
      settings.on_divergence == sim::OnDivergence::retry ? " or retries" : "",
      rough_text(worst / law.check_warning));
}

void check_cameras(const scene::Scene& scene, const std::vector<setup::CoarseMoment>& moments,
                   std::vector<Finding>& findings) {
  for (const scene::View& view : scene.views) {
    const scene::CameraSettings camera =
        view.camera ? *view.camera : scene.camera.value_or(scene::CameraSettings{});
    if (!camera.eye || !camera.target || !camera.follow.empty()) continue;
    const scene::PictureSize size = setup::size_of(scene, view);
    const double aspect = static_cast<double>(size.width) / size.height;
    double worst = 0, when = 0, largest = 0;
    for (const setup::CoarseMoment& moment : moments) {
      const scene::CameraSettings now = moved(camera, moment.time, scene::duration(scene));
      const Seen seen = seen_by(now, aspect, moment);
      largest = std::max(largest, seen.height);
      if (seen.outside > worst) worst = seen.outside, when = moment.time;
    }
    const std::string at = view.camera ? "view." + view.name + ".camera" : "camera";
    constexpr double smallest = 0.03;
    if (worst < 0.05 && largest < smallest)
      findings.push_back({Severity::warning, at,
                          fmt::format("view {}: the snow is never larger than {} of the picture",
                                      view.name, percent_text(largest)),
                          "move eye nearer, or remove eye and target to frame everything"});
    if (worst < 0.05) continue;
    findings.push_back({Severity::warning, at,
                        fmt::format("view {}: {} of the snow is outside of the picture at {} s",
                                    view.name, percent_text(worst), rough_text(when)),
                        "remove eye and target to frame everything"});
  }
}

}  // namespace neve::app::health
