/// Findings about dust before a run.

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/health/findings.h"
#include "app/scene/coarsen.h"
#include "app/setup/curves.h"
#include "app/support/text.h"

namespace neve::app::health {

namespace {

bool is_shown(const scene::Scene& scene) {
  return std::any_of(
             scene.views.begin(), scene.views.end(),
             [](const scene::View& view) { return scene::has_layer(view, scene::Layer::dust); }) ||
         std::any_of(scene.exports.begin(), scene.exports.end(),
                     [](const scene::Export& e) { return e.dust; });
}

}  // namespace

std::string advice_on_dust(const scene::Scene& scene) {
  return "material." + scene::materials_of_snow(scene).front().name + ".dust = 0.02";
}

void check_dust(const scene::Scene& scene, double speed, std::vector<Finding>& findings) {
  const sim::DustSettings& d = scene.solver.dust;
  const sim::Material* dusty = scene::dusty_material(scene);
  if (!dusty) {
    const std::string hint = advice_on_dust(scene);
    if (d != sim::DustSettings{} && !scene::has_spray_drag(scene))
      findings.push_back(
          {Severity::warning, "dust", "it has no effect: no snow of the scene sheds dust", hint});
    for (const scene::Export& e : scene.exports)
      if (e.dust)
        findings.push_back({Severity::warning, "export." + e.name + ".dust",
                            "its files are empty: no snow of the scene sheds dust", hint});
    return;
  }
  const std::string address = "material." + dusty->name + ".dust";
  const scene::Curve* curve = setup::curve_of(scene, address);
  if (speed + d.wind.norm() <= d.speed)
    findings.push_back(
        {Severity::warning, "dust.speed",
         fmt::format("snow gets no faster than about {} m/s, and sheds dust from {} m/s on",
                     rough_text(speed), rough_text(d.speed)),
         fmt::format("dust.speed = {}", rough_text(0.3 * speed))});
  if (d.min_J_P > dusty->max_J_P)
    findings.push_back({Severity::warning, "dust.min_J_P",
                        fmt::format("{} gets no looser than J_P = {}: it never sheds dust",
                                    dusty->name, rough_text(dusty->max_J_P)),
                        "dust.min_J_P = 0.9"});
  if (!is_shown(scene))
    findings.push_back({Severity::note, address, "dust flies, and no view and no export shows it",
                        scene.views.empty()
                            ? "add \"dust\" to the layers of a view"
                            : "add \"dust\" to view." + scene.views.front().name + ".layers"});
  findings.push_back(
      {Severity::note, address,
       fmt::format("up to {} particles of dust, and the air around them, take time beside the snow",
                   about_count_text(d.particles)),
       (curve ? "curve." + curve->name + ".keyframes of 0" : address + " = 0") +
           (scene::has_spray_drag(scene) ? " and dust.spray_drag = 0 are snow without air"
                                         : " is the same snow without it")});
}

}  // namespace neve::app::health
