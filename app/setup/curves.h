#pragma once
/// Keyframes of parameters: the values that curves give in a frame.

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/override.h"
#include "app/scene/scene.h"

namespace neve::app::setup {

/// The value of every curve while a frame is simulated, as --set would give it: that of the middle
/// of the frame, constant in it, so that the values follow from the number of the frame alone.
/// @param frame  counted from 0: the time from the end of the frame before it; 0: the start
/// Check: Curves.GiveTheValueOfTheMiddleOfAFrame
std::vector<scene::Override> curve_values(const scene::Scene& scene, int frame);

/// Asks all rules of a scene of the values at the ends of its curves; those between break none. If
/// thousands of curves share no times, it asks at some of the ends.
/// @param name  of the scene in messages @throws SceneError with the place of the keyframe
void require_curve_values(const scene::Scene& scene, const std::string& name);

/// The scene with these values. @throws UsageError, SceneError
scene::Scene with_curves(const scene::Scene& scene, int frame);

/// Returns the numbers of a curve alone, without a scene that is read for them; nothing for a
/// parameter without a curve.
std::optional<std::vector<double>> curve_value(const scene::Scene& scene,
                                               const std::string& address, int frame);

/// The curve that a parameter follows; null: none.
const scene::Curve* curve_of(const scene::Scene& scene, const std::string& address);

/// Frames whose values show how far the curves go while the scene lasts: the first, the last, those
/// at keyframes and some between; of very many those with the smallest and the largest value of
/// each curve, and some of the others. The first alone without curves.
std::vector<int> telling_frames(const scene::Scene& scene);

/// A curve has the last word: a change of its parameter would do nothing.
/// @throws UsageError or SceneError that names the flag or the place of the change
void refuse_followers(const scene::Scene& scene, const std::vector<scene::Override>& changes);

/// Leaves those off: a slider moves them until the next frame only.
std::vector<scene::Override> without_followers(const scene::Scene& scene,
                                               std::vector<scene::Override> changes);

/// "wetness 0.31, gravity 0 -9.81 0": the values of a frame, for captions; "" without curves.
std::string curves_text(const scene::Scene& scene, int frame);

/// act(the scene at each moment that shows how far its curves go, without them)
template <class Act>
void at_each_moment(const scene::Scene& scene, const Act& act) {
  if (scene.curves.empty()) return act(scene);
  for (const int frame : telling_frames(scene)) {
    scene::Scene then = with_curves(scene, frame);
    then.curves.clear();
    act(std::as_const(then));
  }
}

/// The largest value at any of them.
template <class Of>
double largest_at_moments(const scene::Scene& scene, const Of& of) {
  double value = 0;
  at_each_moment(scene, [&](const scene::Scene& then) { value = std::max(value, of(then)); });
  return value;
}

}  // namespace neve::app::setup
