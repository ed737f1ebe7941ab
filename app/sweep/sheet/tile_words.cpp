#include "app/sweep/sheet/tile_words.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>

#include "app/support/text.h"
#include "app/sweep/plan/labels.h"

namespace neve::app::sweep::sheet {

namespace {

/// Drawn values have more digits than anyone reads on a tile.
std::string drawn_text(const std::string& value) {
  const std::optional<double> number = number_of(value);
  if (!number) return plan::value_text(value);
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", *number);
  return plan::value_text(text);
}

/// "hardening = 5"
std::string setting_words(const store::Manifest& manifest, const Parameter& parameter,
                          const std::string& value) {
  const std::string text = manifest.screened.empty() ? plan::value_text(value) : drawn_text(value);
  return parameter.name + " = " + text + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

bool is_of(const store::AxisLabels& axis, const std::string& address) {
  return std::find(axis.addresses.begin(), axis.addresses.end(), address) != axis.addresses.end();
}

/// "hardening = 8.333, was 5" for each parameter of the axis.
std::vector<std::string> changed_words(const store::Manifest& manifest, const Run& run,
                                       const store::AxisLabels& axis) {
  const Run& before = manifest.runs[manifest.place_of(run) - 1];
  std::vector<std::string> words;
  for (const Parameter& parameter : manifest.parameters)
    if (is_of(axis, parameter.address))
      words.push_back(setting_words(manifest, parameter, run.setting(parameter.address)) +
                      ", was " + drawn_text(before.setting(parameter.address)));
  return words;
}

std::vector<std::string> all_words(const store::Manifest& manifest, const Run& run,
                                   bool has_edges) {
  const bool is_at_edges = has_edges && run.coordinates.size() == manifest.axes.size();
  const auto is_at_edge = [&](const std::string& address) {
    return is_at_edges && std::any_of(manifest.axes.begin(), manifest.axes.end(),
                                      [&](const auto& axis) { return is_of(axis, address); });
  };
  std::vector<std::string> words;
  for (const Parameter& parameter : manifest.parameters) {
    const std::string value = run.setting(parameter.address);
    if (!value.empty() && !is_at_edge(parameter.address))
      words.push_back(setting_words(manifest, parameter, value));
  }
  return words;
}

/// Words with commas between, in lines.
std::vector<std::string> lines_with(const std::vector<std::string>& words, std::size_t letters) {
  std::vector<std::string> lines;
  for (const std::string& word : words) {
    if (!lines.empty() && lines.back().size() + 2 + word.size() <= letters)
      lines.back() += ", " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

/// Leaves out what has no room, and says so.
std::vector<std::string> fitted(const std::vector<std::string>& words, const WordRoom& room) {
  std::vector<std::string> lines = lines_with(words, room.letters);
  for (std::size_t shown = words.size(); lines.size() > room.lines && shown > 0; --shown) {
    std::vector<std::string> some(words.begin(),
                                  words.begin() + static_cast<std::ptrdiff_t>(shown - 1));
    some.push_back(fmt::format("and {} more", words.size() - some.size()));
    lines = lines_with(some, room.letters);
  }
  return lines;
}

}  // namespace

int changed_axis(const store::Manifest& manifest, const Run& run) {
  if (manifest.screened.empty() || run.index == 0) return -1;
  const std::size_t place = manifest.place_of(run);
  const Run& before = manifest.runs[place - 1];
  if (run.coordinates.empty() || run.coordinates.size() != before.coordinates.size()) return -1;
  // A start may lie one step from the end before: trajectories have a run more than axes.
  const std::size_t length = manifest.screened.size() + 1;
  if (place % length == 0) return -1;
  int changed = -1;
  for (std::size_t a = 0; a < run.coordinates.size(); ++a)
    if (run.coordinates[a] != before.coordinates[a]) {
      if (changed >= 0) return -1;
      changed = static_cast<int>(a);
    }
  return changed;
}

std::vector<std::string> tile_words(const store::Manifest& manifest, const Run& run, bool has_edges,
                                    const WordRoom& room) {
  std::vector<std::string> lines;
  if (manifest.tile_label == "none") return lines;
  if (!run.label.empty()) lines.push_back(run.label);
  if (manifest.tile_label == "name") {
    if (lines.empty()) lines.push_back(store::run_text(run));
    return lines;
  }
  const int axis = changed_axis(manifest, run);
  const std::vector<std::string> words =
      axis >= 0 ? changed_words(manifest, run, manifest.screened[static_cast<std::size_t>(axis)])
                : all_words(manifest, run, has_edges);
  const WordRoom rest{room.letters,
                      std::max<std::size_t>(1, room.lines - std::min(room.lines, lines.size()))};
  for (std::string& line : fitted(words, rest)) lines.push_back(std::move(line));
  return lines;
}

}  // namespace neve::app::sweep::sheet
