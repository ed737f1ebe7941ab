/// The command line of `neve export`.

#include <algorithm>
#include <memory>
#include <string_view>
#include <type_traits>

#include "app/cli/command_line_parts.h"
#include "app/scene/describe.h"
#include "app/scene/export_advice.h"
#include "app/scene/leaf.h"
#include "app/setup/argument_text.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

/// Values that CLI11 delivers as text.
struct ExportTexts {
  std::string formats, up = "y";
  std::optional<std::string> at, attributes;
  std::vector<std::string> bodies;
  double scale = 1;
  scene::Export surface;  ///< its keys of the surface alone
};

/// The description of a key of [[export]], for the flag of the same parameter.
class ExportKey {
 public:
  ExportKey(const char* flag, const char* key) : flag_(flag), key_(key) {
    scene::Export e;
    scene::describe(*this, e);
  }

  template <class T>
  void operator()(const char* key, const T&, const char*, const scene::Valid& valid, scene::Change,
                  const char* help) {
    if (key_ != key) return;
    valid_ = valid;
    help_ = help;
    help_.pop_back();  // flags have no full stop
  }

  const char* flag() const { return flag_; }
  const std::string& help() const { return help_; }
  void check(double value) const {
    if (!valid_.contains(value))
      throw UsageError(flag_, "cannot use " + rough_text(value),
                       "expected " + valid_.text_of_bounds());
  }

 private:
  const char* flag_;
  std::string_view key_;
  scene::Valid valid_;
  std::string help_;
};

const ExportKey& surface_key() {
  static const ExportKey key("--surface", "surface");
  return key;
}
const ExportKey& cell_key() {
  static const ExportKey key("--surface-cell", "surface_cell");
  return key;
}
const ExportKey& smoothing_key() {
  static const ExportKey key("--surface-smoothing", "surface_smoothing");
  return key;
}
const ExportKey& piece_key() {
  static const ExportKey key("--smallest-piece", "smallest_piece");
  return key;
}

template <scene::Choice E>
E choice_of(const char* flag, const std::string& word) {
  if (const std::optional<E> value = scene::value_named<E>(word)) return *value;
  std::string hint;
  if constexpr (std::is_same_v<E, scene::ExportFormat>) hint = scene::export_format_advice(word);
  throw UsageError(flag, "there is no \"" + word + "\"",
                   hint.empty() ? names_advice(word, scene::choices<E>()) : hint);
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
    throw UsageError(flag, "names nothing",
                     "expected some of " + joined(scene::choices<E>(), ", "));
  return values;
}

/// Names that are no attributes of neve are columns of point files, which the scene knows.
void set_attributes(const std::string& text, scene::Export& e) {
  std::string ours;
  for (const std::string& word : setup::comma_separated(text)) {
    const bool is_ours = scene::value_named<scene::ExportAttribute>(word).has_value();
    const bool is_new = std::find(e.carried.begin(), e.carried.end(), word) == e.carried.end();
    if (!is_ours && scene::is_identifier(word)) {
      if (is_new) e.carried.push_back(word);
    } else {
      ours += (ours.empty() ? "" : ",") + word;
    }
  }
  e.attributes.clear();
  if (!ours.empty() || e.carried.empty())
    e.attributes = choices_in<scene::ExportAttribute>("--attributes", ours);
}

void check_surface(const CLI::App& command, const scene::Export& e) {
  cell_key().check(e.surface_cell);
  smoothing_key().check(e.surface_smoothing);
  piece_key().check(e.smallest_piece);
  if (e.surface) return;
  for (const ExportKey* key : {&cell_key(), &smoothing_key(), &piece_key()})
    if (command.count(key->flag()) > 0)
      throw UsageError(key->flag(), "has no use without a surface", "give --surface too");
}

run::ExportOptions finished_export(const CLI::App& command, const run::RenderOptions& run,
                                   const RenderTexts& run_texts, const ExportTexts& texts) {
  run::ExportOptions options;
  options.run = finished(run, run_texts);
  if (command.count("--out") > 0 && options.run.out.empty())
    throw UsageError("--out", "names no folder", "expected the path of a folder");
  require_folder_name(options.run.out, "ply/0000.ply");
  if (texts.at && options.run.frames)
    throw UsageError("--at", "cannot be combined with --frames", "give one of the two");
  if (texts.at) options.at = setup::parse_times(*texts.at);
  if (!(texts.scale >= 1e-6 && texts.scale <= 1e6))
    throw UsageError("--scale", "cannot use " + rough_text(texts.scale),
                     "expected 1e-6 to 1e6, as in --scale 100 for centimetres");
  check_surface(command, texts.surface);
  scene::Export common = texts.surface;
  common.bodies = texts.bodies;
  common.up = choice_of<scene::UpAxis>("--up", texts.up);
  common.scale = texts.scale;
  if (texts.attributes) set_attributes(*texts.attributes, common);
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
                      ": some of " + joined(scene::choices<scene::ExportAttribute>(), ", ") +
                      ", and columns of the bodies' point files")
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
  command.add_flag(surface_key().flag(), texts->surface.surface, surface_key().help());
  const auto add_number = [&](const ExportKey& key, auto& member) {
    command.add_option(key.flag(), member, key.help())->type_name("N")->capture_default_str();
  };
  add_number(cell_key(), texts->surface.surface_cell);
  add_number(smoothing_key(), texts->surface.surface_smoothing);
  add_number(piece_key(), texts->surface.smallest_piece);
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "export",
      "Write the particles, their surface and the grid at some times for ParaView, Houdini, USD, "
      "OpenVDB, numpy");
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
