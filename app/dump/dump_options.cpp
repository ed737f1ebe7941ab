#include "app/dump/dump_options.h"

#include <algorithm>

#include "app/advice/suggest.h"
#include "app/dump/quantities.h"
#include "app/scene/names.h"
#include "app/scene/toml/value.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::dump {

namespace {

/// A stage by its number in the paper, by a name that transfers have everywhere, by a part that
/// only one name has, or by its spelling; "": none.
std::string stage_meant(const std::string& text, const std::vector<std::string>& names) {
  if (const auto number = number_of<int>(text);
      number && *number >= 1 && *number <= static_cast<int>(names.size()))
    return names[static_cast<std::size_t>(*number - 1)];
  std::vector<std::string> longer;
  for (const std::string& name : names)
    if (text.size() > 3 && name.find(text) != std::string::npos) longer.push_back(name);
  return longer.size() == 1 ? longer.front() : advice::meant_name(text, {"stage", names});
}

/// Returns what was expected, or --field where the value of another option names a quantity.
std::string or_field(const std::string& text, bool is_nothing_nearer, const std::string& expected) {
  const std::string advice = is_nothing_nearer ? field_advice(text) : "";
  return advice.empty() ? expected : advice;
}

}  // namespace

std::string field_advice(const std::string& word, bool is_histogram) {
  const std::vector<std::string>& names = quantity_names();
  const bool is_name = std::find(names.begin(), names.end(), word) != names.end();
  const std::string meant = is_name ? word : advice::meant_name(word, {"attribute", names});
  if (meant.empty() && !is_histogram) return {};
  const std::string named = "--field " + (meant.empty() ? "J_P" : meant);
  if (!is_histogram) return meant + " is a quantity: " + named;
  return "--field names the quantity" + std::string(meant.empty() ? ", as in " : ": ") + named +
         " --histogram";
}

sim::Stage parse_stage(const std::string& text) {
  if (const auto stage = scene::value_named<sim::Stage>(text)) return *stage;
  const std::vector<std::string> names(sim::stage_names.begin(), sim::stage_names.end());
  const std::string meant = stage_meant(text, names);
  throw UsageError("--stage", "there is no stage \"" + text + "\"",
                   or_field(text, meant.empty(), advice::expected_one_of(names, meant)));
}

Probe parse_probe(const std::string& text) {
  if (const auto id = number_of<int>(text); id && *id >= 0) return static_cast<std::size_t>(*id);
  std::vector<double> numbers;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const auto value = finite_number(text.substr(begin, comma - begin));
    if (!value) break;
    numbers.push_back(*value);
    begin = comma + 1;
  }
  if (begin <= text.size() || numbers.size() != 3)
    throw UsageError(
        "--probe", "cannot use \"" + text + "\"",
        or_field(text, true, "expected the id of a particle, or a place as in --probe 0,0.5,0"));
  return sim::Vec3d(numbers[0], numbers[1], numbers[2]);
}

std::string probe_text(const Probe& probe) {
  if (const auto* id = std::get_if<std::size_t>(&probe)) return std::to_string(*id);
  const sim::Vec3d& place = std::get<sim::Vec3d>(probe);
  std::string text;
  for (const double x : {place.x(), place.y(), place.z()})
    text += (text.empty() ? "" : ",") + scene::toml::number_text(x);
  return text;
}

DumpFormat parse_format(const std::string& text) {
  if (text == "table") return DumpFormat::table;
  if (text == "vtk") return DumpFormat::vtk;
  throw UsageError("--format", "cannot use \"" + text + "\"",
                   or_field(text, true,
                            "expected table or vtk; neve export writes ply, vtp, bgeo, usda, npz "
                            "and csv"));
}

}  // namespace neve::app::dump
