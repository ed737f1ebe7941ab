#include "app/setup/curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <variant>

#include "app/scene/override.h"
#include "app/scene/read.h"
#include "app/scene/toml/error.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "sim/shapes/curve.h"

namespace neve::app::setup {

namespace {

/// Numbers of the keyframes of a curve, one coordinate after the other.
std::vector<std::vector<double>> coordinates_of(const scene::Curve& curve) {
  const int count = curve.keyframes.front().vector ? 3 : 1;
  std::vector<std::vector<double>> coordinates(static_cast<std::size_t>(count));
  for (const scene::CurveKeyframe& key : curve.keyframes)
    for (int c = 0; c < count; ++c)
      coordinates[static_cast<std::size_t>(c)].push_back(key.vector ? (*key.vector)[c]
                                                                    : key.value.value_or(0));
  return coordinates;
}

double value_at(const scene::Curve& curve, const std::vector<double>& times,
                const std::vector<double>& x, const sim::shapes::CurvePlace& place) {
  const std::size_t before = place.next > 0 ? place.next - 1 : 0;
  switch (curve.interpolation) {
    case scene::Interpolation::step:
      return x[before];
    case scene::Interpolation::linear:
      return place.is_between(times) ? x[before] + place.part * (x[place.next] - x[before])
                                     : x[before];
    case scene::Interpolation::smooth:
      return sim::shapes::curve_at(times, x, place).value;
  }
  return x[before];
}

/// A curve that is asked for many times.
class CurveValues {
 public:
  explicit CurveValues(const scene::Curve& curve)
      : curve_(curve), coordinates_(coordinates_of(curve)) {
    for (const scene::CurveKeyframe& key : curve.keyframes) times_.push_back(key.time);
  }
  std::vector<double> at(double time) const {
    const sim::shapes::CurvePlace place(times_, time);
    std::vector<double> numbers;
    for (const std::vector<double>& x : coordinates_)
      numbers.push_back(value_at(curve_, times_, x, place));
    return numbers;
  }
  std::size_t size() const { return coordinates_.size(); }

 private:
  const scene::Curve& curve_;
  std::vector<std::vector<double>> coordinates_;
  std::vector<double> times_;
};

std::vector<double> numbers_at(const scene::Curve& curve, double time) {
  return CurveValues(curve).at(time);
}

double time_of(const scene::Scene& scene, int frame) {
  return std::max(0.0, frame - 0.5) / scene.fps;
}

/// Reduces many frames to some, and those at an end of a coordinate of a curve, or of all of them.
std::vector<int> few_of(const scene::Scene& scene, const std::vector<int>& all) {
  constexpr std::size_t most = 64;
  if (all.size() <= most) return all;
  std::set<int> few;
  for (std::size_t k = 0; k < most; ++k) few.insert(all[k * all.size() / most]);
  for (const scene::Curve& curve : scene.curves) {
    if (curve.keyframes.empty()) continue;
    const CurveValues values(curve);
    const auto add = [&](const auto& size_of) {
      few.insert(*std::ranges::max_element(
          all, {}, [&](int frame) { return size_of(values.at(time_of(scene, frame))); }));
    };
    add([](const std::vector<double>& x) {
      return std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
    });
    for (std::size_t c = 0; c < values.size(); ++c)
      for (const double sign : {-1.0, 1.0})
        add([&](const std::vector<double>& x) { return sign * x[c]; });
  }
  return {few.begin(), few.end()};
}

/// True for a change of the address, and of a table around it that has a value there.
bool sets(const scene::Override& change, const std::string& address) {
  if (!address.starts_with(change.address)) return false;
  const std::vector<std::string> all = scene::addresses_of({change});
  return std::ranges::find(all, address) != all.end();
}

/// Returns the words that errors name a curve with.
std::string flag_of(const scene::Curve& curve) {
  return "curve." + curve.name + ":";
}

std::vector<scene::Override> values_at(const scene::Scene& scene, double time) {
  std::vector<scene::Override> values;
  for (const scene::Curve& curve : scene.curves) {
    if (curve.keyframes.empty()) continue;
    std::vector<std::string> words;
    for (const double number : numbers_at(curve, time))
      words.push_back(scene::toml::number_text(number));
    scene::Override value{curve.parameter,
                          words.size() == 1 ? words.front() : "[" + joined(words, ", ") + "]"};
    value.flag = flag_of(curve);
    values.push_back(std::move(value));
  }
  return values;
}

/// Keyframes where a coordinate is smallest or largest.
std::set<std::size_t> ends_of(const scene::Curve& curve) {
  std::set<std::size_t> ends;
  for (const std::vector<double>& x : coordinates_of(curve)) {
    const auto [least, most] = std::ranges::minmax_element(x);
    ends.insert(static_cast<std::size_t>(least - x.begin()));
    ends.insert(static_cast<std::size_t>(most - x.begin()));
  }
  return ends;
}

/// A keyframe at an end of a curve.
struct CurveEnd {
  const scene::Curve* curve;
  std::size_t keyframe;
};

/// Returns the ends of all curves by their times. If many curves share no times, some moments are
/// left off: each reads the scene again, with the values of all.
std::map<double, std::vector<CurveEnd>> moments_of_ends(const scene::Scene& scene) {
  constexpr std::size_t max_values = 20'000;
  std::map<double, std::vector<CurveEnd>> moments;
  for (const scene::Curve& curve : scene.curves)
    for (const std::size_t k : ends_of(curve))
      moments[curve.keyframes[k].time].push_back({&curve, k});
  const std::size_t count = moments.size(),
                    most = max_values / std::max<std::size_t>(1, scene.curves.size()) + 1;
  std::size_t k = 0;
  if (count > most)
    std::erase_if(moments, [&](const auto&) {
      const std::size_t place = k++;
      return place * most / count == (place + 1) * most / count;
    });
  return moments;
}

/// Throws an error of a moment with the place of a keyframe.
/// @param flag  of the change that failed: it names the curve at fault
[[noreturn]] void fail_at(const std::vector<CurveEnd>& ends, const std::string& flag,
                          const scene::toml::SceneError& error) {
  const auto at_fault = std::ranges::find_if(
      ends, [&](const CurveEnd& end) { return flag.starts_with(flag_of(*end.curve)); });
  const CurveEnd& end = at_fault == ends.end() ? ends.front() : *at_fault;
  throw scene::toml::SceneError(error.file, 0, 0,
                                "curve." + end.curve->name + ".keyframes[" +
                                    std::to_string(end.keyframe + 1) + "]: " + error.message,
                                error.hint);
}

}  // namespace

std::vector<scene::Override> curve_values(const scene::Scene& scene, int frame) {
  return values_at(scene, time_of(scene, frame));
}

std::optional<std::vector<double>> curve_value(const scene::Scene& scene,
                                               const std::string& address, int frame) {
  const scene::Curve* curve = curve_of(scene, address);
  if (!curve || curve->keyframes.empty()) return std::nullopt;
  return numbers_at(*curve, time_of(scene, frame));
}

void require_curve_values(const scene::Scene& scene, const std::string& name) {
  scene::Scene still = scene;
  still.curves.clear();
  for (const auto& moment : moments_of_ends(scene)) {
    try {
      scene::apply(still, values_at(scene, moment.first));
    } catch (const scene::toml::SceneError& error) {
      fail_at(moment.second, "", {name, 0, 0, error.message, error.hint});
    } catch (const UsageError& error) {
      fail_at(moment.second, error.where, {name, 0, 0, error.message, error.hint});
    }
  }
}

scene::Scene with_curves(const scene::Scene& scene, int frame) {
  const std::vector<scene::Override> values = curve_values(scene, frame);
  return values.empty() ? scene : scene::apply(scene, values);
}

const scene::Curve* curve_of(const scene::Scene& scene, const std::string& address) {
  const auto found = std::ranges::find(scene.curves, address, &scene::Curve::parameter);
  return found == scene.curves.end() ? nullptr : &*found;
}

std::vector<int> telling_frames(const scene::Scene& scene) {
  constexpr int parts = 4;
  const int last = scene::last_frame(scene);
  std::set<int> frames{0};
  for (const scene::Curve& curve : scene.curves) {
    frames.insert(last);
    for (std::size_t k = 0; k < curve.keyframes.size(); ++k) {
      const double time = curve.keyframes[k].time;
      const double next = k + 1 < curve.keyframes.size() ? curve.keyframes[k + 1].time : time;
      for (int part = 0; part < parts; ++part) {
        // The values of a frame are those of its middle.
        const double frame = (time + (next - time) * part / parts) * scene.fps;
        for (const double near : {std::floor(frame), std::floor(frame) + 1})
          frames.insert(static_cast<int>(std::clamp(near, 0.0, double(last))));
      }
    }
  }
  return few_of(scene, {frames.begin(), frames.end()});
}

void refuse_followers(const scene::Scene& scene, const std::vector<scene::Override>& changes) {
  for (const scene::Override& change : changes)
    for (const scene::Curve& curve : scene.curves)
      if (sets(change, curve.parameter))
        change.fail(change.key, curve.parameter + " follows its curve " + curve.name,
                    "change curve." + curve.name + ".keyframes instead");
}

std::vector<scene::Override> without_followers(const scene::Scene& scene,
                                               std::vector<scene::Override> changes) {
  std::erase_if(changes,
                [&](const scene::Override& change) { return curve_of(scene, change.address); });
  return changes;
}

std::string curves_text(const scene::Scene& scene, int frame) {
  std::vector<std::string> parts;
  for (const scene::Curve& curve : scene.curves) {
    if (curve.keyframes.empty()) continue;
    std::string text = curve.parameter.substr(curve.parameter.rfind('.') + 1);
    for (const double number : numbers_at(curve, time_of(scene, frame)))
      text += " " + rough_text(number);
    parts.push_back(std::move(text));
  }
  return joined(parts, ", ");
}

}  // namespace neve::app::setup
