#include "app/scene/burn_in.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <vector>

#include "app/advice/suggest.h"
#include "app/scene/flat.h"
#include "app/scene/override.h"
#include "app/scene/presets.h"
#include "app/support/errors.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"

namespace neve::app::scene {

namespace {

using Values = std::map<std::string, std::string>;

std::string plain_text(const FlatParam& param) {
  if (param.value)
    if (const auto* text = std::get_if<std::string>(&param.value->data)) return *text;
  return param.value ? param.text() : "";
}

Values values_of(const Scene& scene, const PictureWords& words) {
  Values values;
  for (const FlatParam& param : flatten(scene)) values[param.address] = plain_text(param);
  const int number = number_of(scene, words.frame);
  values["frame"] = fmt::format("{:04}", number);  // as in names of files
  values["time"] = time_text(words.time, scene.fps);
  values["time_code"] = time_code_of(scene, number, scene.fps);
  values["range"] = range_text(scene);
  values["view"] = words.view;
  values["changes"] = words.changes;
  return values;
}

struct Filled {
  std::string text;
  bool is_open = false;  ///< a brace opens that none closes
};

/// @param value_of  of what braces hold
template <class ValueOf>
Filled fill(const std::string& text, const ValueOf& value_of) {
  std::string filled;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    const bool is_twice = at + 1 < text.size() && text[at + 1] == c;
    if ((c == '{' || c == '}') && is_twice) {
      filled += c;
      ++at;
    } else if (c == '{') {
      const std::size_t end = text.find('}', at);
      if (end == std::string::npos) return {filled + text.substr(at), true};
      filled += value_of(text.substr(at + 1, end - at - 1));
      at = end;
    } else {
      filled += c;
    }
  }
  return {filled};
}

std::string no_time_code_text(const std::string& code, double fps) {
  return toml::toml_string(code) + " is not a time code of " + plain_rate(fps) + " frames a second";
}

struct Place {
  const char* key;
  const std::string* text;
};

std::array<Place, 6> places_of(const BurnIn& b) {
  return {Place{"top_left", &b.top_left},   Place{"top", &b.top},
          Place{"top_right", &b.top_right}, Place{"bottom_left", &b.bottom_left},
          Place{"bottom", &b.bottom},       Place{"bottom_right", &b.bottom_right}};
}

}  // namespace

std::string range_text(const Scene& scene) {
  return std::to_string(scene.first_frame) + "-" + std::to_string(scene.first_frame + scene.frames);
}

std::string time_code_of(const Scene& scene, int number, double fps) {
  const std::string& given = scene.shot.time_code;
  if (const auto start = frames_of_time_code(given, fps); start && !given.empty())
    return time_code_text(*start + number - scene.first_frame, fps, drops_numbers(given));
  return time_code_text(number, fps, false);
}

std::string time_code_of_movie(const Scene& scene, int first, double movie_fps) {
  const bool has_one =
      number_of(scene, 0) != 0 || scene.first_frame != 0 || !scene.shot.time_code.empty();
  return has_one ? time_code_of(scene, first, movie_fps > 0 ? movie_fps : scene.fps) : "";
}

void require_time_code(const Scene& scene, double movie_fps) {
  const std::string& code = scene.shot.time_code;
  if (code.empty() || movie_fps == 0 || frames_of_time_code(code, movie_fps)) return;
  throw UsageError("--movie-fps " + plain_rate(movie_fps),
                   "shot.time_code = " + no_time_code_text(code, movie_fps),
                   "--set shot.time_code= with one that it has, or remove --movie-fps");
}

std::array<std::string, 6> burnt_in(const Scene& scene, const PictureWords& words) {
  const Values values = values_of(scene, words);
  std::array<std::string, 6> filled;
  const auto places = places_of(scene.burn_in);
  for (std::size_t k = 0; k < filled.size(); ++k)
    filled[k] = fill(*places[k].text, [&](const std::string& name) {
                  const auto found = values.find(name);
                  return found == values.end() ? std::string() : found->second;
                }).text;
  return filled;
}

std::optional<Problem> shot_problem(const Scene& scene) {
  const std::string& code = scene.shot.time_code;
  if (!code.empty() && !frames_of_time_code(code, scene.fps))
    return Problem{"shot.time_code", no_time_code_text(code, scene.fps),
                   "expected HH:MM:SS:FF, as in \"01:00:00:00\""};
  if (!has_burn_in(scene.burn_in)) return {};
  const Values values = values_of(scene, {});
  std::optional<Problem> found;
  for (const Place& place : places_of(scene.burn_in)) {
    const std::string address = std::string("burn_in.") + place.key;
    const Filled filled = fill(*place.text, [&](const std::string& name) {
      if (found || values.contains(name)) return std::string();
      std::vector<std::string> known;
      for (const auto& [other, value] : values) known.push_back(other);
      found = Problem{address, "there is no value {" + name + "}",
                      advice::suggest(name, {"", known},
                                      "expected frame, time, time_code, range, view, changes, or "
                                      "an address, as in {material.snow.hardening}")};
      return std::string();
    });
    if (!found && filled.is_open)
      found = Problem{address, "a brace has no end: " + toml::toml_string(*place.text),
                      "expected a name between { and }, as in {frame}; a brace itself is {{"};
  }
  return found;
}

namespace {

/// "hardening" of material.snow.hardening, "post center" of collider.post.shape.sphere.center.
std::string short_name(const std::string& address) {
  const std::size_t first = address.find('.'), last = address.rfind('.');
  if (first == std::string::npos) return address;
  const std::string kind = address.substr(0, first), word = address.substr(last + 1);
  const bool is_of_one = kind == "body" || kind == "collider" || kind == "emitter" ||
                         kind == "sink" || kind == "material";
  const std::size_t second = address.find('.', first + 1);
  if (!is_of_one || second == std::string::npos) return word;
  const std::string name = address.substr(first + 1, second - first - 1);
  return name == "snow" && kind == "material" ? word : name + " " + word;
}

/// True where nothing is left of an earlier change: its whole table is set or removed after it, or
/// the preset that sets its number.
bool replaces(const std::string& later, const std::string& earlier) {
  if (earlier.starts_with(later + ".")) return true;
  if (!is_preset_address(later)) return false;
  const std::vector<std::string> numbers = addresses_set_by(later);
  return std::find(numbers.begin(), numbers.end(), earlier) != numbers.end();
}

}  // namespace

std::vector<std::string> override_lines(const std::vector<std::string>& overrides) {
  std::map<std::string, std::string> by_address;  // the last value of an address counts
  std::map<std::string, int> named_alike;
  std::vector<std::string> order;
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) continue;
    const std::string address = text.substr(0, equals);
    if (!concerns_simulation(address)) continue;
    std::erase_if(order, [&](const std::string& earlier) {
      if (!replaces(address, earlier)) return false;
      --named_alike[short_name(earlier)];
      return by_address.erase(earlier) > 0;
    });
    if (!by_address.contains(address)) {
      order.push_back(address);
      ++named_alike[short_name(address)];
    }
    by_address[address] = text.substr(equals + 1);
  }
  std::vector<std::string> lines;
  for (const std::string& address : order) {
    const std::string name = short_name(address);
    const std::string& value = by_address[address];
    if (is_object_address(address))
      lines.push_back((value == "none" ? "removed " : "set ") + address);
    else
      lines.push_back((named_alike[name] > 1 ? address : name) + " = " + value);
  }
  return lines;
}

std::vector<std::string> change_lines(const std::vector<LiveChange>& changes) {
  std::vector<std::string> texts, objects;
  for (const LiveChange& change : changes) {
    const std::string step = "step " + std::to_string(change.step);
    if (is_object_address(change.address))
      objects.push_back((change.value == "none" ? "removed " : "added ") + change.address + " at " +
                        step);
    else
      texts.push_back(change.address + "=" + change.value + " since " + step);
  }
  std::vector<std::string> lines = override_lines(texts);
  lines.insert(lines.end(), objects.begin(), objects.end());
  return lines;
}

std::vector<std::string> change_lines(const std::vector<std::string>& overrides,
                                      const std::vector<LiveChange>& changes) {
  std::vector<std::string> lines = override_lines(overrides);
  for (std::string& line : change_lines(changes)) lines.push_back(std::move(line));
  return lines;
}

void write_changes(const std::vector<std::string>& overrides, Scene& scene) {
  const std::string name = "{changes}";
  std::string changes;  // its own braces are none of a value
  for (const char c : joined(override_lines(overrides), ", "))
    changes += c == '{' || c == '}' ? std::string(2, c) : std::string(1, c);
  BurnIn& b = scene.burn_in;
  for (std::string* text :
       {&b.top_left, &b.top, &b.top_right, &b.bottom_left, &b.bottom, &b.bottom_right}) {
    std::size_t at = 0;
    while ((at = text->find('{', at)) != std::string::npos) {
      const bool is_name = text->compare(at, name.size(), name) == 0;
      if (is_name) text->replace(at, name.size(), changes);
      // One that is meant as a brace is written twice.
      at += is_name ? changes.size() : text->compare(at, 2, "{{") == 0 ? 2 : 1;
    }
  }
}

}  // namespace neve::app::scene
