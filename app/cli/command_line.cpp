#include "app/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "app/cli/command_line_parts.h"
#include "app/cli/commands.h"
#include "app/cli/usage_hints.h"
#include "app/run/picture_record.h"
#include "app/scene/toml/error.h"
#include "app/setup/argument_text.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "render/gl/context.h"

namespace neve::app::cli {

void check_threads(int threads) {
  if (threads < 0 || threads > 1024)
    throw scene::toml::UsageError("--threads", "cannot use " + std::to_string(threads),
                                  "expected 0 (one per core) to 1024");
}

void check_backend(const std::string& name) {
  const auto& backends = render::gl::backend_names();
  if (std::find(backends.begin(), backends.end(), name) != backends.end()) return;
  throw scene::toml::UsageError("--backend", "unknown backend \"" + name + "\"",
                                "expected one of " + joined(backends, ", "));
}

CLI::Option* add_repeatable(CLI::App& command, const char* flag, std::vector<std::string>& values,
                            const char* type, const char* help) {
  return command.add_option(flag, values, help)
      ->type_name(type)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::string with_toml_suffix(const std::string& file) {
  std::error_code error;
  const std::string longer = file + ".toml";
  const bool is_short = !file.empty() && !std::filesystem::exists(file, error);
  return is_short && std::filesystem::is_regular_file(longer, error) ? longer : file;
}

run::RenderOptions finished(run::RenderOptions options, const RenderTexts& texts) {
  if (texts.frames) options.frames = setup::parse_frames(*texts.frames);
  if (texts.coarsening) options.coarsening = setup::parse_coarsening(*texts.coarsening);
  if (texts.size) options.size = setup::parse_size(*texts.size);
  if (texts.quality) options.quality = setup::quality_named(*texts.quality);
  if (!options.shader_dir.empty() && !std::filesystem::is_directory(options.shader_dir))
    throw scene::toml::UsageError("--shader-dir", "cannot use \"" + options.shader_dir + "\"",
                                  "expected a folder with the files of shaders/");
  if (texts.is_quiet) options.verbosity = Verbosity::quiet;
  if (texts.is_verbose) options.verbosity = Verbosity::verbose;
  options.scene = with_toml_suffix(options.scene);
  check_threads(options.threads);
  if (options.checkpoint_every < 0 || options.checkpoint_every > 1000000)
    throw scene::toml::UsageError("--checkpoint-every",
                                  "cannot use " + std::to_string(options.checkpoint_every),
                                  "expected frames, or 0 for none");
  if (!(options.reference_threshold >= 0))
    throw scene::toml::UsageError("--reference-threshold", "is negative", "expected 0 to 255");
  if (!(options.reference_local_threshold >= 0))
    throw scene::toml::UsageError("--reference-local-threshold", "is negative",
                                  "expected 0 to 255");
  check_backend(options.backend);
  return options;
}

void add_scene(CLI::App& command, const std::shared_ptr<run::RenderOptions>& options,
               const std::shared_ptr<RenderTexts>& texts) {
  command
      .add_option("SCENE", options->scene,
                  "Scene file (TOML), or a picture made by neve: that frame and view again; "
                  "without it the default scene, a falling snowball")
      ->type_name("");
  add_repeatable(command, "--set", options->overrides, "ADDRESS=VALUE",
                 "Change a parameter, as in material.snow.hardening=5 (repeatable; neve params "
                 "lists addresses)");
  command
      .add_option("--coarsen", texts->coarsening,
                  "Cells N times as large, for looking and tuning: 1/N^3 of the particles and "
                  "longer steps, about N^4 times cheaper")
      ->type_name("N");
  command.add_option("--threads", options->threads, "Threads; 0: one per core")->type_name("N");
}

namespace {

constexpr const char* footer =
    "Exit codes: 0 ok, 1 internal, 2 usage, 3 scene invalid or not there, 4 no GL backend,\n"
    "5 diverged, 6 input or output failed, 7 runs of a sweep failed, 8 refused by a limit,\n"
    "9 a check failed, 75 interrupted and can go on, 130 interrupted.";

bench::BenchOptions finished_bench(const CLI::App& command, bench::BenchOptions options) {
  check_threads(options.threads);
  check_backend(options.backend);
  if (command.count("--rounds") > 0 && (options.rounds < 1 || options.rounds > 1000))
    throw scene::toml::UsageError("--rounds", "cannot use " + std::to_string(options.rounds),
                                  "expected 1 to 1000");
  if (options.is_json && options.is_markdown)
    throw scene::toml::UsageError("--markdown", "cannot go with --json", "give one of them");
  const bool has_particles = command.get_option_no_throw("--particles") != nullptr;
  if (has_particles && command.count("--particles") > 0 &&
      !(options.particles >= 1 && options.particles <= 1e9))
    throw scene::toml::UsageError("--particles", "cannot use this number", "expected 1 to 1e9");
  return options;
}

void add_check(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "check",
      "What a scene will cost, which limits rule its steps, what looks wrong; runs nothing "
      "but a few steps and a coarse copy");
  const auto options = std::make_shared<run::RenderOptions>();
  const auto texts = std::make_shared<RenderTexts>();
  add_scene(*command, options, texts);
  command->add_flag("--json", options->is_json, "Print JSON");
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
  add_repeatable(*command, "--view", options->views, "NAME", "Draw only this view (repeatable)");
  command->add_option("--size", texts->size, "Picture size of all views")->type_name("WxH");
  command->add_option("--out", options->out, "Output folder instead of out/<scene name>")
      ->type_name("DIR");
  command->add_option("--backend", options->backend, "OpenGL backend; neve doctor lists them")
      ->type_name("NAME");
  command
      ->add_option("--quality", texts->quality,
                   "draft: half the width and height; preview: as the scene says (default); "
                   "final: four samples per pixel")
      ->type_name("NAME");
  command
      ->add_option("--reference", options->reference,
                   "Compare the last frame of the first view with this picture; exit 9 when it "
                   "differs, and leave DIR/difference.png")
      ->type_name("PNG");
  command
      ->add_option("--reference-threshold", options->reference_threshold,
                   "Mean difference allowed, 0 to 255")
      ->type_name("MEAN")
      ->capture_default_str();
  command
      ->add_option("--reference-local-threshold", options->reference_local_threshold,
                   "The same of every square of 8x8 pixels: finds small snow that is elsewhere")
      ->type_name("MEAN")
      ->capture_default_str();
  command->add_flag(
      "--validate", options->is_validated,
      "Watch the laws that every right step keeps, at the first steps and every 256th; "
      "warn of what breaks, exit 9 when it is wrong");
  command->add_flag("--resume", options->is_resumed,
                    "Go on where the run in the output folder stopped, with the same bits; a "
                    "finished one goes on with more --frames");
  command
      ->add_option("--checkpoint-every", options->checkpoint_every,
                   "Frames between checkpoints in DIR/checkpoint; 0: none")
      ->type_name("FRAMES")
      ->capture_default_str();
  command->add_flag("!--no-movie", options->has_movies, "Only pictures, no movie of them");
  command->add_option("--shader-dir", options->shader_dir, "Read shaders from a folder")
      ->type_name("DIR");
  command->add_flag("--dry-run", options->is_dry_run,
                    "Print particles, memory, pixels and frames; make nothing");
  command->add_flag("--json", options->is_json, "Print the result, or the error, as JSON");
  CLI::Option* quiet = command->add_flag("--quiet,-q", texts->is_quiet, "Only errors and warnings");
  command->add_flag("--verbose,-v", texts->is_verbose, "More about each frame")->excludes(quiet);
  command->final_callback([=, &action] {
    if (command->count("--out") > 0 && options->out.empty())
      throw scene::toml::UsageError("--out", "names no folder", "expected the path of one");
    action = [options, texts] { return run_render(finished(*options, *texts)); };
  });
}

void add_compare(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "compare", "Compare two pictures, or the states of two runs frame by frame");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "A PNG, or the folder of a run")->required()->type_name("");
  command->add_option("B", options->b, "The other one")->required()->type_name("");
  command
      ->add_option("--threshold", options->threshold,
                   "Mean difference of pictures that is allowed, 0 to 255")
      ->type_name("MEAN")
      ->capture_default_str();
  command
      ->add_option("--local-threshold", options->local_threshold,
                   "The same of every square of 8x8 pixels: finds the part that is another one")
      ->type_name("MEAN")
      ->capture_default_str();
  command->add_flag("--json", options->is_json, "Print the result as JSON");
  command->final_callback([=, &action] { action = [options] { return run_compare(*options); }; });
}

/// What all parts of bench take.
CLI::App* add_bench_part(CLI::App& bench, Action& action, const char* name, const char* help,
                         const std::shared_ptr<bench::BenchOptions>& options,
                         int (*run)(const bench::BenchOptions&)) {
  CLI::App* command = bench.add_subcommand(name, help);
  command
      ->add_option("--rounds", options->rounds,
                   "How often each thing is measured; the table shows median, min and max")
      ->type_name("N");
  command->add_option("--threads", options->threads, "Threads; 0: one per core")->type_name("N");
  command->add_flag("--quick", options->is_quick,
                    "Few particles, few rounds: whether it works, not how fast it is");
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
             sweep = std::make_shared<bench::BenchOptions>(),
             view = std::make_shared<bench::BenchOptions>();
  CLI::App* sim_command = add_bench_part(
      *bench, action, "sim",
      "Particle-steps per second of each method against naive code in the same minutes, time per "
      "phase, memory, spray, scaling from 1 to 2 threads",
      sim, run_bench_sim);
  sim_command
      ->add_option("--particles", sim->particles,
                   "Size of the common case instead of 97336; with --curve where it ends")
      ->type_name("N");
  sim_command->add_flag("--curve", sim->is_curve,
                        "Instead: throughput from 1000 to 5 million particles, as memory allows");
  CLI::App* frame_command = add_bench_part(
      *bench, action, "frame",
      "Seconds per frame of 300000 particles, of 4000 with drawing, to the first picture; what "
      "--coarsen 2 saves",
      frame, run_bench_frame);
  CLI::App* render_command = add_bench_part(
      *bench, action, "render",
      "Milliseconds per picture at 1280x720 of 4000 to a million particles and of all layers, per "
      "phase, spheres by OpenGL against spheres by the CPU, PNG encoding",
      render, run_bench_render);
  CLI::App* sweep_command = add_bench_part(
      *bench, action, "sweep",
      "How busy many small runs keep the cores, and what each costs besides its work", sweep,
      run_bench_sweep);
  CLI::App* view_command = add_bench_part(
      *bench, action, "view",
      "Pictures per second of the interactive view while it simulates 97000 particles, and "
      "milliseconds from input to picture",
      view, run_bench_view);
  for (const auto& [command, options] : {std::pair{frame_command, frame},
                                         {render_command, render},
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
  CLI::App* command =
      app.add_subcommand("params", "Every parameter: address, unit, range, default");
  const auto is_json = std::make_shared<bool>(false), is_sweep = std::make_shared<bool>(false);
  const auto filter = std::make_shared<std::string>();
  command->add_option("FILTER", *filter, "Only those with this in their address, as in camera")
      ->type_name("");
  command->add_flag("--sweep", *is_sweep, "Those of sweep files instead of scenes");
  command->add_flag("--json", *is_json, "Print JSON");
  command->final_callback(
      [=, &action] { action = [=] { return run_params(*filter, *is_sweep, *is_json); }; });
}

void add_info(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("info", "Which scene and parameters made a picture; the state of a run");
  const auto path = std::make_shared<std::string>();
  const auto is_json = std::make_shared<bool>(false);
  command->add_option("FILE", *path, "A PNG, run.json, or the folder of a run")
      ->required()
      ->type_name("");
  command->add_flag("--json", *is_json, "Print JSON");
  command->final_callback([=, &action] { action = [=] { return run_info(*path, *is_json); }; });
}

int print_version() {
  std::cout << "neve " << version << "\n";
  return exit_ok;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app(
      "neve simulates snow and draws it: to pictures and movies without a window, or live in one.",
      "neve");
  Action action;
  add_render(app, action);
  add_check(app, action);
  add_dump(app, action);
  add_report(app, action, "doctor",
             "Which OpenGL backends work here, and why others do not; self-tests of the physics",
             run_doctor);
  add_info(app, action);
  add_params(app, action);
  add_compare(app, action);
  add_sweep(app, action);
  add_view(app, action);
  add_bench(app, action);
  CLI::App* version_command = app.add_subcommand("version", "Print the version");
  version_command->final_callback([&] { action = print_version; });
  app.add_subcommand("help", "Print this help, or that of a subcommand");
  app.set_version_flag("--version", std::string("neve ") + version);
  app.footer(footer);
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
  return action();
}

bool wants_json(int argc, char** argv) {
  return std::any_of(argv, argv + argc,
                     [](const char* word) { return std::string_view(word) == "--json"; });
}

}  // namespace neve::app::cli
