/// The command line of `neve export`.

#include <algorithm>
#include <memory>

#include "app/cli/command_line_parts.h"
#include "app/scene/leaf.h"
#include "app/scene/toml/error.h"
#include "app/setup/argument_text.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

/// Values that CLI11 delivers as text.
struct ExportTexts {
  std::string formats, up = "y";
  std::optional<std::string> at, attributes;
  std::vector<std::string> bodies;
  double scale = 1;
};

template <scene::Choice E>
E choice_of(const char* flag, const std::string& word) {
  if (const std::optional<E> value = scene::value_named<E>(word)) return *value;
  throw scene::toml::UsageError(flag, "there is no \"" + word + "\"",
                                names_advice(word, scene::choices<E>()));
}

/// "a,b": each at most once, at least one.
template <scene::Choice E>
std::vector<E> choices_in(const char* flag, const std::string& text) {
  std::vector<E> values;
  for (const std::string& word : setup::comma_separated(text)) {
    const E value = choice_of<E>(flag, word);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  if (values.empty())
    throw scene::toml::UsageError(flag, "names nothing",
                                  "expected some of " + joined(scene::choices<E>(), ", "));
  return values;
}

run::ExportOptions finished_export(const CLI::App& command, const run::RenderOptions& run,
                                   const RenderTexts& run_texts, const ExportTexts& texts) {
  run::ExportOptions options;
  options.run = finished(run, run_texts);
  if (command.count("--out") > 0 && options.run.out.empty())
    throw scene::toml::UsageError("--out", "names no folder", "expected the path of a folder");
  if (texts.at && options.run.frames)
    throw scene::toml::UsageError("--at", "cannot be combined with --frames",
                                  "give one of the two");
  if (texts.at) options.at = setup::parse_times(*texts.at);
  if (!(texts.scale >= 1e-6 && texts.scale <= 1e6))
    throw scene::toml::UsageError("--scale", "cannot use this number",
                                  "expected 1e-6 to 1e6, as in --scale 100 for centimetres");
  scene::Export common;
  common.bodies = texts.bodies;
  common.up = choice_of<scene::UpAxis>("--up", texts.up);
  common.scale = texts.scale;
  if (texts.attributes)
    common.attributes = choices_in<scene::ExportAttribute>("--attributes", *texts.attributes);
  for (const auto format : choices_in<scene::ExportFormat>("--format", texts.formats)) {
    common.format = format;
    options.exports.push_back(common);
  }
  return options;
}

void add_export_flags(CLI::App& command, const std::shared_ptr<ExportTexts>& texts) {
  const std::string formats = joined(scene::choices<scene::ExportFormat>(), ", ");
  command.add_option("--format", texts->formats, "Formats, separated by commas: " + formats)
      ->required()
      ->type_name("F,F");
  command
      .add_option("--at", texts->at,
                  "Times in seconds instead of frames; neve writes the state before the step that "
                  "contains each")
      ->type_name("T,T");
  command
      .add_option("--attributes", texts->attributes,
                  "Attributes of the particles instead of " +
                      joined(
                          [] {
                            std::vector<std::string> names;
                            for (const auto attribute : scene::Export{}.attributes)
                              names.emplace_back(scene::name(attribute));
                            return names;
                          }(),
                          ",") +
                      ": some of " + joined(scene::choices<scene::ExportAttribute>(), ", "))
      ->type_name("A,A");
  add_repeatable(command, "--body", texts->bodies, "NAME",
                 "Write only the particles of this body or emitter (repeatable)");
  command.add_option("--up", texts->up, "Axis that points up in the files, y or z")
      ->type_name("AXIS")
      ->capture_default_str();
  command
      .add_option("--scale", texts->scale,
                  "Units of the files per metre, of lengths and velocities; 100: centimetres")
      ->type_name("S")
      ->capture_default_str();
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "export", "Write the particles and the grid at some times for ParaView, Houdini, USD, numpy");
  const auto run = std::make_shared<run::RenderOptions>();
  const auto run_texts = std::make_shared<RenderTexts>();
  const auto texts = std::make_shared<ExportTexts>();
  add_scene(*command, run, run_texts);
  command->get_option("SCENE")->description(
      "Scene file (TOML), the folder of a run, or a picture made by neve, for the state that it "
      "shows; default: a falling snowball");
  add_export_flags(*command, texts);
  command->add_option("--frames", run_texts->frames, "Frames to write: A-B, or N for 0-N")
      ->type_name("A-B");
  command
      ->add_option("--out", run->out,
                   "Write to DIR/<format>/0000.<ext> instead of out/<scene name>/exports")
      ->type_name("DIR");
  command->add_flag("--json", run->is_json, "Print the list of files as JSON");
  add_progress(*command, run_texts->progress, run->progress);
  CLI::Option* quiet =
      command->add_flag("--quiet,-q", run_texts->is_quiet, "Print only errors and warnings");
  command->add_flag("--verbose,-v", run_texts->is_verbose, "Print more")->excludes(quiet);
  command->final_callback([=, &action] {
    action = [=] {
      return run_export_command(finished_export(*command, *run, *run_texts, *texts));
    };
  });
}

}  // namespace neve::app::cli
