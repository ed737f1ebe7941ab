#include <cmath>

#include "app/support/json.h"
#include "app/view/frontend/key_names.h"
#include "app/view/replay/replay_script.h"

namespace neve::app::view::replay {

namespace {

using Step = ReplayStep::Kind;

/// Omits digits that nobody can place a mouse by; whole numbers have no point.
Json rounded(float value, int parts) {
  const double near = std::round(static_cast<double>(value) * parts) / parts;
  if (near == std::floor(near)) return static_cast<int>(near);
  return near;
}

Json place_json(const ReplayPlace& place) {
  if (place.label.empty()) return Json::array({rounded(place.x, 10), rounded(place.y, 10)});
  if (place.x == 0.5f && place.y == 0.5f) return place.label;
  return {{"label", place.label},
          {"part", Json::array({rounded(place.x, 1000), rounded(place.y, 1000)})}};
}

/// Action of the step, without its modifiers.
Json action_json(const ReplayStep& step) {
  switch (step.kind) {
    case Step::click:
    case Step::move:
      return place_json(step.places.at(0));
    case Step::drag: {
      Json list = Json::array();
      for (const ReplayPlace& place : step.places) list.push_back(place_json(place));
      return list;
    }
    case Step::wheel:
      if (step.wheel_x == 0) return rounded(step.wheel_y, 1000);
      return Json::array({rounded(step.wheel_x, 1000), rounded(step.wheel_y, 1000)});
    case Step::key:
      return frontend::key_name(step.key);
    case Step::wait:
      return step.frames;
    case Step::resize: {
      Json list = Json::array({step.size.width, step.size.height});
      if (step.size.scale != 1) list.push_back(step.size.scale);
      return list;
    }
    case Step::quit:
      return true;
    default:
      return step.text;
  }
}

Json step_json(const ReplayStep& step) {
  const ReplayStep usual;
  Json json;
  json[name(step.kind)] = action_json(step);
  if (step.at_frame != usual.at_frame) json["at_frame"] = step.at_frame;
  if (step.kind == Step::wheel && !step.places.empty()) json["at"] = place_json(step.places[0]);
  if (step.button != usual.button) json["button"] = button_names[step.button];
  if (step.times != usual.times) json["times"] = step.times;
  if (step.kind == Step::drag && step.steps != usual.steps) json["steps"] = step.steps;
  if (step.kind == Step::key && step.frames != usual.frames) json["hold"] = step.frames;
  if (step.kind == Step::wait_for && step.seconds != usual.seconds) json["within"] = step.seconds;
  if (!step.crop_label.empty()) json["crop"] = step.crop_label;
  if (step.crop) json["crop"] = *step.crop;
  if (step.held.ctrl) json["ctrl"] = true;
  if (step.held.shift) json["shift"] = true;
  if (step.held.alt) json["alt"] = true;
  if (step.held.super) json["super"] = true;
  return json;
}

}  // namespace

std::string replay_text(const std::vector<ReplayStep>& steps) {
  std::string text = "[\n";
  for (std::size_t k = 0; k < steps.size(); ++k)
    text += to_text(step_json(steps[k]), -1) + (k + 1 < steps.size() ? ",\n" : "\n");
  return text + "]\n";
}

}  // namespace neve::app::view::replay
