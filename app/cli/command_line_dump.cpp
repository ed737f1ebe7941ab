/// The command line of `neve dump`.

#include <memory>

#include "app/cli/command_line_parts.h"
#include "app/dump/dump_options.h"
#include "app/setup/argument_text.h"

namespace neve::app::cli {

namespace {

/// Values that CLI11 delivers as text.
struct DumpTexts {
  std::string at = "0s", format = "table";
  std::optional<std::string> stage;
  std::vector<std::string> probes;
};

dump::DumpOptions finished_dump(dump::DumpOptions options, const run::RenderOptions& run,
                                const RenderTexts& run_texts, const DumpTexts& texts) {
  options.run = finished(run, run_texts);
  options.at = setup::parse_times(texts.at);
  options.format = dump::parse_format(texts.format);
  if (texts.stage) options.stage = dump::parse_stage(*texts.stage);
  for (const std::string& probe : texts.probes) options.probes.push_back(dump::parse_probe(probe));
  return options;
}

}  // namespace

void add_dump(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("dump",
                         "Print numbers inside a step: fields of nodes and particles at a time, "
                         "after a stage, with their expected ranges");
  const auto options = std::make_shared<dump::DumpOptions>();
  const auto run = std::make_shared<run::RenderOptions>();
  const auto run_texts = std::make_shared<RenderTexts>();
  const auto texts = std::make_shared<DumpTexts>();
  add_origin(*command, run, run_texts);
  command
      ->add_option(
          "--at", texts->at,
          "Times in seconds, as in 0.1,0.2, all of one simulation; neve shows the step that "
          "contains each. A run is simulated from the nearest moment that it has kept")
      ->type_name("T,T")
      ->capture_default_str();
  command
      ->add_option("--stage", texts->stage,
                   "Print the results of this stage, as in elastic_forces; default: the particles "
                   "before the step")
      ->type_name("NAME");
  add_repeatable(*command, "--field", options->fields, "NAME",
                 "Print only this quantity (repeatable)");
  add_repeatable(*command, "--probe", texts->probes, "ID|X,Y,Z",
                 "Print only one particle, or the one nearest to a place in metres (repeatable)");
  command->add_option("--format", texts->format, "table (tabs), or vtk for ParaView")
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option(
          "--out", options->file,
          "Write to a file instead of standard output; of several times into FILE_0000 and so "
          "on")
      ->type_name("FILE");
  command->add_flag("--json", run->is_json, "Print summary and probes as JSON");
  add_progress(*command, run_texts->progress, run->progress);
  command->add_flag("--quiet,-q", run_texts->is_quiet, "Print only errors and warnings");
  command->final_callback([=, &action] {
    action = [=] { return run_dump(finished_dump(*options, *run, *run_texts, *texts)); };
  });
}

}  // namespace neve::app::cli
