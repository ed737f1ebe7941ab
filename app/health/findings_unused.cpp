/// Findings about settings that a run never shows.

#include <fmt/core.h>

#include <algorithm>
#include <span>

#include "app/health/findings.h"
#include "app/scene/flat.h"
#include "app/scene/toml/value.h"
#include "app/setup/curves.h"
#include "app/support/text.h"
#include "sim/laws/law.h"
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

void check_keyframes(const scene::Scene& scene, std::vector<Finding>& findings) {
  const double end = scene::duration(scene);
  for (const scene::Collider& collider : scene.colliders) {
    if (collider.keyframes.size() < 2 || end <= 0) continue;
    const double last = collider.keyframes.back().time;
    if (last <= end * (1 + 1e-9)) continue;
    findings.push_back(
        {Severity::warning, "collider." + collider.name + ".keyframes",
         fmt::format("the last keyframe of {} is at {} s, the scene ends at {} s",
                     display_name("collider", collider.name), rough_text(last), rough_text(end)),
         "make frames larger, or move keyframes earlier"});
  }
}

std::string value_text(const std::optional<scene::toml::Value>& value) {
  return value ? scene::toml::toml_literal(*value) : "none";
}

/// Keyframes that no frame has, and values that the scene gives beside a curve.
void check_curves(const scene::Scene& scene, std::vector<Finding>& findings) {
  if (scene.curves.empty()) return;
  const double end = scene::duration(scene);
  const std::vector<scene::FlatParam> params = scene::flatten(scene);
  const std::vector<scene::Override> first = setup::curve_values(scene, 0);
  for (std::size_t k = 0; k < std::min(first.size(), scene.curves.size()); ++k) {
    const scene::Curve& curve = scene.curves[k];
    const double last = curve.keyframes.back().time;
    if (end > 0 && last > end * (1 + 1e-9))
      findings.push_back({Severity::warning, "curve." + curve.name + ".keyframes",
                          fmt::format("the last keyframe of {} is at {} s, the scene ends at {} s",
                                      curve.parameter, rough_text(last), rough_text(end)),
                          "make frames larger, or move keyframes earlier"});
    findings.push_back(
        {Severity::note, curve.parameter,
         fmt::format("follows {} keyframes, from {} to {}", curve.keyframes.size(), first[k].value,
                     setup::curve_values(scene, scene::last_frame(scene))[k].value),
         "the forecast follows it in a coarse copy"});
    for (const scene::FlatParam& param : params)
      if (param.address == curve.parameter && !param.is_default() &&
          value_text(param.value) != first[k].value)
        findings.push_back({Severity::warning, curve.parameter,
                            fmt::format("{} is not used: the curve {} begins with {}",
                                        value_text(param.value), curve.name, first[k].value),
                            "remove one of the two"});
  }
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

/// Views of nothing: layers without snow, and slices that lie beside it from beginning to end.
void check_snow_in_views(const scene::Scene& scene, std::vector<Finding>& findings) {
  using scene::Layer;
  if (scene.bodies.empty() || !scene.emitters.empty()) return;
  sim::shapes::Bounds all = sim::shapes::bounds(scene.bodies.front().shape);
  for (const sim::seeding::Body& body : scene.bodies) {
    const sim::shapes::Bounds bounds = sim::shapes::bounds(body.shape);
    all.min = all.min.cwiseMin(bounds.min);
    all.max = all.max.cwiseMax(bounds.max);
  }
  // Snow that falls or flies across a plane may come to it.
  const auto stays = [&](const sim::Vec3d& normal) {
    double across = std::abs(scene.solver.gravity.dot(normal));
    for (const sim::seeding::Body& body : scene.bodies)
      across += std::abs(body.velocity.dot(normal));
    return across < 1e-9;
  };
  // Distances from a plane to the nearest and the farthest corner, along its normal.
  const auto ends = [&](const sim::Vec3d& point, const sim::Vec3d& normal) {
    const sim::Vec3d middle = 0.5 * (all.min + all.max), half = 0.5 * (all.max - all.min);
    const double away = (middle - point).dot(normal), reach = half.dot(normal.cwiseAbs());
    return std::pair(away - reach, away + reach);
  };
  constexpr double sizes_away = 1;  // of the snow, which spreads
  const double room = sizes_away * (all.max - all.min).norm();
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

/// Settings that the transfer of a scene does not read.
void check_transfer_settings(const sim::SolverSettings& s, std::vector<Finding>& findings) {
  const sim::SolverSettings usual;
  const bool is_asflip = s.transfer == sim::Transfer::asflip;
  const auto unused = [&](const char* key, const char* why, const char* advice) {
    findings.push_back({Severity::warning, std::string("solver.") + key,
                        fmt::format("{} has no effect: {}", key, why), advice});
  };
  if (s.advect != usual.advect && (is_asflip || s.transfer == sim::Transfer::aflip))
    unused("advect",
           "aflip moves particles with the grid's velocity, asflip with a share of theirs",
           "remove it; solver.separation_min and separation_max are asflip's shares");
  if (is_asflip) return;
  const char* const why = "it is for transfer = \"asflip\"";
  const char* const advice = "remove it, or set solver.transfer = \"asflip\"";
  if (s.separation_min != usual.separation_min) unused("separation_min", why, advice);
  if (s.separation_max != usual.separation_max) unused("separation_max", why, advice);
  if (s.separation_J_E != usual.separation_J_E) unused("separation_J_E", why, advice);
}

}  // namespace

std::string why_idle(const scene::Scene& scene, const std::string& address) {
  if (address == "solver.dt" && scene.solver.time_step == sim::TimeStep::adaptive)
    return "adaptive steps are chosen by the state; it is for time_step = \"fixed\"";
  for (const sim::Material& m : scene.materials) {
    const std::string table = "material." + m.name + ".";
    if (!address.starts_with(table)) continue;
    const auto has = [&](std::span<const sim::laws::Parameter> list) {
      return std::ranges::any_of(list, [&](const sim::laws::Parameter& p) {
        return p.key == address.substr(table.size());
      });
    };
    const sim::laws::Law& law = sim::laws::of(m);
    if (has(sim::laws::all_parameters()) && !has(law.parameters))
      return fmt::format("material {} has model = \"{}\", which does not use it", m.name, law.name);
  }
  return {};
}

void check_idle(const scene::Scene& scene, const std::vector<std::string>& addresses,
                std::vector<Finding>& findings) {
  const auto is_told = [&](const std::string& address) {
    return std::ranges::find(findings, address, &Finding::address) != findings.end();
  };
  for (const std::string& address : addresses)
    if (const std::string why = why_idle(scene, address); !why.empty() && !is_told(address))
      findings.push_back(
          {Severity::warning, address,
           fmt::format("{} has no effect: {}", address.substr(address.rfind('.') + 1), why),
           "neve params --wishes names parameters by what they do"});
}

void check_unused(const scene::Scene& scene, double coarsening, std::vector<Finding>& findings) {
  // Most snow escapes from an emitter that only touches a sink; a third lost is a mistake.
  constexpr double whole = 0.999, much = 0.3;
  for (const sim::seeding::Body& body : scene.bodies)
    check_removed(scene, "body", body.name, body.shape, whole, findings);
  for (const sim::seeding::Emitter& emitter : scene.emitters)
    check_removed(scene, "emitter", emitter.name, emitter.shape, much, findings);
  check_keyframes(scene, findings);
  check_curves(scene, findings);
  check_slices(scene, findings);
  check_snow_in_views(scene, findings);
  const double usual_dt = sim::SolverSettings{}.dt * coarsening, dt = scene.solver.dt;
  if (scene.solver.time_step == sim::TimeStep::adaptive &&
      !(dt > 0.999 * usual_dt && dt < 1.001 * usual_dt))
    findings.push_back({Severity::warning, "solver.dt",
                        fmt::format("adaptive steps do not use dt = {} s",
                                    scene::toml::number_text(dt / coarsening)),
                        "set time_step = \"fixed\"; solver.max_dt limits adaptive steps"});
  const sim::SolverSettings& s = scene.solver;
  if (s.collide_after_solve && !(s.is_implicit() && s.contact_at == sim::ContactAt::nodes))
    findings.push_back(
        {Severity::warning, "solver.collide_after_solve",
         "collide_after_solve has no effect: it is for semi-implicit steps with contact at nodes",
         "solver.collide_after_solve = false"});
  check_transfer_settings(s, findings);
}

}  // namespace neve::app::health
