#include "app/run/render_options.h"

#include <filesystem>

#include "app/options/common.h"
#include "app/options/languages.h"
#include "app/run/passes.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/timeline/origin.h"

namespace neve::app::run {

namespace {

options::Language<double> mean() {
  return options::number<double>("MEAN", 0, 255, "a number from 0 to 255");
}

void describe_reference(options::Command& visit, RenderOptions& o) {
  visit("--reference", o.reference, options::text("PNG"),
        "Compare the last frame of the first view with this picture; if it differs, write "
        "DIR/difference.png and exit with 9");
  visit("--reference-threshold", o.reference_threshold, mean(),
        "Largest mean difference allowed, 0 to 255")
      .with_default();
  visit("--reference-local-threshold", o.reference_local_threshold, mean(),
        "Largest mean difference allowed in any 8x8 block; catches small local changes")
      .with_default();
}

void describe_movies(options::Command& visit, RenderOptions& o) {
  visit.sets("--no-movie", o.has_movies, false,
             "Write pictures only, no movie; the same as --movie none");
  options::describe_movie(visit, o.movie);
  visit.check([&o] {
    if (!o.has_movies && o.movie.has_format && o.movie.is_made)
      throw UsageError("--movie", "cannot be combined with --no-movie", "give one of the two");
  });
}

options::Language<double> bytes() {
  return {"SIZE", "4GiB",
          [](const std::string& flag, const std::string& text) {
            std::optional<double> size = bytes_of(text);
            if (!size) size = number_of<double>(text);
            if (size && *size >= 1 && *size < 1e18) return *size;
            throw UsageError(flag, "cannot use \"" + text + "\"",
                             "expected bytes, or a size such as 4GiB or 500MB; --no-keep-states "
                             "keeps none");
          },
          [](const double& size) { return bytes_text(static_cast<std::uint64_t>(size)); }};
}

void describe_states(options::Command& visit, RenderOptions& o) {
  visit("--keep-states", o.keeps_all_states,
        "Keep the states of all drawn frames in DIR/states, whatever they take; about 160 bytes a "
        "particle and frame")
      .excludes({"--no-keep-states", "--states-budget"}, "give one of them");
  visit.sets("--no-keep-states", o.keeps_states, false,
             "Keep no states of this run: another view, size or camera of it then has to be "
             "simulated again");
  visit("--states-budget", o.states_budget, bytes(),
        "Room for the states in DIR/states, which other views, sizes, cameras and films of the run "
        "are drawn from without simulating; more of them are thinned out, every second frame and "
        "so on, and never more than half of the free disk is taken")
      .with_default()
      .excludes({"--no-keep-states"}, "give one of them");
}

void describe_pictures(options::Command& visit, RenderOptions& o) {
  visit("--view", o.views, options::text("NAME"), "Draw only this view (repeatable)");
  visit("--size", o.size, options::size(), "Picture size of all views");
  visit("--out", o.out, options::folder("particles/0000.png"),
        "Output folder instead of out/<scene name>");
  options::describe_backend(visit, o.backend);
  visit("--quality", o.quality,
        options::language("NAME", "final", setup::quality_named,
                          [](setup::Quality quality) { return setup::name(quality); }),
        "draft: half the width and height; preview: as in the scene (default); final: four samples "
        "per pixel and motion blur");
  visit("--plate", o.plate, options::text("FILE"),
        "Picture behind the snow, PNG, JPEG or OpenEXR, or one for each frame as in "
        "street/%04d.png, street/####.png or street/$F4.png; the ground only takes shadows");
  visit("--lut", o.lut, options::text("CUBE"),
        "Look for the PNGs and movies: a .cube file of colours as they are displayed; an EXR stays "
        "as "
        "it is");
  visit("--shutter", o.shutter,
        options::number<double>(
            "DEGREES", 0, 360,
            "0 (no motion blur) to 360 (the whole frame) degrees without a unit, as in "
            "--shutter 180"),
        "Motion blur: degrees of 360 that the shutter is open in each frame; 0: none. Default: 180 "
        "with --quality final, otherwise 0");
  visit("--passes", o.passes,
        options::language("LIST", "depth,normal", parse_passes,
                          [](const std::vector<std::string>& names) { return joined(names, ","); }),
        "Write DIR/<view>/NNNN.exr too, for compositing: linear light, and these passes: all, or a "
        "list of depth, position, normal, albedo, direct, indirect, emission, shadow, motion, id, "
        "body, collider and attributes, as in J_P,v");
}

}  // namespace

void describe_agreement(options::Command& visit, bool& is_agreed) {
  visit(
      "--yes", is_agreed,
      "Agree to make a picture again that lies in no folder of a run, though it takes more than a "
      "minute or 500 MB or reads files outside of its folder: otherwise neve asks");
}

void describe_scene(options::Command& visit, RenderOptions& o, const char* help) {
  visit("SCENE", o.scene, options::scene_file(), help);
  visit("--set", o.overrides, options::text("ADDRESS=VALUE", "material.snow.hardening=5"),
        "Change a parameter, as in material.snow.hardening=5 (repeatable; neve params lists "
        "addresses)");
  visit("--coarsen", o.coarsening, options::coarsening(),
        "Make cells N times as large, for previews: 1/N^3 of the particles and longer steps, so "
        "that the simulation gets up to N^4 times cheaper");
  visit("--fast", o.is_fast,
        "Take longer steps for a quick look, by settings that are recorded like those of --set; "
        "neve check says what they gain");
  options::describe_threads(visit, o.threads);
  options::describe_caps(visit, o.caps);
  describe_agreement(visit, o.is_agreed);
}

void describe(options::Command& visit, RenderOptions& o) {
  visit.about("render", "Simulate a scene and draw its frames");
  describe_scene(visit, o);
  visit("--coarsened", o.coarsened, options::coarsening(),
        "Says that the scene file was coarsened before, as those in the folder of a sweep with "
        "--coarsen N: advice then has the numbers to give to the sweep");
  visit("--predict", o.predicts,
        "With --coarsen N: run coarse copies to the last frame first, and say in captions and "
        "run.json what the run at full resolution will do there: breaks, holds or undecided, and "
        "its size with intervals; costs about a third of that run");
  visit("--frames", o.frames, options::frames(), "Frames to draw: A-B, or N for all up to N");
  visit("--from", o.from, options::time(),
        "Fork the run of SCENE (a scene, a picture or the folder of a run) at a time: --set "
        "changes parameters at that time, and the frames after it are drawn");
  describe_pictures(visit, o);
  describe_reference(visit, o);
  visit("--validate", o.validate,
        "Check the laws of the method in the first steps and in every 256th step; warn of a broken "
        "law, exit with 9 if the error is large");
  visit("--resume", o.resume,
        "Continue the run in the output folder from its last checkpoint, bit for bit; a finished "
        "run continues with more --frames");
  visit("--checkpoint-every", o.checkpoint_every,
        options::number<int>("FRAMES", 0, 1000000, "a whole number of frames, or 0 for none"),
        "Frames between checkpoints in DIR/checkpoint; 0: none")
      .with_default();
  describe_states(visit, o);
  visit("--replace", o.replaces,
        "Remove pictures and films of the folder that this command draws otherwise, and the whole "
        "run where the simulation is another one: without it neve says what would go and stops");
  describe_movies(visit, o);
  visit.sets("--no-caption", o.has_caption, false,
             "Omit the words over the pictures: for films; the layers counter and slate stay");
  visit("--shader-dir", o.shader_dir, options::existing_folder("the files of shaders/"),
        "Read shaders from this folder");
  visit("--dry-run", o.dry_run, "Print particles, memory, pixels and frames; start nothing");
  visit("--json", o.is_json, options::json_help);
  options::describe_progress(visit, o.progress);
  options::describe_verbosity(visit, o.verbosity, "Print more about each frame");
  visit.check([&o] {
    std::error_code error;
    if (o.predicts && !(o.coarsening.value_or(1) > 1) && !timeline::is_folder(o.scene))
      throw UsageError("--predict", "predicts the full run from a coarse copy, and this is none",
                       "add --coarsen 2, or see neve check --predict");
    if (o.from && !o.scene.empty() && !std::filesystem::exists(o.scene, error))
      throw UsageError("--from", "no file or folder " + o.scene,
                       "expected a scene, the folder of a run, or a picture made by neve");
  });
}

}  // namespace neve::app::run
