/// Findings about settings that a run never shows.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/health/findings.h"
#include "app/scene/coarsen.h"
#include "app/scene/flat.h"
#include "app/scene/names.h"
#include "app/scene/presets.h"
#include "app/scene/toml/value.h"
#include "app/setup/auto_ranges.h"
#include "app/setup/curves.h"
#include "app/support/text.h"
#include "sim/laws/law.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/placed_points.h"
#include "sim/shapes/solid.h"

namespace neve::app::health {

namespace {

using sim::Vec3d;

/// The share of a solid, mesh or not, that a sink removes: of its points on a lattice.
double share_removed(const sim::shapes::Solid& solid, const sim::shapes::Solid& sink,
                     bool outside) {
  constexpr int side = 14;
  const sim::shapes::Bounds box = solid.local_bounds();
  std::size_t inside = 0, removed = 0;
  for (int k = 0; k < side * side * side; ++k) {
    const Vec3d part((k % side + 0.5) / side, (k / side % side + 0.5) / side,
                     (k / side / side + 0.5) / side);
    const Vec3d y = box.min + part.cwiseProduct(box.max - box.min);
    if (!solid.contains_local(y)) continue;
    ++inside;
    removed += sink.contains(solid.center() + solid.rotation() * y) != outside;
  }
  return inside == 0 ? 0 : static_cast<double>(removed) / static_cast<double>(inside);
}

/// Snow that is removed before anything happens to it.
void check_removed(const scene::Scene& scene, const std::string& kind, const std::string& name,
                   const sim::shapes::Shape& shape, double least, std::vector<Finding>& findings) {
  if (scene.sinks.empty() || std::holds_alternative<sim::shapes::Points>(shape.form)) return;
  const sim::shapes::Solid solid(shape);
  for (const sim::seeding::Sink& sink : scene.sinks) {
    const double share = share_removed(solid, sim::shapes::Solid(sink.shape), sink.outside);
    if (share < least) continue;
    findings.push_back(
        {Severity::warning, kind + "." + name + ".shape",
         fmt::format("{} of {} is {} of {}, which removes it at once", percent_text(share),
                     display_name(kind, name), sink.outside ? "outside" : "inside",
                     display_name("sink", sink.name)),
         sink.outside ? "make the sink larger, or move the snow into it" : "move one of them"});
  }
}

/// @param address  of what has keyframes, the last one at a time, s
void check_last_keyframe(const scene::Scene& scene, const std::string& address,
                         const std::string& name, double last, std::vector<Finding>& findings) {
  const double end = scene::duration(scene);
  if (end > 0 && last > end * (1 + 1e-9))
    findings.push_back({Severity::warning, address + ".keyframes",
                        fmt::format("the last keyframe of {} is at {} s, the scene ends at {} s",
                                    name, rough_text(last), rough_text(end)),
                        "make frames larger, or move keyframes earlier"});
}

/// True if a view sets anything of a slice other than its automatic place.
bool asks_for_slice(const scene::SliceStyle& s) {
  const scene::SliceStyle usual;
  return s.field != usual.field || s.scalar != usual.scalar || s.normal != usual.normal ||
         s.point || !s.follow.empty() || s.motion != usual.motion || s.every != usual.every ||
         s.dense_near || s.arrow_scale != usual.arrow_scale || s.isolines != usual.isolines ||
         s.range || s.scalar_range || s.colormap != usual.colormap ||
         s.scalar_colormap != usual.scalar_colormap;
}

void check_slices(const scene::Scene& scene, std::vector<Finding>& findings) {
  for (const scene::View& view : scene.views)
    if (!scene::shows_slice(view) && asks_for_slice(view.slice))
      findings.push_back(
          {Severity::warning, "view." + view.name + ".slice",
           fmt::format("no layer of view {} shows a slice", view.name),
           fmt::format("add \"arrows\", \"streamlines\" or \"heatmap\" to view.{}.layers",
                       view.name)});
}

/// A mosaic has words and gaps between its tiles: it is for the eye, and not for compositing.
void note_mosaics(const scene::Scene& scene, std::vector<Finding>& findings) {
  for (const scene::Mosaic& mosaic : scene.mosaics)
    for (const scene::View& view : scene.views)
      if (std::ranges::find(mosaic.views, view.name) != mosaic.views.end() &&
          scene::background_of(scene, view) == scene::Background::transparent) {
        findings.push_back(
            {Severity::note, "mosaic." + mosaic.name,
             fmt::format("is opaque, and draws view {} over the gradient", view.name),
             fmt::format("--view {} draws it over a transparent background", view.name)});
        break;
      }
}

/// Views of nothing: layers without snow, and slices that lie beside it from beginning to end.
void check_snow_in_views(const scene::Scene& scene, std::vector<Finding>& findings) {
  using scene::Layer;
  if (scene.bodies.empty() || !scene.emitters.empty()) return;
  sim::shapes::Bounds all;
  for (const sim::seeding::Body& body : scene.bodies) all.add(sim::shapes::bounds(body.shape));
  // Snow that falls or flies across a plane may come to it.
  const auto stays = [&](const sim::Vec3d& normal) {
    double across = setup::largest_at_moments(
        scene, [&](const scene::Scene& then) { return std::abs(then.solver.gravity.dot(normal)); });
    for (const sim::seeding::Body& body : scene.bodies)
      across += std::abs(body.velocity.dot(normal)) + setup::own_speed(body.shape);
    return across < 1e-9;
  };
  // Distances from a plane to the nearest and the farthest corner, along its normal.
  const auto ends = [&](const sim::Vec3d& point, const sim::Vec3d& normal) {
    const sim::Vec3d half = 0.5 * (all.max - all.min);
    const double away = (all.center() - point).dot(normal), reach = half.dot(normal.cwiseAbs());
    return std::pair(away - reach, away + reach);
  };
  constexpr double sizes_away = 1;  // of the snow, which spreads
  const double room = sizes_away * all.diagonal();
  for (const scene::View& view : scene.views) {
    const auto add = [&](const std::string& part, const std::string& what, const char* advice) {
      findings.push_back({Severity::warning, "view." + view.name + part, what, advice});
    };
    const bool has_snow =
        scene::shows_particles(view) || scene::shows_slice(view) ||
        scene::has_layer(view, Layer::smoke) || scene::has_layer(view, Layer::dust) ||
        scene::has_layer(view, Layer::blocks) || scene::has_layer(view, Layer::bounds);
    if (!has_snow) {
      add(".layers", fmt::format("no layer of view {} shows snow", view.name),
          "add \"snow\", \"particles\" or \"smoke\"");
      continue;
    }
    const scene::SliceStyle& slice = view.slice;
    const sim::Vec3d across = slice.normal.normalized();
    if (scene::shows_slice(view) && slice.point && slice.follow.empty() &&
        slice.motion.dot(across) == 0 && stays(across)) {
      const auto [low, high] = ends(*slice.point, across);
      if (low > room || high < -room)
        add(".slice.point", fmt::format("the slice of view {} lies beside the snow", view.name),
            "remove it: without a point the slice goes through the middle of the bodies");
    }
  }
}

struct Idle {
  std::string why, advice;
};

std::string last_word_of(const std::string& address) {
  return address.substr(address.rfind('.') + 1);
}

bool is_one_of(const std::string& key, std::initializer_list<const char*> keys) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// A number that is this one, and follows no curve that would make it another.
bool stays(const scene::Scene& scene, const std::string& address, double value, double at) {
  return value == at && !setup::curve_of(scene, address);
}

/// True where all snow, or whatever the bodies are of, has a law that has something.
template <class Has>
bool all_snow(const scene::Scene& scene, const Has& has) {
  return std::ranges::all_of(scene::materials_of_snow(scene), has);
}
bool never_yields(const sim::Material& m) {
  return !sim::laws::of(m).is_plastic && !m.yields;
}

/// A setting of the transfer is idle where its number, or the snow itself, leaves it nothing to do.
std::optional<Idle> idle_in_transfer(const scene::Scene& scene, const std::string& key) {
  const sim::SolverSettings& s = scene.solver;
  const auto is_ratio = [&](double at) {
    return stays(scene, "solver.flip_ratio", s.flip_ratio, at);
  };
  if (key == "flip_reference_dt" && (is_ratio(0) || is_ratio(1)))
    return Idle{fmt::format("flip_ratio = {} is the same for steps of any length", s.flip_ratio),
                "remove it, or give flip_ratio a value between 0 and 1"};
  if (is_one_of(key, {"separation_min", "separation_max", "separation_J_E"})) {
    if (is_ratio(0))
      return Idle{"with flip_ratio = 0 particles keep no velocity of their own to move with",
                  "remove it, or set a larger solver.flip_ratio"};
    if (all_snow(scene, never_yields))
      return Idle{"nothing in the scene yields, and what is elastic moves with the grid",
                  "remove it"};
  }
  if (key == "separation_J_E" && s.separation_min == s.separation_max &&
      stays(scene, "solver.separation_min", s.separation_min, s.separation_max) &&
      stays(scene, "solver.separation_max", s.separation_max, s.separation_min))
    return Idle{fmt::format("separation_min and separation_max are both {}", s.separation_min),
                "remove it, or make the two differ"};
  if (key == "shock_viscosity" && all_snow(scene, never_yields))
    return Idle{"nothing in the scene yields, and what is elastic has no such viscosity",
                "remove it"};
  if (key == "threshold_cell" &&
      all_snow(scene, [](const sim::Material& m) { return !sim::laws::of(m).refine; }))
    return Idle{"no material in the scene has thresholds of snow", "remove it"};
  return std::nullopt;
}

/// Finds why a setting of the solver is idle: other settings, or the snow, switch it off.
std::optional<Idle> idle_in_solver(const scene::Scene& scene, const std::string& key) {
  const sim::SolverSettings& s = scene.solver;
  const bool is_fixed = s.time_step == sim::TimeStep::fixed,
             is_implicit = s.is_implicit() || setup::curve_of(scene, "solver.beta"),
             is_asflip = s.transfer == sim::Transfer::asflip,
             is_aflip = s.transfer == sim::Transfer::aflip;
  if (key == "dt" && !is_fixed)
    return Idle{"adaptive steps are chosen by the state; it is for time_step = \"fixed\"",
                "set time_step = \"fixed\"; solver.max_dt limits adaptive steps"};
  // Explicit parts of a solve that is given up keep two of the limits.
  const bool is_limit = is_one_of(key, {"max_dt", "strain_limit"}) ||
                        (is_one_of(key, {"cfl", "acoustic_cfl"}) && !is_implicit);
  if (is_limit && is_fixed)
    return Idle{"it limits adaptive steps, and time_step = \"fixed\" takes dt",
                "remove it, or set solver.time_step = \"adaptive\""};
  if (key == "advect" && (is_asflip || is_aflip))
    return Idle{"aflip moves particles with the grid's velocity, asflip with a share of theirs",
                "remove it; solver.separation_min and separation_max are asflip's shares"};
  if (is_one_of(key, {"separation_min", "separation_max", "separation_J_E"}) && !is_asflip)
    return Idle{"it is for transfer = \"asflip\"",
                "remove it, or set solver.transfer = \"asflip\""};
  if (is_one_of(key, {"flip_ratio", "flip_reference_dt"}) &&
      (s.transfer == sim::Transfer::apic || s.transfer == sim::Transfer::mls))
    return Idle{fmt::format("transfer = \"{}\" has no share of FLIP", scene::name(s.transfer)),
                "remove it, or set solver.transfer = \"asflip\", \"aflip\" or \"flip\""};
  if (is_one_of(key, {"solve_tolerance", "solve_iterations"}) && !is_implicit)
    return Idle{"it is for semi-implicit steps", "remove it, or set solver.beta, as to 0.5"};
  if (key == "collide_after_solve" && !(is_implicit && s.contact_at == sim::ContactAt::nodes))
    return Idle{"it is for semi-implicit steps with contact at nodes",
                "solver.collide_after_solve = false"};
  return idle_in_transfer(scene, key);
}

/// A parameter is idle that another law than the material's has, or that another number switches
/// off.
std::optional<Idle> idle_in_material(const scene::Scene& scene, const sim::Material& m,
                                     const std::string& key) {
  const auto has = [&](std::span<const sim::laws::Parameter> list) {
    return std::ranges::find(list, key, &sim::laws::Parameter::key) != list.end();
  };
  const sim::laws::Law& law = sim::laws::of(m);
  const sim::Variation& variation = m.variation;
  if (key == "variation.size" && variation.density == 0 && variation.youngs_modulus == 0 &&
      variation.thresholds == 0)
    return Idle{
        fmt::format("nothing of {} varies", m.name),
        fmt::format("give material.{}.variation.thresholds, density or youngs_modulus", m.name)};
  if (key == "variation.thresholds" && never_yields(m))
    return Idle{fmt::format("material {} has model = \"{}\", which never yields", m.name, law.name),
                fmt::format("material.{}.variation.youngs_modulus varies its stiffness", m.name)};
  if ((key == "min_J_P" || key == "max_J_P") && never_yields(m))
    return Idle{fmt::format("material {} has model = \"{}\", which never yields", m.name, law.name),
                "remove it: J_P changes by yielding alone"};
  if (key == "min_J_P" && law.is_granular)
    return Idle{fmt::format("grains of material {} are never packed", m.name), "remove it"};
  if (key == "max_hardening" && !law.hardens)
    return Idle{
        fmt::format("material {} has model = \"{}\", whose stiffness stays", m.name, law.name),
        "remove it"};
  if (key == "max_hardening" && stays(scene, "material." + m.name + ".hardening", m.hardening, 0))
    return Idle{fmt::format("material {} does not harden: hardening = 0", m.name), "remove it"};
  if (!has(sim::laws::all_parameters()) || has(law.parameters)) return std::nullopt;
  return Idle{
      fmt::format("material {} has model = \"{}\", which does not use it", m.name, law.name),
      "neve params --wishes names parameters by what they do"};
}

/// Finds why a setting of a body is idle: the points of its file take its place.
std::optional<Idle> idle_in_body(const sim::seeding::Body& body, const std::string& key) {
  const auto* points = std::get_if<sim::shapes::Points>(&body.shape.form);
  if (!points) return std::nullopt;
  if (is_one_of(key, {"particles_per_cell", "sampling"}))
    return Idle{"the points of its file are its particles",
                "remove it; shape.points.thinning takes fewer of them"};
  if (key == "shape.points.spacing" &&
      sim::shapes::summary_of(*points, sim::Mat3d::Identity()).has_volumes)
    return Idle{"the file has the volume of each point", "remove it"};
  return std::nullopt;
}

/// Finds why a setting of a collider is idle: its other settings, or its file, switch it off.
std::optional<Idle> idle_in_collider(const scene::Scene& scene, const scene::Collider& collider,
                                     const std::string& key) {
  using sim::shapes::Joint;
  const auto& body = collider.body;
  const bool has_axis = body.joint == Joint::hinge || body.joint == Joint::slider,
             has_point = body.joint == Joint::hinge || body.joint == Joint::ball;
  if (key == "joint_axis" && !has_axis)
    return Idle{"only a hinge or a slider has an axis", "give joint = \"hinge\" or \"slider\""};
  if (key == "joint_point" && !has_point)
    return Idle{"only a hinge or a ball joint has a point", "give joint = \"hinge\" or \"ball\""};
  const auto stays_0 = [&](const char* name, double value) {
    return stays(scene, "collider." + collider.name + "." + name, value, 0);
  };
  if (key == "spring_place" && stays_0("spring_stiffness", body.spring_stiffness) &&
      stays_0("spring_damping", body.spring_damping))
    return Idle{"the spring has no stiffness", "give spring_stiffness, in N/m"};
  if (key == "friction" && collider.contact != sim::shapes::Contact::separate)
    return Idle{fmt::format("contact = \"{}\" has no friction", scene::name(collider.contact)),
                "set contact = \"separate\""};
  if (const auto* terrain = std::get_if<sim::shapes::Terrain>(&collider.shape.form);
      terrain &&
      is_one_of(key, {"shape.terrain.spacing", "shape.terrain.low", "shape.terrain.high"}) &&
      !sim::shapes::takes_scale(*terrain))
    return Idle{"it is for a PNG, and the file is a grid, which says its own spacing and heights",
                "remove it; the numbers of the grid have to be metres"};
  return std::nullopt;
}

/// Finds why a setting of dust is idle: no snow sheds it. Drag of spray and its air need no dust.
std::optional<Idle> idle_in_dust(const scene::Scene& scene, const std::string& key) {
  const bool is_of_air = key == "wind" || key == "air_cell" || key == "speed";
  if (key == "spray_drag" || scene::dusty_material(scene) ||
      (is_of_air && scene::has_spray_drag(scene)))
    return std::nullopt;
  return Idle{"no snow of the scene sheds dust", advice_on_dust(scene)};
}

std::optional<Idle> idle_at(const scene::Scene& scene, const std::string& address) {
  const auto key_in = [&](const std::string& table) {
    return address.starts_with(table) ? address.substr(table.size()) : "";
  };
  if (const std::string key = key_in("solver."); !key.empty()) return idle_in_solver(scene, key);
  for (const sim::Material& m : scene.materials)
    if (const std::string key = key_in("material." + m.name + "."); !key.empty())
      return idle_in_material(scene, m, key);
  for (const sim::seeding::Body& body : scene.bodies)
    if (const std::string key = key_in("body." + body.name + "."); !key.empty())
      return idle_in_body(body, key);
  for (const scene::Collider& collider : scene.colliders)
    if (const std::string key = key_in("collider." + collider.name + "."); !key.empty())
      return idle_in_collider(scene, collider, key);
  if (const std::string key = key_in("dust."); !key.empty()) return idle_in_dust(scene, key);
  return std::nullopt;
}

/// The default, or what --coarsen makes of it. A scene that was written coarse does not say by how
/// much: its thresholds do, and where it has none, that both steps have grown alike.
bool is_usual(const scene::Scene& scene, const scene::FlatParam& param, double coarsening) {
  if (param.is_default()) return true;
  const sim::SolverSettings &s = scene.solver, usual;
  const bool is_dt = param.address == "solver.dt";
  if (!is_dt && param.address != "solver.max_dt") return false;
  const double growth = is_dt ? s.dt / usual.dt : s.max_dt / usual.max_dt,
               other = is_dt ? s.max_dt / usual.max_dt : s.dt / usual.dt,
               written = s.threshold_cell > 0 ? s.cell_size / s.threshold_cell : other;
  return std::ranges::any_of(std::array{coarsening, written}, [&](double factor) {
    return factor >= 1 && std::abs(growth / factor - 1) < 1e-3;
  });
}

bool is_set_by_preset(const scene::Scene& scene, const std::string& address) {
  return std::ranges::any_of(scene.materials, [&](const sim::Material& m) {
    const std::string at = "material." + m.name + ".";
    return address.starts_with(at) && scene::is_number_of_its_preset(m, address.substr(at.size()));
  });
}

/// Settings of the scene that others switch off.
void check_switched_off(const scene::Scene& scene, double coarsening,
                        std::vector<Finding>& findings) {
  for (const scene::FlatParam& param : scene::flatten(scene)) {
    if (is_usual(scene, param, coarsening) || setup::curve_of(scene, param.address)) continue;
    if (param.address.starts_with("dust.") && !scene::has_spray_drag(scene))
      continue;  // check_dust() tells all of it at once
    if (is_set_by_preset(scene, param.address)) continue;
    if (const std::optional<Idle> idle = idle_at(scene, param.address))
      findings.push_back(
          {Severity::warning, param.address,
           fmt::format("{} has no effect: {}", last_word_of(param.address), idle->why),
           idle->advice});
  }
}

std::string value_text(const std::optional<scene::toml::Value>& value) {
  return value ? scene::toml::toml_literal(*value) : "none";
}

/// Keyframes that no frame has, and values that the scene gives beside a curve.
void check_curves(const scene::Scene& scene, double coarsening, std::vector<Finding>& findings) {
  if (scene.curves.empty()) return;
  const std::vector<scene::FlatParam> params = scene::flatten(scene);
  const std::vector<scene::Override> first = setup::curve_values(scene, 0);
  for (std::size_t k = 0; k < std::min(first.size(), scene.curves.size()); ++k) {
    const scene::Curve& curve = scene.curves[k];
    check_last_keyframe(scene, "curve." + curve.name, curve.parameter, curve.keyframes.back().time,
                        findings);
    if (idle_at(scene, curve.parameter)) continue;  // check_idle() tells it
    findings.push_back(
        {Severity::note, curve.parameter,
         fmt::format("follows {} keyframes, from {} to {}", curve.keyframes.size(), first[k].value,
                     setup::curve_values(scene, scene::last_frame(scene))[k].value),
         "the forecast follows it in a coarse copy"});
    for (const scene::FlatParam& param : params)
      if (param.address == curve.parameter && !is_usual(scene, param, coarsening) &&
          value_text(param.value) != first[k].value)
        findings.push_back({Severity::warning, curve.parameter,
                            fmt::format("{} is not used: the curve {} begins with {}",
                                        value_text(param.value), curve.name, first[k].value),
                            "remove one of the two"});
  }
}

}  // namespace

std::string why_idle(const scene::Scene& scene, const std::string& address) {
  const std::optional<Idle> idle = idle_at(scene, address);
  return idle ? idle->why : "";
}

void check_idle(const scene::Scene& scene, std::vector<std::string> addresses,
                std::vector<Finding>& findings) {
  for (const scene::Curve& curve : scene.curves) addresses.push_back(curve.parameter);
  for (const std::string& address : addresses) {
    const std::optional<Idle> idle = idle_at(scene, address);
    if (!idle || std::ranges::find(findings, address, &Finding::address) != findings.end())
      continue;
    const scene::Curve* curve = setup::curve_of(scene, address);
    findings.push_back(
        {Severity::warning, address,
         fmt::format("{}{} has no effect: {}", last_word_of(address),
                     curve ? ", which curve " + curve->name + " sets," : "", idle->why),
         idle->advice});
  }
}

void check_unused(const scene::Scene& scene, double coarsening, std::vector<Finding>& findings) {
  // Most snow escapes from an emitter that only touches a sink; a third lost is a mistake.
  constexpr double whole = 0.999, much = 0.3;
  for (const sim::seeding::Body& body : scene.bodies)
    check_removed(scene, "body", body.name, body.shape, whole, findings);
  for (const sim::seeding::Emitter& emitter : scene.emitters)
    check_removed(scene, "emitter", emitter.name, emitter.shape, much, findings);
  for (const scene::Collider& collider : scene.colliders)
    if (collider.keyframes.size() >= 2)
      check_last_keyframe(scene, "collider." + collider.name,
                          display_name("collider", collider.name), collider.keyframes.back().time,
                          findings);
  check_curves(scene, coarsening, findings);
  check_slices(scene, findings);
  note_mosaics(scene, findings);
  check_snow_in_views(scene, findings);
  check_switched_off(scene, coarsening, findings);
}

}  // namespace neve::app::health
