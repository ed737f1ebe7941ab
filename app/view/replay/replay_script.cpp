#include "app/view/replay/replay_script.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/advice/suggest.h"
#include "app/scene/reader.h"
#include "app/scene/toml/error.h"
#include "app/support/text.h"
#include "app/view/replay/describe_step.h"
#include "sim/base/byte_order_mark.h"

namespace neve::app::view::replay {

namespace {

using scene::toml::Array;
using scene::toml::Location;
using scene::toml::Table;
using scene::toml::Value;

constexpr std::size_t max_nested = 16, max_keys = 64;

bool is_between_tokens(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == ':';
}

/// The tokens of valid JSON, one after the other.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) { text_ = without_mark(text_); }

  /// @return where the next token begins
  Location next() {
    while (at_ < text_.size() && is_between_tokens(text_[at_])) step();
    const Location start = here_;
    if (at_ >= text_.size()) return start;
    const char first = text_[at_];
    step();
    if (first == '"') {
      skip_string();
    } else if (!is_bracket(first)) {
      while (at_ < text_.size() && !is_between_tokens(text_[at_]) && !is_bracket(text_[at_]))
        step();
    }
    return start;
  }

  /// @return the place of a byte of the text
  Location place_of(std::size_t byte) {
    while (at_ < std::min(byte, text_.size())) step();
    return here_;
  }

 private:
  static bool is_bracket(char c) { return c == '{' || c == '}' || c == '[' || c == ']'; }

  void skip_string() {
    while (at_ < text_.size() && text_[at_] != '"') {
      if (text_[at_] == '\\') step();
      if (at_ < text_.size()) step();
    }
    if (at_ < text_.size()) step();
  }

  void step() {
    if (text_[at_] == '\n') {
      here_ = {here_.line + 1, 1};
    } else if ((static_cast<unsigned char>(text_[at_]) & 0xc0) != 0x80) {
      ++here_.column;
    }
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Location here_{1, 1};
};

/// Puts values together from the events of the JSON library; each of its calls is one token.
class Builder {
 public:
  Builder(std::string_view text, std::string file)
      : text_(text), tokens_(text), file_(std::move(file)) {}

  Value root;

  // The names are those that the library calls.
  bool null() { fail(tokens_.next(), "null is not a value here", "omit the key"); }
  bool boolean(bool value) { return add({value, tokens_.next()}); }
  bool number_integer(std::int64_t value) { return add({value, tokens_.next()}); }
  bool number_unsigned(std::uint64_t value) {
    const Location place = tokens_.next();
    if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      return add({static_cast<std::int64_t>(value), place});
    return add({static_cast<double>(value), place});
  }
  bool number_float(double value, const std::string&) { return add({value, tokens_.next()}); }
  bool string(std::string& value) { return add({value, tokens_.next()}); }
  bool binary(std::vector<std::uint8_t>&) { return false; }  // JSON text has none
  bool start_object(std::size_t) { return open({Table{}, tokens_.next()}); }
  bool start_array(std::size_t) { return open({Array{}, tokens_.next()}); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string& name) {
    key_ = {name, tokens_.next(), {}};
    if (left_out_ > 0) return true;
    const Table& table = std::get<Table>(open_.back()->data);
    if (table.find(name)) fail(key_.where, scene::toml::toml_string(name) + " is given twice", "");
    if (table.entries.size() >= max_keys) fail(key_.where, "too many keys in one object", "");
    return true;
  }

  bool parse_error(std::size_t byte, const std::string&, const nlohmann::json::exception& error) {
    std::string message = error.what();
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..."
    if (const std::size_t colon = message.find(": "); colon != std::string::npos)
      message = message.substr(colon + 2);
    fail(Tokens(text_).place_of(byte > 0 ? byte - 1 : 0), "not valid JSON: " + message, "");
  }

 private:
  [[noreturn]] void fail(Location where, const std::string& message, const std::string& hint) {
    throw scene::toml::SceneError(file_, where.line, where.column, message, hint);
  }

  bool add(Value value) {
    if (left_out_ == 0) place(std::move(value));
    return true;
  }

  Value& place(Value value) {
    if (open_.empty()) return root = std::move(value);
    if (Array* list = std::get_if<Array>(&open_.back()->data))
      return list->emplace_back(std::move(value));
    key_.value = std::move(value);
    return std::get<Table>(open_.back()->data).entries.emplace_back(std::move(key_)).value;
  }

  bool open(Value value) {
    if (left_out_ > 0 || open_.size() >= max_nested)
      ++left_out_;
    else
      open_.push_back(&place(std::move(value)));
    return true;
  }

  bool close() {
    tokens_.next();
    if (left_out_ > 0)
      --left_out_;
    else
      open_.pop_back();
    return true;
  }

  std::string_view text_;
  Tokens tokens_;
  std::string file_;
  scene::toml::Entry key_;
  std::vector<Value*> open_;  ///< nothing is added beside one that is open: pointers stay valid
  std::size_t left_out_ = 0;  ///< open values that are too deep to keep
};

/// JSON text to the plain data that scenes are read from: every value and key with its place, which
/// the JSON library does not tell. Values nested deeper than any script needs are left empty.
/// @param file only named in errors
/// @throws SceneError for invalid JSON, for null, and for a key that is given twice
Value parse_json_values(std::string_view text, const std::string& file) {
  Builder builder(text, file);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  return std::move(builder.root);
}

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
  // These times, of small panels without a window, are measured: see docs/reports/strangers.md.
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
