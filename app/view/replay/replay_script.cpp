#include "app/view/replay/replay_script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "app/scene/toml/error.h"
#include "app/support/json.h"
#include "app/support/text.h"
#include "app/view/front/key_names.h"
#include "app/view/replay/json_places.h"

namespace neve::app::view::replay {

namespace {

using Step = ReplayStep::Kind;

constexpr std::size_t step_limit = 100'000, text_limit = 64 << 10;

/// Action of a step, and the keys that it may have besides at_frame.
struct Action {
  Step kind;
  const char* name;
  std::vector<std::string> keys;
};

const std::vector<Action>& actions() {
  static const std::vector<Action> all = {
      {Step::click, "click", {"button", "times", "ctrl", "shift", "alt", "super"}},
      {Step::drag, "drag", {"button", "steps", "ctrl", "shift", "alt", "super"}},
      {Step::move, "move", {}},
      {Step::wheel, "wheel", {"at", "ctrl", "shift", "alt", "super"}},
      {Step::key, "key", {"hold", "ctrl", "shift", "alt", "super"}},
      {Step::type, "type", {}},
      {Step::paste, "paste", {}},
      {Step::wait, "wait", {}},
      {Step::wait_for, "wait_for", {"within"}},
      {Step::screenshot, "screenshot", {"crop"}},
      {Step::resize, "resize", {}},
      {Step::drop, "drop", {}},
      {Step::quit, "quit", {}},
  };
  return all;
}

const Action& action_of(Step kind) {
  return *std::find_if(actions().begin(), actions().end(),
                       [&](const Action& action) { return action.kind == kind; });
}

std::vector<std::string> action_names() {
  std::vector<std::string> names;
  for (const Action& action : actions()) names.emplace_back(action.name);
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string shown(const Json& value) {
  const std::string text = to_text(value, -1);
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

/// True if a relative name stays within its folder.
bool stays_inside(const std::filesystem::path& file) {
  return !file.has_root_path() &&
         std::none_of(file.begin(), file.end(), [](const auto& part) { return part == ".."; });
}

/// Reads one step; every complaint names file, line and column.
class StepReader {
 public:
  StepReader(const Json& json, const JsonObjectPlaces& places, const std::string& file,
             std::size_t number)
      : json_(json), places_(places), file_(file), number_(number) {}

  ReplayStep read() {
    if (!json_.is_object())
      fail({}, shown(json_) + " is not a step", "a step is an object such as {\"click\": \"Run\"}");
    if (!places_.repeated_key.empty())
      fail(places_.repeated_key, "\"" + places_.repeated_key + "\" is there twice", {});
    step_.line = places_.start.line;
    step_.column = places_.start.column;
    action_ = &find_action();
    step_.kind = action_->kind;
    check_keys();
    read_common();
    read_action();
    return step_;
  }

 private:
  [[noreturn]] void fail(const std::string& key, const std::string& message,
                         const std::string& hint) const {
    const auto at = places_.keys.find(key);
    const TextPlace place = at == places_.keys.end() ? places_.start : at->second;
    throw scene::toml::SceneError(file_, place.line, place.column,
                                  "step " + std::to_string(number_) + ": " + message, hint);
  }

  [[noreturn]] void expected(const std::string& key, const std::string& what) const {
    fail(key, key + " = " + shown(json_[key]) + "; expected " + what, {});
  }

  const Action& find_action() const {
    const Action* found = nullptr;
    for (const Action& action : actions()) {
      if (!json_.contains(action.name)) continue;
      if (found)
        fail(action.name,
             std::string("both ") + found->name + " and " + action.name + " in one step",
             "one step does one thing");
      found = &action;
    }
    if (found) return *found;
    std::string hint;
    for (const auto& [key, value] : json_.items()) {
      const std::string nearest = nearest_name(key, action_names());
      if (!nearest.empty()) hint = "did you mean \"" + nearest + "\"?";
    }
    fail({}, "nothing to do; expected one of " + joined(action_names()), hint);
  }

  void check_keys() const {
    std::vector<std::string> valid = action_->keys;
    valid.emplace_back("at_frame");
    for (const auto& [key, value] : json_.items()) {
      if (key == action_->name || std::count(valid.begin(), valid.end(), key)) continue;
      const std::string nearest = nearest_name(key, valid);
      fail(key, "unknown key \"" + key + "\" in a step that does " + action_->name,
           nearest.empty() ? "it may have " + joined(valid) : "did you mean \"" + nearest + "\"?");
    }
  }

  double number(const std::string& key, const Json& value, double low, double high,
                const std::string& what) const {
    const double read = value.is_number() ? value.get<double>() : NAN;
    if (!(read >= low && read <= high)) expected(key, what);
    return read;
  }

  /// @return the number at a key that may be absent
  int whole(const std::string& key, int low, int high, int absent) const {
    if (!json_.contains(key)) return absent;
    const std::string range =
        "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
    const double read = number(key, json_[key], low, high, range);
    if (read != std::floor(read)) expected(key, range);
    return static_cast<int>(read);
  }

  bool flag(const std::string& key) const {
    if (!json_.contains(key)) return false;
    if (!json_[key].is_boolean()) expected(key, "true or false");
    return json_[key].get<bool>();
  }

  std::string text(const std::string& key, const std::string& what) const {
    const Json& value = json_[key];
    if (!value.is_string() || value.get_ref<const std::string&>().empty()) expected(key, what);
    std::string read = value.get<std::string>();
    if (read.size() > text_limit) fail(key, key + " is longer than 64 KiB", {});
    return read;
  }

  ReplayPlace place(const std::string& key, const Json& value) const {
    static const std::string what =
        "a place: [x, y] in px, a label, or {\"label\": ..., \"part\": [0.5, 0.5]}";
    const auto pair = [&](const Json& list, double low, double high) {
      if (!list.is_array() || list.size() != 2) expected(key, what);
      return std::pair{static_cast<float>(number(key, list[0], low, high, what)),
                       static_cast<float>(number(key, list[1], low, high, what))};
    };
    ReplayPlace read;
    if (value.is_string() && !value.get_ref<const std::string&>().empty()) {
      read.label = value.get<std::string>();
    } else if (value.is_array()) {
      std::tie(read.x, read.y) = pair(value, -1e5, 1e5);
    } else {
      const bool is_label = value.is_object() && value.contains("label") &&
                            value["label"].is_string() && !value["label"].empty() &&
                            value.size() == 1 + value.count("part");
      if (!is_label) expected(key, what);
      read.label = value["label"].get<std::string>();
      if (value.contains("part")) std::tie(read.x, read.y) = pair(value["part"], 0, 1);
    }
    return read;
  }

  void read_common() {
    step_.at_frame = whole("at_frame", 0, 10'000'000, 0);
    step_.held = {flag("ctrl"), flag("shift"), flag("alt"), flag("super")};
    step_.times = whole("times", 1, 9, 1);
    step_.steps = whole("steps", 1, 10'000, 10);
    if (!json_.contains("button")) return;
    const std::string name = text("button", "\"left\", \"right\" or \"middle\"");
    const auto* found = std::find(std::begin(button_names), std::end(button_names), name);
    if (found == std::end(button_names)) expected("button", "\"left\", \"right\" or \"middle\"");
    step_.button = static_cast<int>(found - std::begin(button_names));
  }

  void read_action() {
    const std::string name = action_->name;
    const Json& value = json_[name];
    switch (step_.kind) {
      case Step::click:
      case Step::move:
        step_.places = {place(name, value)};
        break;
      case Step::drag:
        read_drag(value);
        break;
      case Step::wheel:
        read_wheel(value);
        break;
      case Step::key:
        read_key();
        break;
      case Step::type:
      case Step::paste:
        step_.text = text(name, "some text");
        break;
      case Step::wait:
        step_.frames = whole(name, 1, 1'000'000, 1);
        break;
      case Step::wait_for:
        read_goal();
        break;
      case Step::screenshot:
        read_screenshot();
        break;
      case Step::resize:
        read_size(value);
        break;
      case Step::drop:
        step_.text = text(name, "the name of a file");
        break;
      case Step::quit:
        if (!flag(name)) expected(name, "true");
        break;
    }
  }

  void read_drag(const Json& value) {
    const std::string what = "a list of two places or more";
    if (!value.is_array() || value.size() < 2 || value.size() > 10'000) expected("drag", what);
    for (const Json& one : value) step_.places.push_back(place("drag", one));
  }

  void read_wheel(const Json& value) {
    const std::string what = "notches up, or [right, up], each from -100 to 100";
    if (value.is_array() && value.size() == 2) {
      step_.wheel_x = static_cast<float>(number("wheel", value[0], -100, 100, what));
      step_.wheel_y = static_cast<float>(number("wheel", value[1], -100, 100, what));
    } else {
      step_.wheel_y = static_cast<float>(number("wheel", value, -100, 100, what));
    }
    if (json_.contains("at")) step_.places = {place("at", json_["at"])};
  }

  void read_key() {
    const std::string name = text("key", "the name of a key");
    const std::optional<int> code = front::key_named(name);
    if (!code) {
      const std::string nearest = nearest_name(name, front::key_names());
      fail("key", "unknown key of the keyboard \"" + name + "\"",
           nearest.empty() ? "a letter, a digit, a sign, or one of " + joined(front::key_names())
                           : "did you mean \"" + nearest + "\"?");
    }
    step_.key = *code;
    step_.frames = whole("hold", 1, 100'000, 1);
  }

  void read_goal() {
    const std::string what =
        "\"simulation frame N\", \"simulation running\", \"simulation paused\" or \"label NAME\"";
    step_.text = text("wait_for", what);
    if (!parse_goal(step_.text)) expected("wait_for", what);
    if (json_.contains("within"))
      step_.seconds = number("within", json_["within"], 0.001, 86'400, "seconds, up to a day");
  }

  void read_screenshot() {
    step_.text = text("screenshot", "the name of a PNG file");
    if (!step_.text.ends_with(".png")) expected("screenshot", "a name that ends in .png");
    if (!stays_inside(step_.text))
      expected("screenshot",
               "a name within the folder of --out, without \"..\" and no absolute one");
    if (!json_.contains("crop")) return;
    const std::string what = "a label, or [x, y, width, height] in px";
    const Json& crop = json_["crop"];
    if (crop.is_string()) {
      step_.crop_label = text("crop", what);
      return;
    }
    if (!crop.is_array() || crop.size() != 4) expected("crop", what);
    std::array<int, 4> read{};
    for (std::size_t k = 0; k < 4; ++k)
      read[k] = static_cast<int>(number("crop", crop[k], k < 2 ? 0 : 1, 16'384, what));
    step_.crop = read;
  }

  void read_size(const Json& value) {
    const std::string what = "[width, height] in px from 64 to 8192, or with a scale from 0.5 to 4";
    if (!value.is_array() || value.size() < 2 || value.size() > 3) expected("resize", what);
    step_.size.width = static_cast<int>(number("resize", value[0], 64, 8192, what));
    step_.size.height = static_cast<int>(number("resize", value[1], 64, 8192, what));
    if (value.size() == 3)
      step_.size.scale = static_cast<float>(number("resize", value[2], 0.5, 4, what));
  }

  const Json& json_;
  const JsonObjectPlaces& places_;
  const std::string& file_;
  std::size_t number_;
  const Action* action_ = nullptr;
  ReplayStep step_;
};

Json parse_list(std::string_view text, const std::string& file) {
  Json json;
  try {
    json = parse_json(text);
  } catch (const nlohmann::json::parse_error& error) {
    const TextPlace place = place_of(text, error.byte > 0 ? error.byte - 1 : 0);
    std::string message = error.what();
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..."
    if (const std::size_t colon = message.find(": "); colon != std::string::npos)
      message = message.substr(colon + 2);
    throw scene::toml::SceneError(file, place.line, place.column, "not valid JSON: " + message);
  } catch (const nlohmann::json::exception& error) {
    throw scene::toml::SceneError(file, 1, 1, std::string("not valid JSON: ") + error.what());
  }
  if (!json.is_array())
    throw scene::toml::SceneError(file, 1, 1, "a script of input is a list of steps",
                                  "such as [{\"click\": \"Run\"}, {\"wait\": 10}]");
  if (json.size() > step_limit)
    throw scene::toml::SceneError(file, 1, 1, "more than " + std::to_string(step_limit) + " steps");
  return json;
}

}  // namespace

const char* name_of(ReplayStep::Kind kind) {
  return action_of(kind).name;
}

std::optional<ReplayGoal> parse_goal(const std::string& text) {
  using Goal = ReplayGoal::Kind;
  if (text == "simulation running") return ReplayGoal{Goal::running, 0, {}};
  if (text == "simulation paused") return ReplayGoal{Goal::paused, 0, {}};
  const std::string frame = "simulation frame ", label = "label ";
  if (text.starts_with(label) && text.size() > label.size())
    return ReplayGoal{Goal::label, 0, text.substr(label.size())};
  if (!text.starts_with(frame)) return std::nullopt;
  const std::string digits = text.substr(frame.size());
  const bool is_number = !digits.empty() && digits.size() <= 8 &&
                         digits.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number) return std::nullopt;
  return ReplayGoal{Goal::frame, std::stoi(digits), {}};
}

std::vector<ReplayStep> parse_replay(std::string_view text, const std::string& file) {
  const Json json = parse_list(text, file);
  const std::vector<JsonObjectPlaces> places = places_in_list(text);
  std::vector<ReplayStep> steps;
  for (std::size_t k = 0; k < json.size(); ++k) {
    const JsonObjectPlaces& at = places.at(std::min(k, places.size() - 1));
    steps.push_back(StepReader(json[k], at, file, k + 1).read());
  }
  return steps;
}

}  // namespace neve::app::view::replay
