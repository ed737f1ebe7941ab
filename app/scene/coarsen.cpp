#include "app/scene/coarsen.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/scene/describe.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "sim/laws/law.h"

namespace neve::app::scene {
namespace {

std::string argument(double factor) {
  return "--coarsen " + toml::number_text(factor);
}

/// Looks for a number of the solver, or of a curve, outside the range that its description gives.
struct RangeCheck {
  double factor;
  const std::vector<Curve>& curves;

  void operator()(const char* key, double member, const char*, const Valid& valid, Change,
                  const char*) const {
    const std::string address = std::string("solver.") + key;
    check(address, member, valid);
    for (const Curve& curve : curves)
      for (const CurveKeyframe& keyframe : curve.keyframes)
        if (curve.parameter == address && keyframe.value) check(address, *keyframe.value, valid);
  }
  void check(const std::string& address, double value, const Valid& valid) const {
    if (valid.contains(value)) return;
    throw UsageError(argument(factor), address + " would become " + toml::number_text(value),
                     "expected " + valid.text_of_bounds());
  }
  template <class T>
  void operator()(const char*, const T&, const char*, const Valid&, Change, const char*) const {}
};

/// Twelve digits: 0.018 times 1.5 is 0.027, not 0.026999999999999996.
double tidy(double x) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, x, std::chars_format::general, 12);
  std::from_chars(text, end.ptr, x);
  return x;
}

/// Writes a number rounded down to two digits after the point.
std::string text_below(double x) {
  return fixed_text(std::floor(100 * x) / 100, 2);
}

/// Points that one stands for, and lengths and times of the solver, in a scene with cells `factor`
/// times as large.
void scale_settings(Scene& scene, double factor) {
  for (sim::seeding::Body& body : scene.bodies)
    if (auto* points = std::get_if<sim::shapes::Points>(&body.shape.form))
      points->thinning = tidy(points->thinning * factor * factor * factor);
  sim::SolverSettings& s = scene.solver;
  const bool is_ratio_per_step = s.flip_reference_dt == 0;
  s.cell_size = tidy(s.cell_size * factor);
  // This scales the solver's own values, and those of the curves that they follow.
  const auto scale = [&](const std::string& address, double& value) {
    if (address == "solver.dt" || address == "solver.max_dt") value = tidy(value * factor);
    if (address == "solver.flip_ratio" && is_ratio_per_step) value = tidy(std::pow(value, factor));
  };
  scale("solver.dt", s.dt);
  scale("solver.max_dt", s.max_dt);
  scale("solver.flip_ratio", s.flip_ratio);
  for (Curve& curve : scene.curves)
    for (CurveKeyframe& keyframe : curve.keyframes)
      if (keyframe.value) scale(curve.parameter, *keyframe.value);
}

void refuse_empty_bodies(const Scene& scene, double factor) {
  for (const sim::seeding::Body& body : scene.bodies) {
    const double full = sim::seeding::expected_particles(body, scene.solver.cell_size);
    // A body too small for one particle at full resolution has one all the same.
    if (full < 1 || full / (factor * factor * factor) >= 1) continue;
    throw UsageError(argument(factor), "no particle of body " + body.name + " would be left",
                     "at most " + text_below(std::cbrt(full)) + " leaves one");
  }
}

bool has_thresholds(const Scene& scene) {
  return std::ranges::any_of(materials_of_snow(scene),
                             [](const sim::Material& m) { return sim::laws::of(m).is_snow; });
}

/// A number that may be 0, and follows its curve where it has one, whatever the scene sets it to.
bool is_ever_positive(const Scene& scene, const std::string& address, double value) {
  const auto curve = std::ranges::find(scene.curves, address, &Curve::parameter);
  if (curve == scene.curves.end() || curve->keyframes.empty()) return value > 0;
  return std::ranges::any_of(curve->keyframes,
                             [](const CurveKeyframe& key) { return key.value.value_or(0) > 0; });
}

}  // namespace

std::vector<std::string> coarsen(Scene& scene, double factor) {
  if (!(factor >= 1) || !std::isfinite(factor))
    throw UsageError("--coarsen", "cannot use " + toml::number_text(factor),
                     "expected a number of at least 1, as in --coarsen 2");
  if (factor == 1) return {};
  refuse_empty_bodies(scene, factor);
  std::vector<std::string> set;
  if (scene.solver.threshold_cell == 0 && has_thresholds(scene)) {
    scene.solver.threshold_cell = scene.solver.cell_size;
    set.push_back("solver.threshold_cell=" + toml::number_text(scene.solver.cell_size));
  }
  scale_settings(scene, factor);
  const RangeCheck check{factor, scene.curves};
  describe(check, scene.solver);
  return set;
}

Scene without_dust(Scene scene) {
  for (sim::Material& material : scene.materials) material.dust = 0;
  std::erase_if(scene.curves, [](const Curve& curve) {
    return curve.parameter.starts_with("material.") && curve.parameter.ends_with(".dust");
  });
  return scene;
}

bool has_snow_of(const Scene& scene, const sim::Material& material) {
  const auto is_of = [&](const auto& source) { return source.material == material.name; };
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), is_of) ||
         std::any_of(scene.emitters.begin(), scene.emitters.end(), is_of);
}

std::vector<sim::Material> materials_of_snow(const Scene& scene) {
  std::vector<sim::Material> materials;
  for (const sim::Material& material : scene.materials)
    if (has_snow_of(scene, material)) materials.push_back(material);
  return materials.empty() ? scene.materials : materials;
}

std::vector<bool> which_are_snow(const Scene& scene) {
  const auto is_snow = [](const sim::Material& m) { return sim::laws::of(m).is_snow; };
  if (std::ranges::none_of(materials_of_snow(scene), is_snow)) return {};
  std::vector<bool> are;
  for (const sim::Material& material : scene.materials) are.push_back(is_snow(material));
  return are;
}

const sim::Material* dusty_material(const Scene& scene) {
  for (const sim::Material& material : scene.materials)
    if (is_ever_positive(scene, "material." + material.name + ".dust", material.dust) &&
        has_snow_of(scene, material))
      return &material;
  return nullptr;
}

bool has_spray_drag(const Scene& scene) {
  return is_ever_positive(scene, "dust.spray_drag", scene.solver.dust.spray_drag);
}

void refine_settings(Scene& scene, double factor) {
  if (factor > 1) scale_settings(scene, 1 / factor);
}

std::string setting_text(const std::string& address, double value, double factor) {
  const std::string text = address + " = " + rough_text(value / factor);
  return factor > 1 ? text + " (" + argument(factor) + " makes it " + rough_text(value) + ")"
                    : text;
}

std::string coarsening_text(double factor) {
  return toml::number_text(factor) + "x";
}

std::string coarsened_words(const Scene& scene, double factor) {
  if (!(factor > 1)) return "";
  const double meant = scene.solver.threshold_cell;
  return ", coarsened " + coarsening_text(factor) +
         (has_thresholds(scene) && meant > 0
              ? ", thresholds for cells of " + rough_text(meant) + " m"
              : "");
}

}  // namespace neve::app::scene
