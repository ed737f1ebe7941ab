#include "app/view/replay/replay_script.h"

#include <algorithm>
#include <string>
#include <vector>

#include "app/advice/suggest.h"
#include "app/scene/reader.h"
#include "app/scene/toml/error.h"
#include "app/support/text.h"
#include "app/view/replay/describe_step.h"
#include "app/view/replay/json_values.h"

namespace neve::app::view::replay {

namespace {

using Step = ReplayStep::Kind;

constexpr std::size_t step_limit = 100'000;

constexpr const char* action_names[] = {"click",  "drag",  "move", "wheel",    "key",
                                        "type",   "paste", "wait", "wait_for", "screenshot",
                                        "resize", "drop",  "quit"};
static_assert(std::size(action_names) == static_cast<std::size_t>(Step::quit) + 1);

std::vector<std::string> all_actions() {
  return {std::begin(action_names), std::end(action_names)};
}

/// Action of a step: the only one of its keys that names one.
/// @param name of the step, for complaints
Step action_of(const scene::Source& source, const scene::toml::Value& value,
               const std::string& name) {
  const scene::toml::Entry* found = nullptr;
  std::string hint;
  const std::vector<std::string> actions = all_actions();
  for (const scene::toml::Entry& entry : std::get<scene::toml::Table>(value.data).entries) {
    hint = advice::suggest(entry.key, {"", actions, true}, hint);
    if (std::find(actions.begin(), actions.end(), entry.key) == actions.end()) continue;
    if (found)
      source.fail(entry.where, name + ": both " + found->key + " and " + entry.key + " in one step",
                  "each step has one action");
    found = &entry;
  }
  if (!found)
    source.fail(value.where, name + ": nothing to do; expected one of " + joined(actions, ", "),
                hint);
  return static_cast<Step>(std::find(actions.begin(), actions.end(), found->key) - actions.begin());
}

/// @param number of the step, from 1
ReplayStep read_step(scene::Reading& reading, const scene::toml::Value& value, std::size_t number) {
  const std::string name = "step " + std::to_string(number);
  const auto* table = std::get_if<scene::toml::Table>(&value.data);
  if (!table)
    reading.source.fail(
        value.where,
        name + ": " + scene::toml::toml_literal(value, scene::toml::max_shown) + " is not a step",
        "a step is an object such as {\"click\": \"Run\"}");
  ReplayStep step;
  step.line = value.where.line;
  step.column = value.where.column;
  step.kind = action_of(reading.source, value, name);
  scene::Reader(reading, *table, name).read([&](auto& visit) { describe(visit, step); });
  return step;
}

}  // namespace

const char* name(ReplayStep::Kind kind) {
  return action_names[static_cast<std::size_t>(kind)];
}

std::optional<ReplayGoal> parse_goal(const std::string& text) {
  using Goal = ReplayGoal::Kind;
  if (text == "simulation running") return ReplayGoal{Goal::running, 0, {}};
  if (text == "simulation paused") return ReplayGoal{Goal::paused, 0, {}};
  const std::string frame = "simulation frame ", label = "label ";
  if (text.starts_with(label) && text.size() > label.size())
    return ReplayGoal{Goal::label, 0, text.substr(label.size())};
  if (!text.starts_with(frame)) return std::nullopt;
  const bool is_negative = text.starts_with(frame + "-");  // frames before that of first_frame 0
  const std::string digits = text.substr(frame.size() + (is_negative ? 1 : 0));
  const bool is_number = !digits.empty() && digits.size() <= 8 &&
                         digits.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number) return std::nullopt;
  return ReplayGoal{Goal::frame, (is_negative ? -1 : 1) * std::stoi(digits), {}};
}

std::vector<ReplayStep> parse_replay(std::string_view text, const std::string& file) {
  const scene::toml::Value script = parse_json_values(text, file);
  scene::Reading reading{{file, "", {}}, {}, false};
  const auto* list = std::get_if<scene::toml::Array>(&script.data);
  if (!list)
    reading.source.fail({1, 1}, "a script of input is a list of steps",
                        "such as [{\"click\": \"Run\"}, {\"wait\": 10}]");
  if (list->size() > step_limit)
    reading.source.fail({1, 1}, "more than " + std::to_string(step_limit) + " steps");
  std::vector<ReplayStep> steps;
  for (std::size_t k = 0; k < list->size(); ++k)
    steps.push_back(read_step(reading, (*list)[k], k + 1));
  return steps;
}

double min_seconds(const std::vector<ReplayStep>& steps) {
  // Of small panels without a window; measured, see docs/reports/strangers.md.
  constexpr double of_a_frame = 0.7e-3, of_waiting = 1.0 / 60;
  double seconds = 0;
  for (const ReplayStep& step : steps) {
    if (step.kind == Step::quit) break;
    seconds = std::max(seconds, of_waiting * step.at_frame);
    const double drawn = step.kind == Step::drag
                             ? step.steps * static_cast<double>(step.places.size() - 1)
                             : step.times;
    const bool waits = step.kind == Step::wait || step.kind == Step::key;
    seconds += of_a_frame * drawn + (waits ? of_waiting * step.frames : 0);
  }
  return seconds;
}

}  // namespace neve::app::view::replay
