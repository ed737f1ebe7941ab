#include "app/dump/dump_options.h"

#include <algorithm>
#include <string>
#include <vector>

#include "app/scene/names.h"
#include "app/setup/argument_text.h"
#include "app/support/errors.h"
#include "app/support/lower_text.h"
#include "app/support/text.h"

namespace neve::app::dump {

namespace {

[[noreturn]] void fail_stage(const std::string& text, const std::string& meant,
                             const std::vector<std::string>& names) {
  throw UsageError("--stage", "there is no stage \"" + text + "\"",
                   "did you mean " + meant + "? expected " + joined(names, ", "));
}

}  // namespace

sim::Stage parse_stage(const std::string& text) {
  if (const auto stage = scene::value_named<sim::Stage>(text)) return *stage;
  const std::vector<std::string> names(sim::stage_names.begin(), sim::stage_names.end());
  // Numbers are those of the paper; transfers have two names everywhere.
  if (const auto number = number_of<int>(text);
      number && *number >= 1 && *number <= static_cast<int>(names.size()))
    fail_stage(text, names[static_cast<std::size_t>(*number - 1)], names);
  const std::string word = lower_text(text);
  if (word == "p2g") fail_stage(text, "rasterize", names);
  if (word == "g2p") fail_stage(text, "particle_velocities", names);
  // "forces" is part of one name alone.
  std::vector<std::string> longer;
  for (const std::string& name : names)
    if (text.size() > 3 && name.find(text) != std::string::npos) longer.push_back(name);
  throw UsageError("--stage", "there is no stage \"" + text + "\"",
                   longer.size() == 1
                       ? "did you mean " + longer.front() + "? expected " + joined(names, ", ")
                       : names_advice(text, names));
}

Probe parse_probe(const std::string& text) {
  if (const auto id = number_of<int>(text); id && *id >= 0) return static_cast<std::size_t>(*id);
  std::vector<double> numbers;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const auto value = setup::finite_number(text.substr(begin, comma - begin));
    if (!value) break;
    numbers.push_back(*value);
    begin = comma + 1;
  }
  if (begin <= text.size() || numbers.size() != 3)
    throw UsageError("--probe", "cannot use \"" + text + "\"",
                     "expected the id of a particle, or a place as in --probe 0,0.5,0");
  return sim::Vec3d(numbers[0], numbers[1], numbers[2]);
}

DumpFormat parse_format(const std::string& text) {
  if (text == "table") return DumpFormat::table;
  if (text == "vtk") return DumpFormat::vtk;
  throw UsageError("--format", "cannot use \"" + text + "\"",
                   "expected table or vtk; neve export writes ply, vtp, bgeo, usda, npz and csv");
}

}  // namespace neve::app::dump
