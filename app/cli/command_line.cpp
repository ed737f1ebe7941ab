#include "app/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "app/cli/command_line_parts.h"
#include "app/cli/commands.h"
#include "app/cli/manual.h"
#include "app/cli/surroundings.h"
#include "app/cli/usage_hints.h"
#include "app/run/passes.h"
#include "app/scene/scene_file.h"
#include "app/setup/argument_text.h"
#include "app/setup/caps.h"
#include "app/support/errors.h"
#include "app/support/json.h"
#include "app/support/lower_text.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "render/gl/context.h"
#include "sim/kernels/simd.h"

namespace neve::app::cli {

void check_threads(int threads) {
  if (threads < 0 || threads > 1024)
    throw UsageError("--threads", "cannot use " + std::to_string(threads),
                     "expected 0 (one per core) to 1024");
}

void check_backend(const std::string& name) {
  const auto& backends = render::gl::backend_names();
  if (std::find(backends.begin(), backends.end(), name) != backends.end()) return;
  const std::string word = lower_text(name);
  const bool is_gpu = word == "gpu" || word == "cuda" || word == "opengl" || word == "vulkan" ||
                      word == "hip" || word == "metal" || word == "nvidia";
  const bool is_cpu = word == "cpu" || word == "software" || word == "llvmpipe" || word == "mesa";
  throw UsageError(
      "--backend", "unknown backend \"" + name + "\"",
      is_gpu ? "egl draws with OpenGL on a GPU where there is one; expected one of " +
                   joined(backends, ", ")
      : is_cpu ? "osmesa draws without a GPU, and egl where Mesa is its driver; expected one of " +
                     joined(backends, ", ")
               : names_advice(name, backends));
}

CLI::Option* add_repeatable(CLI::App& command, const char* flag, std::vector<std::string>& values,
                            const char* type, const char* help) {
  return command.add_option(flag, values, help)
      ->type_name(type)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_progress(CLI::App& command, std::optional<std::string>& progress,
                  ProgressOptions& options) {
  command
      .add_option(
          "--progress", progress,
          "text: lines for people (default); json: one JSON object a line on standard error")
      ->type_name("NAME");
  command
      .add_option_function<std::string>(
          "--log",
          [&options](const std::string& file) {
            if (!is_log_name(file))
              throw UsageError("--log", "\"" + file + "\" is no log",
                               "expected a file for the messages, as in --log run.log");
            options.log = file;
          },
          "Append all messages to a file, with times, details and every frame")
      ->type_name("FILE");
}

bool parse_progress(const std::string& text) {
  if (text != "text" && text != "json")
    throw UsageError("--progress", "cannot use \"" + text + "\"",
                     names_advice(text, {"text", "json"}));
  return text == "json";
}

void require_folder_name(const std::string& out, const std::string& example) {
  if (out == "~" || out.starts_with("~/"))
    throw UsageError("--out", "\"" + out + "\" would be a folder with the name ~",
                     "the shell puts your home folder there in --out " + out +
                         ", with a blank and without quotes");
  const std::string suffix = lower_text(std::filesystem::path(out).extension().string());
  std::error_code error;
  for (const char* of_file : {".png", ".exr", ".jpg", ".mp4", ".mov", ".webm", ".gif", ".ply",
                              ".vtp", ".vti", ".vdb", ".bgeo", ".usda", ".npz", ".csv", ".obj"})
    if (suffix == of_file && !std::filesystem::is_directory(out, error))
      throw UsageError(
          "--out", "\"" + out + "\" looks like a file",
          "expected a folder: files are DIR/" + example + "; leave " + suffix + " away");
}

run::RenderOptions finished(run::RenderOptions options, const RenderTexts& texts) {
  if (texts.frames) options.frames = setup::parse_frames(*texts.frames);
  if (texts.from) options.from = setup::parse_time(*texts.from, "--from");
  if (texts.coarsening) options.coarsening = setup::parse_coarsening(*texts.coarsening);
  if (texts.size) options.size = setup::parse_size(*texts.size);
  if (options.shutter && !(*options.shutter >= 0 && *options.shutter <= 360))
    throw UsageError("--shutter", "cannot use " + rough_text(*options.shutter) + " degrees",
                     "expected 0 (no motion blur) to 360 (the whole frame)");
  if (texts.passes) options.passes = run::parse_passes(*texts.passes);
  if (texts.quality) options.quality = setup::quality_named(*texts.quality);
  if (!options.shader_dir.empty() && !std::filesystem::is_directory(options.shader_dir))
    throw UsageError("--shader-dir", "cannot use \"" + options.shader_dir + "\"",
                     "expected a folder with the files of shaders/");
  options.movie = finished_movie(texts.movie);
  if (!options.has_movies && options.movie.has_format && options.movie.is_made)
    throw UsageError("--movie", "cannot be combined with --no-movie", "give one of the two");
  if (texts.is_quiet) options.verbosity = Verbosity::quiet;
  if (texts.is_verbose) options.verbosity = Verbosity::verbose;
  if (texts.progress) options.progress.is_json = parse_progress(*texts.progress);
  options.scene = scene::path_of_scene(options.scene);
  std::error_code error;
  if (options.from && !options.scene.empty() && !std::filesystem::exists(options.scene, error))
    throw UsageError("--from", options.scene + " is not there",
                     "expected a scene, the folder of a run, or a picture made by "
                     "neve");
  check_threads(options.threads);
  if (options.checkpoint_every < 0 || options.checkpoint_every > 1000000)
    throw UsageError("--checkpoint-every", "cannot use " + std::to_string(options.checkpoint_every),
                     "expected frames, or 0 for none");
  if (!(options.reference_threshold >= 0))
    throw UsageError("--reference-threshold", "is negative", "expected 0 to 255");
  if (!(options.reference_local_threshold >= 0))
    throw UsageError("--reference-local-threshold", "is negative", "expected 0 to 255");
  check_backend(options.backend);
  return options;
}

void add_scene(CLI::App& command, const std::shared_ptr<run::RenderOptions>& options,
               const std::shared_ptr<RenderTexts>& texts) {
  command
      .add_option(
          "SCENE", options->scene,
          "Scene file (TOML), - for standard input, or a picture made by neve, to make that "
          "frame and view again; default: a falling snowball")
      ->type_name("");
  add_repeatable(command, "--set", options->overrides, "ADDRESS=VALUE",
                 "Change a parameter, as in material.snow.hardening=5 (repeatable; neve params "
                 "lists addresses)");
  command
      .add_option("--coarsen", texts->coarsening,
                  "Make cells N times as large, for previews: 1/N^3 of the particles and longer "
                  "steps, about N^4 times cheaper")
      ->type_name("N");
  command.add_flag("--fast", options->is_fast,
                   "Take longer steps for a quick look, by settings that are recorded as --set is; "
                   "neve check says what they gain");
  command.add_option("--threads", options->threads, "Number of threads; 0: one per core")
      ->type_name("N");
  add_caps(command);
}

void add_caps(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--max-memory", setup::set_memory_cap,
          "Refuse runs that need more memory, whatever the scene allows; NEVE_MAX_MEMORY does so "
          "always")
      ->type_name("SIZE");
  command
      .add_option_function<std::string>(
          "--max-particles", setup::set_particle_cap,
          "Refuse runs of more particles, whatever the scene allows; NEVE_MAX_PARTICLES does so "
          "always")
      ->type_name("N");
}

namespace {

constexpr const char* footer =
    "Exit codes: 0 ok, 1 internal, 2 usage, 3 scene invalid or not there, 4 no GL backend,\n5 "
    "diverged, 6 input or output failed, 7 runs of a sweep failed, 8 refused by a limit,\n9 a "
    "check failed, 75 interrupted with a checkpoint, 130 interrupted.";

bench::BenchOptions finished_bench(const CLI::App& command, bench::BenchOptions options) {
  check_threads(options.threads);
  check_backend(options.backend);
  if (command.count("--rounds") > 0 && (options.rounds < 1 || options.rounds > 1000))
    throw UsageError("--rounds", "cannot use " + std::to_string(options.rounds),
                     "expected 1 to 1000");
  if (options.frames < 0 || options.frames > 1000000)
    throw UsageError("--frames", "cannot use " + std::to_string(options.frames),
                     "expected a number of frames, or 0 for all");
  if (options.is_json && options.is_markdown)
    throw UsageError("--markdown", "cannot be combined with --json", "give one of the two");
  const bool has_particles = command.get_option_no_throw("--particles") != nullptr;
  if (has_particles && command.count("--particles") > 0 &&
      !(options.particles >= 1 && options.particles <= 1e9))
    throw UsageError("--particles", "cannot use " + rough_text(options.particles),
                     "expected 1 to 1e9");
  return options;
}

void add_check(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("check",
                         "Forecast the cost of a scene and the limits of its steps, and warn of "
                         "likely mistakes; takes a few steps and runs a coarse copy");
  const auto options = std::make_shared<run::RenderOptions>();
  const auto texts = std::make_shared<RenderTexts>();
  add_scene(*command, options, texts);
  command->add_flag("--json", options->is_json, "Print JSON");
  command->add_flag("--quiet,-q", texts->is_quiet, "Print only errors and warnings");
  command->final_callback([=, &action] {
    action = [options, texts] { return run_check(finished(*options, *texts)); };
  });
}

void add_render(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("render", "Simulate a scene and draw its frames");
  const auto options = std::make_shared<run::RenderOptions>();
  const auto texts = std::make_shared<RenderTexts>();
  add_scene(*command, options, texts);
  command->add_option("--frames", texts->frames, "Frames to draw: A-B, or N for 0-N")
      ->type_name("A-B");
  command
      ->add_option("--from", texts->from,
                   "Fork the run of SCENE, a picture or the folder of a run, at a time: --set then "
                   "changes parameters there, and frames after it are drawn")
      ->type_name("TIME");
  add_repeatable(*command, "--view", options->views, "NAME", "Draw only this view (repeatable)");
  command->add_option("--size", texts->size, "Picture size of all views")->type_name("WxH");
  command->add_option("--out", options->out, "Output folder instead of out/<scene name>")
      ->type_name("DIR");
  command->add_option("--backend", options->backend, "OpenGL backend; neve doctor lists them")
      ->type_name("NAME");
  command
      ->add_option("--quality", texts->quality,
                   "draft: half the width and height; preview: as in the scene (default); final: "
                   "four samples per pixel and motion blur")
      ->type_name("NAME");
  command
      ->add_option(
          "--plate", options->plate,
          "Picture behind the snow: a PNG, or one for each frame as in street/%04d.png; the "
          "ground only takes shadows")
      ->type_name("PNG");
  command
      ->add_option("--shutter", options->shutter,
                   "Motion blur: degrees of 360 that the shutter is open in each frame; 0: none. "
                   "Default: 180 with --quality final, otherwise 0")
      ->type_name("DEGREES");
  command
      ->add_option(
          "--passes", texts->passes,
          "Write DIR/<view>/NNNN.exr too, for compositing: linear light, and these passes: "
          "all, or a list of depth, position, normal, albedo, direct, indirect, emission, "
          "shadow, motion, id, body, collider and attributes, as in J_P,v")
      ->type_name("LIST");
  command
      ->add_option("--reference", options->reference,
                   "Compare the last frame of the first view with this picture; if it differs, "
                   "write DIR/difference.png and exit with 9")
      ->type_name("PNG");
  command
      ->add_option("--reference-threshold", options->reference_threshold,
                   "Largest mean difference allowed, 0 to 255")
      ->type_name("MEAN")
      ->capture_default_str();
  command
      ->add_option("--reference-local-threshold", options->reference_local_threshold,
                   "Largest mean difference allowed in any 8x8 block; catches small local changes")
      ->type_name("MEAN")
      ->capture_default_str();
  command->add_flag("--validate", options->validate,
                    "Check the laws of the method in the first steps and every 256th; warn if one "
                    "is broken, exit with 9 if the error is large");
  command->add_flag("--resume", options->resume,
                    "Continue the run in the output folder from its last checkpoint, bit for bit; "
                    "a finished run continues with more --frames");
  command
      ->add_option("--checkpoint-every", options->checkpoint_every,
                   "Frames between checkpoints in DIR/checkpoint; 0: none")
      ->type_name("FRAMES")
      ->capture_default_str();
  command->add_flag("--keep-states", options->keeps_states,
                    "Keep the state of each drawn frame in DIR/states: the same run in the same "
                    "folder is then drawn with other views, sizes, colours or cameras without "
                    "simulating; about 160 bytes a particle and frame");
  // Its name alone; "!--no-movie" would be listed as --no-movie{false}.
  command->add_flag_callback(
      "--no-movie", [options] { options->has_movies = false; },
      "Write pictures only, no movie; the same as --movie none");
  add_movie_flags(*command, texts->movie);
  command->add_flag_callback(
      "--no-caption", [options] { options->has_caption = false; },
      "Leave the words over the pictures out: for films; the layers counter and slate stay");
  command->add_option("--shader-dir", options->shader_dir, "Read shaders from this folder")
      ->type_name("DIR");
  command->add_flag("--dry-run", options->dry_run,
                    "Print particles, memory, pixels and frames, without a run");
  command->add_flag("--json", options->is_json, "Print the result, or the error, as JSON");
  add_progress(*command, texts->progress, options->progress);
  CLI::Option* quiet =
      command->add_flag("--quiet,-q", texts->is_quiet, "Print only errors and warnings");
  command->add_flag("--verbose,-v", texts->is_verbose, "Print more about each frame")
      ->excludes(quiet);
  command->final_callback([=, &action] {
    if (command->count("--out") > 0 && options->out.empty())
      throw UsageError("--out", "names no folder", "expected the path of a folder");
    action = [options, texts] {
      require_folder_name(options->out, "particles/0000.png");
      return run_render(finished(*options, *texts));
    };
  });
}

/// Adds a subcommand of bench with the common options.
CLI::App* add_bench_part(CLI::App& bench, Action& action, const char* name, const char* help,
                         const std::shared_ptr<bench::BenchOptions>& options,
                         int (*run)(const bench::BenchOptions&)) {
  CLI::App* command = bench.add_subcommand(name, help);
  command
      ->add_option("--rounds", options->rounds,
                   "Repetitions of each measurement; the table shows median, min and max")
      ->type_name("N");
  command->add_option("--threads", options->threads, "Number of threads; 0: one per core")
      ->type_name("N");
  command->add_flag("--quick", options->is_quick,
                    "Use few particles and rounds, to test the benchmark itself");
  command->add_flag("--markdown", options->is_markdown,
                    "Print Markdown tables, as in docs/performance.md");
  command->add_flag("--json", options->is_json, "Print a JSON list, one object per row");
  command->final_callback(
      [=, &action] { action = [=] { return run(finished_bench(*command, *options)); }; });
  return command;
}

void add_bench(CLI::App& app, Action& action) {
  CLI::App* bench =
      app.add_subcommand("bench", "Measure how fast this machine simulates and draws");
  bench->require_subcommand(1);
  const auto sim = std::make_shared<bench::BenchOptions>(),
             frame = std::make_shared<bench::BenchOptions>(),
             render = std::make_shared<bench::BenchOptions>(),
             surface = std::make_shared<bench::BenchOptions>(),
             scenes = std::make_shared<bench::BenchOptions>(),
             sweep = std::make_shared<bench::BenchOptions>(),
             view = std::make_shared<bench::BenchOptions>();
  CLI::App* sim_command =
      add_bench_part(*bench, action, "sim",
                     "Measure particle-steps per second of each method, interleaved with naive "
                     "code; time per phase, memory, spray, scaling from 1 to 2 threads",
                     sim, run_bench_sim);
  sim_command
      ->add_option("--particles", sim->particles,
                   "Particles of the common case instead of 97336; with --curve, of its last point")
      ->type_name("N");
  sim_command->add_flag(
      "--curve", sim->is_curve,
      "Measure throughput from 1000 to 5 million particles instead, as memory allows");
  CLI::App* frame_command =
      add_bench_part(*bench, action, "frame",
                     "Measure seconds per frame of 300000 particles, of 4000 with drawing, to the "
                     "first picture; the gain of --coarsen 2",
                     frame, run_bench_frame);
  CLI::App* render_command = add_bench_part(
      *bench, action, "render",
      "Measure milliseconds per picture at 1280x720: 4000 to a million particles, all layers, each "
      "phase, spheres by OpenGL against spheres by the CPU, PNG encoding",
      render, run_bench_render);
  add_bench_part(
      *bench, action, "surface",
      "Measure milliseconds per mesh of the snow's surface and for the attributes of its "
      "vertices, from 4000 to a million particles",
      surface, run_bench_surface);
  CLI::App* scenes_command =
      add_bench_part(*bench, action, "scenes",
                     "Measure seconds per second of film of the shipped scenes, also with "
                     "--coarsen 2 and --fast; steps, throughput and the share of drawing",
                     scenes, run_bench_scenes);
  scenes_command
      ->add_option("--only", scenes->only, "Measure only the scene of this name, as in press")
      ->type_name("NAME");
  scenes_command->add_option("--frames", scenes->frames, "Measure the first N frames of each film")
      ->type_name("N");
  CLI::App* sweep_command = add_bench_part(
      *bench, action, "sweep",
      "Measure the share of the cores that many small runs use, and the overhead of each run",
      sweep, run_bench_sweep);
  CLI::App* view_command =
      add_bench_part(*bench, action, "view",
                     "Measure pictures per second of neve view during a simulation of 97000 "
                     "particles, and milliseconds from input to picture",
                     view, run_bench_view);
  for (const auto& [command, options] : {std::pair{frame_command, frame},
                                         {render_command, render},
                                         {scenes_command, scenes},
                                         {sweep_command, sweep},
                                         {view_command, view}})
    command->add_option("--backend", options->backend, "OpenGL backend; neve doctor lists them")
        ->type_name("NAME");
}

/// A subcommand that takes nothing but --json.
void add_report(CLI::App& app, Action& action, const char* name, const char* help,
                int (*run)(bool)) {
  CLI::App* command = app.add_subcommand(name, help);
  const auto is_json = std::make_shared<bool>(false);
  command->add_flag("--json", *is_json, "Print JSON");
  command->final_callback([=, &action] { action = [=] { return run(*is_json); }; });
}

void add_params(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "params", "List parameters: address, unit, range, default; or look for them");
  const auto options = std::make_shared<ParamsOptions>();
  command
      ->add_option("WORD", options->filter,
                   "List only parameters with this in their address or description, or that it "
                   "means in everyday words, as in camera, \"time step\", sticky")
      ->type_name("");
  command->add_flag("--wishes", options->is_wishes,
                    "Print the table from wishes (stickier, heavier, ...) to parameters");
  command->add_flag("--markdown", options->is_markdown,
                    "With --wishes, print it as in docs/wishes.md");
  command->add_flag("--sweep", options->is_sweep,
                    "List the parameters of sweep files instead of scenes");
  command->add_flag("--json", options->is_json, "Print JSON");
  command->final_callback([=, &action] { action = [options] { return run_params(*options); }; });
}

void add_info(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "info", "Print the scene and parameters of a picture, or the state of a run");
  const auto path = std::make_shared<std::string>();
  const auto is_json = std::make_shared<bool>(false);
  command->add_option("FILE", *path, "A PNG or EXR, run.json, or the folder of a run")
      ->required()
      ->type_name("");
  command->add_flag("--json", *is_json, "Print JSON");
  command->final_callback([=, &action] { action = [=] { return run_info(*path, *is_json); }; });
}

void add_verify(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "verify", "Check that every file of a run or a sweep is there, as it was written");
  const auto folder = std::make_shared<std::string>();
  const auto is_json = std::make_shared<bool>(false), is_quiet = std::make_shared<bool>(false);
  command->add_option("DIR", *folder, "Output folder of a run or a sweep")
      ->required()
      ->type_name("");
  command->add_flag("--json", *is_json, "Print JSON");
  command->add_flag("--quiet,-q", *is_quiet, "Print only what is wrong");
  command->final_callback(
      [=, &action] { action = [=] { return run_verify(*folder, *is_quiet, *is_json); }; });
}

/// Written for `cmake --install`, and for anyone who copies the program by hand.
void add_manual(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "manual", "Write man pages, and completions for bash, zsh and fish, into a folder");
  const auto folder = std::make_shared<std::string>();
  command->add_option("DIR", *folder, "The folder; it gets man1, bash, zsh and fish")
      ->required()
      ->type_name("");
  command->final_callback([&app, &action, folder] {
    action = [&app, folder] {
      write_manual(app, *folder);
      return static_cast<int>(exit_ok);
    };
  });
}

std::string simd_in_use() {
  return sim::kernels::name(sim::kernels::chosen_simd_level());
}

std::string version_text() {
  return std::string("neve ") + version + " (" + build_text(simd_in_use()) + ")";
}

int print_version(bool is_json) {
  if (is_json)
    std::cout << to_text({{"name", "neve"},
                          {"version", version},
                          {"build", build_json()},
                          {"simd", simd_in_use()}})
              << "\n";
  else
    std::cout << version_text() << "\n";
  return exit_ok;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app("neve simulates snow and draws it, as pictures and movies or live in a window.",
               "neve");
  // --fast=no would be --fast to some and the opposite to others.
  app.option_defaults()->disable_flag_override();
  Action action;
  add_new(app, action);
  add_render(app, action);
  add_check(app, action);
  add_dump(app, action);
  add_export(app, action);
  add_strip(app, action);
  add_report(app, action, "doctor",
             "Test the OpenGL backends of this machine, say why others do not work, and run the "
             "self-tests of the physics",
             run_doctor);
  add_info(app, action);
  add_verify(app, action);
  add_params(app, action);
  add_schema(app, action);
  add_compare(app, action);
  add_sweep(app, action);
  add_pick(app, action);
  add_view(app, action);
  add_bench(app, action);
  add_manual(app, action);
  add_report(app, action, "version",
             "Print the version, and the build: commit, type, compiler, instruction set",
             print_version);
  app.add_subcommand("help", "Print this help, or the help of a subcommand");
  app.set_version_flag("--version", version_text);
  app.footer(footer);
  // After one subcommand, the name of another is an argument: neve params view.
  app.require_subcommand(0, 1);
  const auto is_any = [](CLI::App*) { return true; };
  for (CLI::App* command : app.get_subcommands(is_any)) {
    command->allow_extras();
    for (CLI::App* part : command->get_subcommands(is_any)) part->allow_extras();
  }

  if (argc < 2) {
    std::cerr << app.help();
    return exit_usage;
  }
  if (std::string_view(argv[1]) == "help") {
    std::cout << help_of(app, {argv + 2, argv + argc});
    return exit_ok;
  }
  check_subcommand(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request, std::cout, std::cerr);  // --help, --version
  } catch (const CLI::ParseError& error) {
    fail_parse(app, error);
  }
  check_leftovers(app);
  warn_of_surroundings(app, error_output(argc, argv));
  return action();
}

ErrorOutput error_output(int argc, char** argv) {
  ErrorOutput output;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k], next = k + 1 < argc ? argv[k + 1] : "";
    output.is_json = output.is_json || word == "--json";
    output.is_progress_json = output.is_progress_json || word == "--progress=json" ||
                              (word == "--progress" && next == "json");
    if (word == "--log") output.log = next;
    if (word.starts_with("--log=")) output.log = word.substr(6);
  }
  return output;
}

}  // namespace neve::app::cli
