#pragma once
/// `--coarsen N`: the same scene with larger cells, for looking and tuning.

#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace neve::app::scene {

/// Makes cells `factor` times as large: 1/factor^3 of the particles, because particles_per_cell
/// stays; a fixed dt and max_dt grow with the cells, like the limits that follow from them. Snow is
/// damped as much per second as before: flip_reference_dt sees to that, and where flip_ratio acts
/// per step (flip_reference_dt = 0) it becomes flip_ratio^factor, for steps factor times as long.
/// Thresholds of snow stay those of the finer cells: threshold_cell becomes cell_size as it was,
/// where the scene does not name one.
/// @param factor 1 changes nothing
/// @return what it sets beside lengths and times, as --set would: "solver.threshold_cell=0.02"
/// @throws UsageError when it is not a finite number of at least 1, takes a parameter out of its
///         range, or leaves a body without a particle
std::vector<std::string> coarsen(Scene& scene, double factor);

/// The same snow without its dust, for copies that nobody looks at.
Scene without_dust(Scene scene);
/// True if a body or an emitter is of this material of the scene.
bool has_snow_of(const Scene& scene, const sim::Material& material);
/// Returns the materials of bodies and emitters; of a scene without any, all.
std::vector<sim::Material> materials_of_snow(const Scene& scene);
/// Tells for each material of the scene whether its law is one of snow; empty where no body and no
/// emitter is of such a one.
std::vector<bool> which_are_snow(const Scene& scene);
/// A material of bodies or emitters that sheds dust, or that a curve makes shed it; null: none
/// does. Check: DustScene.CurvesMakeAndEndIt
const sim::Material* dusty_material(const Scene& scene);
/// True if air brakes loose snow at some time, which it does in runs without dust too.
bool has_spray_drag(const Scene& scene);

/// The scene with the numbers that its file and --set take, for panels and messages: coarsen with
/// the same factor gives it back, within rounding.
void refine_settings(Scene& scene, double factor);

/// "solver.dt = 0.00068": advice on a length of cells or steps, in the numbers that --set takes. A
/// factor above 1 is told: "solver.dt = 0.00034 (--coarsen 2 makes it 0.00068)".
std::string setting_text(const std::string& address, double value, double factor);

/// "2x", "1.5x"
std::string coarsening_text(double factor);
/// ", coarsened 2x, thresholds for cells of 0.02 m", for messages; "" of a scene that is not.
std::string coarsened_words(const Scene& scene, double factor);

}  // namespace neve::app::scene
