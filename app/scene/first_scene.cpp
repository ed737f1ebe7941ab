#include "app/scene/first_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "app/scene/params.h"
#include "app/support/text.h"

namespace neve::app::scene {
namespace {

constexpr std::size_t columns = 100;

/// Lines "@ADDRESS" are replaced by the description of that parameter; so are %FILE% and %SCHEMA%
/// by names of files, and %TITLE% by a string.
constexpr std::string_view layout = R"(#:schema %SCHEMA%
# A scene of neve. Lengths are metres, times seconds, masses kilograms; y is up.
#   neve check %FILE%                what it costs, and what looks wrong
#   neve render %FILE% --coarsen 2   a quick preview
#   neve view %FILE%                 live: change numbers while the snow moves
#   neve render %FILE%               pictures and a film, in a folder of out
# neve params lists every parameter, neve params --wishes says which one makes snow stickier.

@title
title = %TITLE%

@frames
frames = 36

@fps
fps = 24

# The grid and the time integration.
[solver]
@solver.cell_size
cell_size = 0.025

@solver.gravity
gravity = [0, -9.81, 0]

# A kind of snow. Bodies name it; the one called "snow" is that of bodies that name none.
[material.snow]
@material.NAME.model
model = "cam_clay"

@material.NAME.preset
preset = "quick"

# Lumps, between which it breaks: how far its strength varies, and how large the lumps are in m.
variation = { thresholds = 1.5, size = 0.1 }

@material.NAME.min_J_P
min_J_P = 0.44

# A piece of snow. Each [[body]] is one more.
[[body]]
@body.NAME.name
name = "ball"

# The volume to fill with snow: sphere, box, capsule, cylinder, cone, torus, mesh or points.
# Centre and radius in m.
shape = { sphere = { center = [-0.7, 0.3, 0], radius = 0.14 } }

@body.NAME.velocity
velocity = [6, 1, 0]

@body.NAME.material
material = "snow"

[[body]]
# A second piece: a wall. Centre and edge lengths in m.
name = "wall"
shape = { box = { center = [0, 0.25, 0], size = [0.2, 0.5, 0.7] } }

# A solid that snow cannot enter. Each [[collider]] is one more; it may move (velocity, keyframes).
[[collider]]
# Its name in addresses, as in --set collider.floor.friction=0.2.
name = "floor"

# Snow stays out of this volume: here the half space below y = 0 m.
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }

@collider.NAME.contact
contact = "separate"

@collider.NAME.friction
friction = 0.5

# Where the pictures are seen from. Without eye and target the camera frames the whole scene.
[camera]
@camera.push_in
push_in = true

# The pictures. Without a [[view]] they show snow; --view particles, smoke or slice look into it.
[output]
@output.size
size = [1280, 720]
)";

/// Text as comments, broken between words.
std::string commented(const std::string& text) {
  std::string out, line = "#";
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    if (line.size() + 1 + end - from > columns) {
      out += line + "\n";
      line = "#";
    }
    line += " " + text.substr(from, end - from);
    from = end + 1;
  }
  return out + line + "\n";
}

/// Bounds that nobody meets say nothing.
bool has_near_bounds(const Valid& valid) {
  const bool is_bounded = std::isfinite(valid.min) || std::isfinite(valid.max);
  return is_bounded && !(valid.max >= 1e6 && valid.min <= 1e-6);
}

/// "Spacing h of the grid. Unit: m; default: 0.02."
std::string description(const std::string& address) {
  const std::optional<ParamInfo> info = param_at(address);
  std::vector<std::string> facts;
  if (!info->unit.empty()) facts.push_back("unit: " + info->unit);
  if (has_near_bounds(info->valid)) facts.push_back(info->valid.text_of_bounds());
  if (!info->choices.empty()) facts.push_back("one of " + joined(info->choices, ", "));
  const std::string value =
      info->default_value ? toml::toml_literal(*info->default_value) : std::string("\"\"");
  if (value != "\"\"") facts.push_back("default: " + value);
  std::string text = joined(facts, "; ");
  if (text.empty()) return info->help;
  if (text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return info->help + " " + text + ".";
}

std::string replaced(std::string line, const std::string& word, const std::string& by) {
  if (const std::size_t at = line.find(word); at != std::string::npos)
    line.replace(at, word.size(), by);
  return line;
}

}  // namespace

std::string first_scene(const std::string& title, const std::string& file,
                        const std::string& schema) {
  std::string text;
  for (std::size_t from = 0; from < layout.size();) {
    const std::size_t end = layout.find('\n', from);
    std::string line(layout.substr(from, end - from));
    from = end + 1;
    line = replaced(replaced(line, "%FILE%", file), "%SCHEMA%", schema);
    line = replaced(line, "%TITLE%", toml::toml_string(title));
    text += line.starts_with('@') ? commented(description(line.substr(1))) : line + "\n";
  }
  return text;
}

}  // namespace neve::app::scene
