/// Options of the commands that take little.

#include "app/cli/commands.h"
#include "app/options/common.h"
#include "app/options/languages.h"

namespace neve::app::cli {

namespace {

using options::Command;

constexpr const char* json_help = "Print JSON";

/// The one argument of a command.
options::Option& describe_argument(Command& visit, const char* name, std::string& member,
                                   const char* help) {
  return visit(name, member, options::text(""), help);
}

}  // namespace

void describe_new(Command& visit, PlainOptions& o) {
  visit.about("new", "Write a first scene in which every line is explained");
  visit.other_place = "choose another folder, as in neve new FOLDER/NAME";
  describe_argument(
      visit, "NAME", o.name,
      "Name of the scene, as in my_scene or FOLDER/my_scene; an existing file is not overwritten. "
      "neve also writes scene.schema.json beside it, for editors that complete TOML (taplo)")
      .required();
  visit("--json", o.is_json, "Print the names of the files as JSON");
}

void describe_info(Command& visit, PlainOptions& o) {
  visit.about("info", "Print the scene and parameters of a picture, or the state of a run");
  visit.other_place = "";
  describe_argument(visit, "FILE", o.name, "A PNG or EXR, run.json, or the folder of a run")
      .required();
  visit("--json", o.is_json, json_help);
}

void describe_verify(Command& visit, PlainOptions& o) {
  visit.about(
      "verify",
      "Check that every file of a run or a sweep exists and is unchanged, its kept states and "
      "checkpoints too");
  visit.other_place = "";
  describe_argument(visit, "DIR", o.name, "Output folder of a run or a sweep").required();
  visit("--json", o.is_json, json_help);
  visit("--quiet,-q", o.is_quiet, "Print only flaws");
}

void describe_doctor(Command& visit, PlainOptions& o) {
  visit.about("doctor",
              "Test the OpenGL backends of this machine, say why others do not work, and run the "
              "self-tests of the physics");
  visit.other_place = "";
  visit("--json", o.is_json, json_help);
}

void describe_schema(Command& visit, PlainOptions& o) {
  visit.about("schema",
              "Print the JSON Schema of scenes or sweeps, for editors and other programs");
  visit.other_place = "";
  describe_argument(visit, "KIND", o.name, "scene (default) or sweep");
}

void describe_manual(Command& visit, PlainOptions& o) {
  visit.about("manual", "Write man pages, and completions for bash, zsh and fish, into a folder");
  visit.other_place = "choose another folder, as in neve manual DIR";
  describe_argument(visit, "DIR", o.name, "Folder in which man1, bash, zsh and fish are made")
      .required();
}

void describe_version(Command& visit, PlainOptions& o) {
  visit.about("version",
              "Print the version, and the build: commit, type, compiler, instruction set");
  visit.other_place = "";
  visit("--json", o.is_json, json_help);
}

void describe_help(Command& visit, PlainOptions& o) {
  visit.about("help", "Print this help, or the help of a command");
  visit.other_place = "";
  visit("COMMAND", o.names, options::text(""),
        "A command and its subcommand, as in neve help sweep run");
  visit("--json", o.is_json, "Print every option as JSON");
}

void describe_params(Command& visit, ParamsOptions& o) {
  visit.about("params", "List or search parameters: address, unit, range, default");
  visit.other_place = "";
  visit(
      "WORD", o.filter, options::text(""),
      "List only parameters whose address or description has this word, whose unit it is, or that "
      "an everyday word means, as in camera, \"time step\", Pa, sticky");
  visit("--wishes", o.is_wishes,
        "Print the table from wishes (stickier, heavier, ...) to parameters");
  visit("--markdown", o.is_markdown, "With --wishes, print it as in docs/wishes.md")
      .needs("--wishes", "is a way to print the table of wishes", "give --wishes too");
  visit("--sweep", o.is_sweep, "List the parameters of sweep files instead of scenes");
  visit("--json", o.is_json, json_help);
}

}  // namespace neve::app::cli
