/// Options of the commands that simulate a scene or look at runs.

#include <algorithm>
#include <filesystem>
#include <set>

#include "app/cli/commands.h"
#include "app/options/common.h"
#include "app/options/languages.h"
#include "app/scene/describe.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::cli {

namespace {

using options::Command;

void check_picture(const std::string& flag, const std::string& file) {
  if (std::filesystem::path(file).extension() != ".png")
    throw UsageError(flag, "is not the name of a picture", "expected a file that ends in .png");
}

/// The keys of [[export]] about dust and the surface are flags too, as the scene describes them.
struct SurfaceFlags {
  Command& visit;

  template <class T>
  void operator()(const char* key, T& member, const char*, const scene::Valid& valid, scene::Change,
                  std::string help) const {
    static const std::set<std::string> keys{"dust", "surface", "surface_cell", "surface_smoothing",
                                            "smallest_piece"};
    if (!keys.contains(key)) return;
    std::string flag = std::string("--") + key;
    std::replace(flag.begin(), flag.end(), '_', '-');
    help.pop_back();  // flags have no full stop
    std::string expected = valid.text_of_bounds();
    if (std::string_view(key) == "surface_cell") expected += " in particle spacings, not metres";
    [[maybe_unused]] const auto add = [&](const auto& language) {
      visit(flag.c_str(), member, language, help)
          .with_default()
          .needs("--surface", "needs a surface", "give --surface too");
    };
    if constexpr (std::is_same_v<T, bool>)
      visit(flag.c_str(), member, help);
    else if constexpr (std::is_same_v<T, double>)
      add(options::number<double>("N", valid.min, valid.max, expected));
    else if constexpr (std::is_same_v<T, int>)
      add(options::number<int>("N", valid.min, valid.max, expected));
  }
};

/// Names that are no attributes of neve are columns of point files, which the scene knows.
void read_attributes(const std::string& text, scene::Export& e) {
  const options::Language<scene::ExportAttribute> ours =
      options::choice<scene::ExportAttribute>("A,A");
  e.attributes.clear();
  e.carried.clear();
  const auto add = [](auto& list, const auto& item) {
    if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
  };
  for (const std::string& word : comma_separated(text))
    if (!scene::value_named<scene::ExportAttribute>(word) && scene::is_identifier(word))
      add(e.carried, word);
    else
      add(e.attributes, ours.read("--attributes", word));
  if (e.attributes.empty() && e.carried.empty())
    throw UsageError("--attributes", "names nothing",
                     "expected some of " + joined(scene::choices<scene::ExportAttribute>(), ", "));
}

std::string attributes_text(const scene::Export& e) {
  const scene::Export usual;
  if (e.attributes == usual.attributes && e.carried == usual.carried) return "";
  std::vector<std::string> names;
  for (const auto attribute : e.attributes) names.emplace_back(scene::name(attribute));
  names.insert(names.end(), e.carried.begin(), e.carried.end());
  return joined(names, ",");
}

/// neve dump J_P, or --histogram J_P: the first word without a dash is the scene.
void refuse_field_as_scene(const dump::DumpOptions& o) {
  std::error_code error;
  if (o.run.scene.find_first_of("./") != std::string::npos ||
      std::filesystem::exists(o.run.scene, error))
    return;
  const std::string advice = dump::field_advice(o.run.scene);
  if (!advice.empty())
    throw UsageError("SCENE", "there is no file \"" + o.run.scene + "\"",
                     o.is_histogram ? dump::field_advice(o.run.scene, true) : advice);
}

void describe_formats(Command& visit, ExportCommand& o) {
  const options::Language<scene::ExportFormat> format =
      options::choice<scene::ExportFormat>("F", "format of an export");
  visit("--format", o.formats, options::list("F,F", format),
        "Formats, separated by commas: " + joined(scene::choices<scene::ExportFormat>(), ", "))
      .required();
  visit("--at", o.at, options::times(),
        "Times in seconds instead of frames; neve writes the state before the step that contains "
        "each")
      .excludes({"--frames"}, "give one of the two");
  std::vector<std::string> usual;
  for (const auto attribute : scene::Export{}.attributes)
    usual.emplace_back(scene::name(attribute));
  visit.custom(
      "--attributes", "A,A", "id,v",
      [&o](const std::string& text) { read_attributes(text, o.common); },
      [&o] { return attributes_text(o.common); },
      "Attributes of the particles instead of " + joined(usual, ",") + ": some of " +
          joined(scene::choices<scene::ExportAttribute>(), ", ") +
          ", and columns of the bodies' point files");
  visit("--body", o.common.bodies, options::text("NAME", "ball"),
        "Write only the particles of this body or emitter (repeatable)");
  visit("--up", o.common.up, options::choice<scene::UpAxis>("AXIS"),
        "Axis that points up in the files, y or z")
      .with_default();
  visit(
      "--scale", o.common.scale,
      options::number<double>("S", 1e-6, 1e6,
                              "a number of units per metre from 1e-6 to 1e6, as in --scale 100 for "
                              "centimetres"),
      "Units per metre in the files, for lengths and velocities; 100: centimetres")
      .with_default();
}

}  // namespace

void describe_check(Command& visit, run::RenderOptions& o) {
  visit.about("check",
              "Forecast the cost of a scene and the limits of its steps, and warn of likely "
              "mistakes; takes a few steps and runs a coarse copy");
  visit.other_place = "name another file with --open-edges";
  describe_scene(visit, o, run::origin_help);
  visit("--predict", o.predicts,
        "Run coarse copies to the end, and say what the scene itself will do at its last frame: "
        "breaks, holds or undecided, and its size, each with an interval that holds four times in "
        "five; costs about a third of the run");
  visit("--open-edges", o.open_edges, options::text("PNG", "holes.png"),
        "Write a picture of the meshes that are open, with the edges of their holes in red");
  options::describe_backend(visit, o.backend);
  visit("--json", o.is_json, "Print JSON");
  options::describe_verbosity(visit, o.verbosity);
}

void describe_dump(Command& visit, dump::DumpOptions& o) {
  visit.about("dump",
              "Print numbers inside a step: fields of nodes and particles at a time, after a "
              "stage, with their expected ranges");
  visit.other_place = "name another file with --out";
  describe_scene(visit, o.run, run::origin_help);
  visit("--at", o.at, options::times(),
        "Times in seconds, as in 0.1,0.2, in one simulation; neve shows the step that contains "
        "each time, up to the last frame. A run continues from its nearest kept moment")
      .with_default();
  visit("--stage", o.stage,
        options::language("NAME", "advection", dump::parse_stage,
                          [](sim::Stage stage) { return sim::name(stage); }),
        "Print the results of this stage, as in elastic_forces; default: the particles before the "
        "step");
  visit("--field", o.fields, options::text("NAME", "mass"),
        "Print only this quantity (repeatable)");
  visit("--probe", o.probes,
        options::language("ID|X,Y,Z", "0,0.5,0", dump::parse_probe, dump::probe_text),
        "Print only one particle, or the one nearest to a place in metres (repeatable)");
  visit("--histogram", o.is_histogram,
        "Print how the magnitudes of each quantity are spread, as bars, instead of all rows");
  visit("--format", o.format,
        options::language("NAME", "vtk", dump::parse_format, dump::format_name),
        "table (tabs), or vtk for ParaView")
      .with_default();
  visit("--out", o.file, options::text("FILE", "fields.vtp"),
        "Write to a file instead of standard output; several times go to FILE_0000 and so on");
  visit("--json", o.run.is_json, "Print summary and probes as JSON");
  options::describe_progress(visit, o.run.progress);
  options::describe_verbosity(visit, o.run.verbosity);
  visit.word_advice = [](const Command& command, const std::string& word) {
    return dump::field_advice(word, command.has_given("--histogram"));
  };
  visit.check([&o] { refuse_field_as_scene(o); });
}

void describe_export(Command& visit, ExportCommand& o) {
  visit.about("export",
              "Write the particles, their surface and the grid at chosen times for ParaView, "
              "Houdini, USD, OpenVDB, numpy");
  describe_scene(visit, o.run,
                 "Scene file (TOML), the folder of a run, or a picture made by neve, for the state "
                 "that it shows; default: a falling snowball");
  describe_formats(visit, o);
  SurfaceFlags flags{visit};
  scene::describe(flags, o.common);
  visit("--frames", o.run.frames, options::frames(), "Frames to write: A-B, or N for all up to N");
  visit("--out", o.run.out, options::folder("ply/0000.ply"),
        "Write to DIR/<format>/0000.<ext> instead of out/<scene name>/exports");
  visit("--replace", o.run.replaces,
        "Remove exports of the folder whose place this one takes: of another scene, other frames, "
        "other parameters or attributes; without it neve says what would go and stops");
  visit("--json", o.run.is_json, "Print the list of files as JSON");
  options::describe_progress(visit, o.run.progress);
  options::describe_verbosity(visit, o.run.verbosity, "Print more");
}

void describe_strip(Command& visit, run::StripOptions& o) {
  const auto count = [](int least, const char* expected) {
    return options::number<int>("N", least, 200, expected);
  };
  visit.about("strip", "Draw one view at several times, side by side in one picture");
  describe_scene(visit, o.run,
                 "Scene file (TOML), the folder of a run, or a strip made by neve, to make it "
                 "again; default: a falling snowball");
  visit("--view", o.run.views, options::text("NAME", "smoke"),
        "View to draw; default: the first of the scene")
      .once();
  visit("--tiles", o.tiles, count(1, "1 to 200 moments"),
        "Number of moments, evenly spread over the frames; default: 6");
  visit("--frames", o.run.frames, options::frames(),
        "Frames over which the moments are spread: A-B, or N for all up to N");
  visit("--at", o.at, options::times(), "Times in seconds, instead of --tiles")
      .excludes({"--frames", "--tiles"}, "give the times alone");
  visit("--columns", o.columns, count(0, "1 to 200, or 0 for about a screen"),
        "Number of tiles side by side; 0, the default: chosen for about 16:9");
  visit("--width", o.width, options::number<int>("PX", 160, 16384, "160 to 16384 pixels"),
        "Width of the whole picture in pixels; default: 1920");
  visit("--out", o.run.out, options::text("PNG", "strip.png", check_picture),
        "Write to this file instead of out/<scene name>/strip_<view>.png");
  options::describe_backend(visit, o.run.backend);
  visit("--json", o.run.is_json, "Print the file and its times as JSON");
  options::describe_progress(visit, o.run.progress);
  options::describe_verbosity(visit, o.run.verbosity, "Print more");
}

void describe_compare(Command& visit, CompareOptions& o) {
  compare::PairOptions& pictures = o.pictures;
  visit.about("compare",
              "Compare two pictures, or the states of two runs frame by frame; with --out as "
              "pictures, movies and curves");
  visit.other_place = "name another place with --out";
  visit("A", pictures.a, options::text(""),
        "A PNG, or the folder of a run; for one run of a sweep: DIR/runs/0000")
      .required();
  visit("B", pictures.b, options::text(""), "The other PNG or folder").required();
  const options::Language<double> mean =
      options::number<double>("MEAN", 0, 255, "a number from 0 to 255");
  visit("--threshold", o.threshold, mean, "Largest mean difference of pictures allowed, 0 to 255")
      .with_default();
  visit("--local-threshold", o.local_threshold, mean,
        "Largest mean difference allowed in any 8x8 block; catches small local changes")
      .with_default();
  visit("--out", pictures.out, options::text("DIR|FILE", "x.png"),
        "Draw both runs with one camera and one light, into a folder with all modes, or into a "
        "file: x.png (the last frame), x.mp4 or another movie, x.csv for the metrics");
  const std::size_t first = visit.options.size();
  visit("--mode", pictures.modes, options::choice<compare::Mode>("NAME"),
        "How --out shows both (repeatable for a folder): " +
            joined(scene::choices<compare::Mode>(), ", "));
  visit("--frames", pictures.frames, options::frames(),
        "Frames to draw: A-B, or N for all up to N");
  visit("--view", pictures.view, options::text("NAME", "smoke"),
        "View of A to draw; default: the first");
  visit("--size", pictures.size, options::size(), "Size of the picture of one run");
  visit(
      "--wipe", pictures.wipe,
      options::number<double>("SHARE", 0, 1, "a share of the width from 0 to 1, as in --wipe 0.3"),
      "Share of the width that shows A in mode wipe, 0 to 1")
      .with_default();
  visit("--range", pictures.range,
        options::number<double>("M", 1e-12, 1e12, "a number of metres, as in --range 0.1"),
        "Displacement in metres that gets the last colour; default: ten cells");
  visit("--replace", pictures.replaces,
        "Remove an earlier comparison of the folder that is of other runs, or has frames or modes "
        "that this one does not make; without it neve says what would go and stops");
  options::describe_movie(visit, pictures.movie);
  for (std::size_t k = first; k < visit.options.size(); ++k)
    visit.options[k].needs("--out", "needs pictures",
                           "give --out DIR, --out x.png or --out x.mp4 too");
  options::describe_threads(visit, pictures.threads);
  options::describe_backend(visit, pictures.backend);
  options::describe_caps(visit, pictures.caps);
  run::describe_agreement(visit, pictures.is_agreed);
  options::describe_progress(visit, pictures.progress);
  options::describe_verbosity(visit, pictures.verbosity);
  visit("--json", o.is_json, "Print the result as JSON");
}

}  // namespace neve::app::cli
