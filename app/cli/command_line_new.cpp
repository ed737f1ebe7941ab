/// The command lines of `neve new` and `neve schema`.

#include <memory>

#include "app/cli/command_line_parts.h"

namespace neve::app::cli {

void add_new(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("new", "Write a first scene in which every line is explained");
  const auto name = std::make_shared<std::string>();
  const auto is_json = std::make_shared<bool>(false);
  command
      ->add_option("NAME", *name,
                   "Name of the scene, as in my_scene or FOLDER/my_scene; a file that is there is "
                   "not overwritten. Beside it is scene.schema.json, for editors that complete "
                   "TOML (taplo)")
      ->required()
      ->type_name("");
  command->add_flag("--json", *is_json, "Print the names of the files as JSON");
  command->final_callback([=, &action] { action = [=] { return run_new(*name, *is_json); }; });
}

void add_schema(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "schema", "Print the JSON Schema of scenes or sweeps, for editors and other programs");
  const auto kind = std::make_shared<std::string>("scene");
  command->add_option("KIND", *kind, "scene (default) or sweep")->type_name("");
  command->final_callback([=, &action] { action = [=] { return run_schema(*kind); }; });
}

}  // namespace neve::app::cli
