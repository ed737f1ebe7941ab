#include <fmt/core.h>

#include <algorithm>
#include <iostream>

#include "app/cli/command_line.h"
#include "app/cli/commands.h"
#include "app/health/check.h"
#include "app/health/findings.h"
#include "app/health/mesh_findings.h"
#include "app/output/atomic_file.h"
#include "app/output/folder_lock.h"
#include "app/output/movie.h"
#include "app/output/read_picture.h"
#include "app/output/sequence.h"
#include "app/picture/mosaic.h"
#include "app/predict/predict.h"
#include "app/record/picture_record.h"
#include "app/run/drawing.h"
#include "app/run/fork.h"
#include "app/run/passes.h"
#include "app/run/render_job.h"
#include "app/run/render_run.h"
#include "app/run/step_warnings.h"
#include "app/scene/burn_in.h"
#include "app/scene/check.h"
#include "app/scene/coarsen.h"
#include "app/scene/override.h"
#include "app/scene/toml/value.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "app/timeline/origin.h"
#include "render/gl/context.h"
#include "render/overlay/font_cover.h"
#include "sim/shapes/held_files.h"

namespace neve::app::cli {

namespace {

/// A strip shows many frames: one of them has to be named.
void refuse_strip(const run::RenderOptions& options, const run::RenderJob& job) {
  if (options.from) return;
  if (job.picture && job.picture->strip && !options.frames)
    throw UsageError(
        options.scene,
        "is a strip of " + std::to_string(job.picture->strip->times.size()) + " moments",
        "neve strip " + shell_path(options.scene) +
            " makes it again; --frames renders frames of its scene");
}

/// A run that is drawn again has written its exports; those of new frames it has not.
bool grows(const run::RenderJob& job) {
  return job.is_drawn_in_place() && !job.run_frames.empty() &&
         (job.frames.first < job.run_frames.front().frame ||
          job.frames.last > job.run_frames.back().frame);
}

void print_plan(const run::RenderJob& job, const setup::Plan& plan, bool is_json) {
  if (is_json) {
    Json json = setup::to_json(plan);
    json["cell_size"] = job.scene.solver.cell_size;
    json["coarsen"] = job.coarsening;
    json["out"] = job.folder.string();
    json["views"] = Json::array();
    for (const scene::View& view : job.scene.views)
      if (job.draws_alone(view)) json["views"].push_back(view.name);
    json["passes"] = job.passes;
    json["mosaics"] = Json::array();
    for (const scene::Mosaic& mosaic : job.scene.mosaics) json["mosaics"].push_back(mosaic.name);
    set_answer(std::move(json));
    return;
  }
  std::cout << "particles  about " << fixed_text(plan.particles, 0) << "\n"
            << "cells      " << scene::toml::number_text(job.scene.solver.cell_size) << " m"
            << scene::coarsened_words(job.scene, job.coarsening) << "\n"
            << "memory     about " << bytes_text(plan.memory) << " of "
            << bytes_text(plan.memory_limit) << " allowed\n"
            << "frames     " << plan.first_number + plan.frames.first << " to "
            << plan.first_number + plan.frames.last << "\n";
  for (const scene::View& view : job.scene.views) {
    if (!job.draws_alone(view)) continue;
    const scene::PictureSize size = setup::size_of(job.scene, view);
    std::cout << "view       " << view.name << ", " << size.width << "x" << size.height << "\n";
  }
  if (job.options.predicts) std::cout << "prediction " << predict::cost_text() << "\n";
  if (!job.passes.empty()) std::cout << "passes     " << joined(job.passes, ", ") << "\n";
  for (const scene::Mosaic& mosaic : job.scene.mosaics) {
    const scene::PictureSize size = setup::size_of(job.scene, mosaic, job.caption_lines());
    std::cout << "mosaic     " << mosaic.name << ", " << size.width << "x" << size.height << "\n";
  }
  std::cout << "out        " << job.folder.string() << "\n";
}

void check_picture_sizes(const run::RenderJob& job, int largest) {
  for (const scene::View& view : job.scene.views) {
    const scene::PictureSize size = setup::size_of(job.scene, view);
    if (std::max(size.width, size.height) * setup::supersampling(job.quality) > largest)
      throw LimitError(
          fmt::format("refused: the view {} is larger than the {} samples a side that this "
                      "backend draws",
                      view.name, largest),
          fmt::format("view.{}.size", view.name), "draw smaller pictures with --size");
  }
  for (const scene::Mosaic& mosaic : job.scene.mosaics) {
    const scene::PictureSize size = setup::size_of(job.scene, mosaic, job.caption_lines());
    if (std::max(size.width, size.height) > largest)
      throw LimitError(
          fmt::format("refused: the mosaic {} is larger than the {} pixels a side that this "
                      "backend draws",
                      mosaic.name, largest),
          fmt::format("mosaic.{}.width", mosaic.name), "make it narrower");
  }
}

/// @return the exit code; leaves DIR/difference.png when the pictures differ
int compare_with_reference(const run::RenderOptions& options, const run::RenderJob& job,
                           const render::Image& picture, const render::Image& reference) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw Error(exit_check_failed,
                fmt::format("the picture is {}x{} and {} is {}x{}", picture.width, picture.height,
                            options.reference, reference.width, reference.height),
                options.reference, "give the size of the reference with --size");
  if (picture.channels != reference.channels)
    throw Error(exit_check_failed,
                fmt::format("the picture has {} channels and {} has {}", picture.channels,
                            options.reference, reference.channels),
                options.reference, "set output.background to that of the reference");
  const render::Difference difference = render::compare(picture, reference);
  const std::string found = fmt::format(
      "mean difference {}, of 8x8 pixels {}, largest {} of 255", fixed_text(difference.mean, 3),
      fixed_text(difference.local, 2), fixed_text(difference.max, 0));
  const bool is_mean_right = difference.mean <= options.reference_threshold;
  if (is_mean_right && difference.local <= options.reference_local_threshold) {
    if (options.verbosity != Verbosity::quiet)
      std::cerr << "matches the reference: " << found << "\n";
    return exit_ok;
  }
  const std::filesystem::path file = job.folder / "difference.png";
  record::SheetRecord record;
  record.what = "the difference of a picture and its reference";
  record.add("reference", options.reference);
  record.add("frame", std::to_string(scene::number_of(job.scene, job.frames.last)));
  for (const std::string& change : job.overrides) record.add("override", change);
  record.scenes = {{"scene", scene::write_scene(job.scene)}};
  record.again = "neve render with --reference draws it where the pictures differ";
  output::write_file(file, render::encode_png(render::difference_image(picture, reference),
                                              record::to_png_text(record)));
  throw Error(exit_check_failed,
              fmt::format("the picture differs from {}: {}; see {}", options.reference, found,
                          file.string()),
              options.reference,
              fmt::format("raise {} if this is expected",
                          is_mean_right ? "--reference-local-threshold" : "--reference-threshold"));
}

void print_result(const run::RenderJob& job, const run::RenderRun& run,
                  const run::RenderResult& result, int code) {
  Json json;
  json["status"] = record::name(result.status);
  json["exit_code"] = code;
  json["out"] = job.folder.string();
  json["run_json"] = output::run_json_path(job.folder).string();
  json["warnings"] = run.record().warnings;
  json["frames"] = run.record().frames.size();
  json["movies"] = Json::array();
  for (const auto& movie : result.movies) json["movies"].push_back(movie.string());
  if (!run.record().frames.empty())
    json["state_hash"] = record::hash_text(run.record().frames.back().state_hash);
  set_answer(std::move(json));
}

/// Words that pictures cannot show.
void check_title(const std::string& title, std::vector<health::Finding>& findings) {
  const std::string missing = render::overlay::characters_without_glyph(title);
  if (!missing.empty())
    findings.push_back({health::Severity::warning, "title",
                        fmt::format("the font of the caption lacks {}: pictures show a sign for "
                                    "what is missing instead",
                                    missing),
                        "use letters of Latin, Greek, Cyrillic, Arabic or another script of DejaVu "
                        "Sans, or --no-caption"});
}

/// Passes that are left out, and views whose snow is in no pass.
void check_passes(const run::RenderJob& job, std::vector<health::Finding>& findings) {
  const scene::Scene& scene = job.scene;
  if (job.passes.size() < job.options.passes.size())
    findings.push_back({health::Severity::note, "--passes",
                        std::string("no pass body: ") + scene::mixed_emitters, "use one emitter"});
  for (const scene::View& view : scene.views)
    if (!scene::shows_particles(view) && scene::has_layer(view, scene::Layer::smoke))
      findings.push_back({health::Severity::warning, "--passes",
                          fmt::format("the snow of the view {} is smoke, which no pass has: depth "
                                      "and id are those of colliders",
                                      view.name),
                          "add --view snow or --view particles"});
}

/// Movies that get a line of black because their pictures have an odd side.
void check_movie_sides(const run::RenderJob& job, std::vector<health::Finding>& findings) {
  if (!job.has_movies() || !output::is_video(job.options.movie.format)) return;
  const auto check = [&](const std::string& view, const scene::PictureSize& size) {
    if (size.width % 2 == 0 && size.height % 2 == 0) return;
    const auto even = [](int side) { return side + side % 2; };
    const std::string sides = fmt::format("{}x{}", even(size.width), even(size.height));
    findings.push_back(
        {health::Severity::note, "--movie",
         fmt::format("{} has even sides: the movie of {} gets a line of black and is {}",
                     output::name(job.options.movie.format), view, sides),
         "choose an even size, as " + sides + ", or --movie gif"});
  };
  for (const scene::View& view : job.scene.views)
    if (job.draws_alone(view)) check(view.name, setup::size_of(job.scene, view));
  for (const scene::Mosaic& mosaic : job.scene.mosaics)
    check(mosaic.name, setup::size_of(job.scene, mosaic, job.caption_lines()));
}

/// Units that are not those of neve, snow that starts inside colliders or flies past everything:
/// nothing else tells before the run.
void warn_about_start(run::RenderJob& job, const setup::SeededScene& seeded, Progress& progress) {
  std::vector<health::Finding> findings;
  health::check_units(job.scene, findings, job.coarsening);
  health::check_resolution(job.scene, findings, job.coarsening);
  health::check_meshes(job.scene, findings);
  health::check_emitters(job.scene, findings, job.coarsening);
  health::check_starts_of_held(job.scene, findings);
  health::check_rounding(job.scene, findings, job.coarsening);
  health::check_collider_overlaps(job.scene, seeded, findings);
  health::check_meetings(job.scene, seeded, findings);
  check_title(job.scene.title, findings);
  if (job.shutter > 0 && job.shutter < 1)
    findings.push_back({health::Severity::warning, "--shutter",
                        fmt::format("an angle of {} degrees blurs nothing that can be seen",
                                    rough_text(job.shutter)),
                        fmt::format("a share of the frame is 360 times as many degrees: {}",
                                    rough_text(360 * job.shutter))});
  if (!job.passes.empty()) check_passes(job, findings);
  check_movie_sides(job, findings);
  // Idle settings belong to the command, not to the run: a sweep reports them once for all runs.
  std::vector<health::Finding> idle;
  health::check_idle(job.scene, scene::addresses_of(scene::parse_overrides(job.options.overrides)),
                     idle);
  for (const health::Finding& finding : idle) progress.warning(health::sentence(finding));
  for (const health::Finding& finding : findings) {
    job.warnings.push_back(finding.what);
    if (finding.severity == health::Severity::note)
      progress.note(health::sentence(finding));
    else
      progress.warning(health::sentence(finding));
  }
}

/// The run at full resolution, by copies of it; that of the run which is resumed, if it has one.
void predict_full(const run::RenderOptions& options, run::RenderJob& job, Progress& progress) {
  if (!job.finer) {
    if (job.prediction_lines.empty())
      throw UsageError("--predict", job.scene_file + " was made without a prediction",
                       "name its scene, with --coarsen, --predict and --replace");
    return;
  }
  const scene::Scene& full = *job.finer;
  const int last = scene::number_of(full, job.frames.last);
  const Json before = options.resume ? record::read_run_json(job.folder) : Json();
  const Json known = record::is_untouched(before) ? before.value("prediction", Json()) : Json();
  if (known.is_object() && known.value("frame", Json()) == last) {
    job.prediction = known;
  } else {
    const setup::Plan plan = setup::make_plan(full, job.frames, job.quality, options.threads);
    const double seconds = health::examine(full, plan, options.threads).seconds().expected;
    job.prediction = predict::to_json(
        predict::make_prediction(full, job.frames.last, seconds, options.threads, progress));
  }
  job.prediction_lines = job.prediction.at("text").get<std::vector<std::string>>();
  for (const std::string& line : job.prediction_lines) progress.note(line);
}

/// "validation: 19 checks at 12 steps, all held", or which did not.
std::string text_of_laws(const sim::checks::Watch& laws) {
  std::string broken;
  for (const sim::checks::WatchRecord& record : laws.records()) {
    if (record.times == 0) continue;
    broken += (broken.empty() ? "" : "; ") + std::string(sim::checks::name(record.check)) +
              " broken at " + std::to_string(record.times) + ", first at step " +
              std::to_string(record.first_step) + ", worst " + rough_text(record.worst) +
              (record.is_below ? " (at least " : " (at most ") + rough_text(record.threshold) + ")";
  }
  return fmt::format("validation: {} checks at {}, {}", laws.records().size(),
                     count_text(laws.looks(), "step"), broken.empty() ? "all held" : broken);
}

/// Errors become the one that the run ends with.
void report_laws(const sim::checks::Watch& laws, Progress& progress) {
  const bool have_held = std::ranges::all_of(
      laws.records(), [](const sim::checks::WatchRecord& record) { return record.times == 0; });
  if (have_held)
    progress.note(text_of_laws(laws));
  else if (!laws.has_errors())
    progress.warning(text_of_laws(laws));
}

void note_start(const run::RenderJob& job, const setup::Plan& plan, std::size_t particles,
                Progress& progress) {
  const std::string to_come =
      plan.emitted > 0 ? fmt::format(" and {} to come", fixed_text(plan.emitted, 0)) : "";
  if (job.fast) progress.note(job.fast->sentence());
  if (job.frames.last > scene::last_frame(job.scene))
    progress.note(
        fmt::format("frame {} is after the last frame of the scene, {}: the run continues",
                    scene::number_of(job.scene, job.frames.last),
                    scene::number_of(job.scene, scene::last_frame(job.scene))));
  progress.note(fmt::format("{}: {} particles{}, about {} of memory{}", job.scene_file, particles,
                            to_come, bytes_text(plan.memory),
                            scene::coarsened_words(job.scene, job.coarsening)));
}

/// "21 frames in out/snowball", or what was added to those that it had.
std::string frames_text(const run::RenderJob& job, const run::RenderRun& run,
                        const run::RenderResult& result) {
  const std::string folder = job.folder.string(), views = joined(run.record().views, ", ");
  const std::size_t all = run.record().frames.size();
  if (!result.is_addition) return fmt::format("{} in {}", count_text(all, "frame"), folder);
  if (result.drawn == 0)
    return fmt::format("nothing to draw: {} has these pictures of {}", folder, views);
  const auto drawn = static_cast<std::size_t>(result.drawn);
  const int from_states = run.record().frames_from_states;
  return fmt::format("{} of {} added to the run in {}{}", count_text(drawn, "frame"), views, folder,
                     result.simulated == 0 ? ", without simulating"
                     : from_states > 0     ? fmt::format(", {} of them from states", from_states)
                                           : std::string());
}

/// "20 states in out/snowball/states, 62 MiB of at most 1.0 GiB, ..."
std::string states_text(const run::RenderJob& job, const Json& states) {
  if (states.is_null()) return {};
  const std::string folder = (job.folder / "states").string();
  const std::size_t count = states.at("frames").size();
  if (states.contains("stopped") && count == 0)
    return "no states kept: " + states.at("stopped").get<std::string>();
  if (count == 0) return {};
  const int every = states.at("every").get<int>();
  const std::string budget =
      states.at("budget").is_null()
          ? ""
          : " of at most " + bytes_text(states.at("budget").get<std::uint64_t>());
  return fmt::format(
      "{}{} in {}, {}{}: other views, sizes, cameras and films of it need no "
      "simulation, as in neve render {} --view NAME",
      count_text(count, "state"), every > 1 ? fmt::format(", one every {} frames,", every) : "",
      folder, bytes_text(states.at("bytes").get<std::uint64_t>()), budget,
      shell_path(job.folder.string()));
}

/// Says which films have pictures of earlier commands, too; "" where none has.
std::string films_text(const run::RenderJob& job, const run::RenderRun& run,
                       const run::RenderResult& result) {
  if (!result.is_addition || result.movies.empty()) return {};
  std::vector<std::string> names;
  bool are_longer = false;
  for (const std::filesystem::path& movie : result.movies) {
    names.push_back(movie.string());
    are_longer |=
        record::frames_of(run.record(), movie.stem().string()).count() > job.frames.count();
  }
  if (!are_longer) return {};
  return joined(names, ", ") + (names.size() == 1 ? " has" : " have") +
         " all pictures of the view; --out FOLDER makes a film of --frames alone";
}

int finish(const run::RenderOptions& options, const run::RenderJob& job, const run::RenderRun& run,
           const run::RenderResult& result, Progress& progress) {
  progress.clear();
  const bool is_diverged = result.status == record::RunStatus::diverged;
  const bool is_interrupted = result.status == record::RunStatus::interrupted;
  const int code = is_diverged             ? exit_diverged
                   : !is_interrupted       ? exit_ok
                   : result.has_checkpoint ? exit_resumable
                                           : exit_interrupted;
  if (options.is_json) print_result(job, run, result, code);
  if (is_diverged) {
    Error error(exit_diverged, health::sentence(*run.record().divergence, *result.diagnosis),
                job.scene_file, "incident.json and diverged_*.png are in " + job.folder.string());
    error.warnings = run.record().warnings;
    throw error;
  }
  if (is_interrupted) {
    const std::size_t made = run.record().frames.size();
    progress.say(fmt::format("interrupted; {} {} in {}", count_text(made, "frame"),
                             made == 1 ? "is" : "are", job.folder.string()));
    if (result.is_addition)
      progress.say(options.replaces ? "the same command without --replace continues from here"
                                    : "the same command continues from here");
    else if (result.has_checkpoint)
      progress.say("--resume continues from here");
    return code;
  }
  progress.note(frames_text(job, run, result));
  if (const std::string films = films_text(job, run, result); !films.empty()) progress.note(films);
  for (const auto& [movie, shown] : record::short_movies(run.record()))
    progress.note((job.folder / movie).string() + record::short_movie_text(shown));
  if (const std::string states = states_text(job, run.record().states); !states.empty())
    progress.note(states);
  return exit_ok;
}

}  // namespace

int run_render(const run::RenderOptions& options) {
  const sim::shapes::HeldFiles files;
  run::RenderJob job = run::make_job(options);
  refuse_strip(options, job);
  if (!job.run.empty() && !job.fork && !options.resume && !grows(job)) job.scene.exports.clear();
  if (options.predicts && job.picture)
    throw UsageError("--predict", options.scene + " is a picture, one moment of a run",
                     "name its scene file");
  const double channel_bytes =
      job.passes.empty() ? 0 : run::bytes_of_pixel(run::pass_list(job.passes));
  const setup::Plan plan =
      setup::make_plan(job.scene, job.frames, job.quality, options.threads, channel_bytes);
  if (options.dry_run) {
    print_plan(job, plan, options.is_json);
    setup::check_limits(job.scene, plan, job.coarsening);
    return exit_ok;
  }
  setup::check_limits(job.scene, plan, job.coarsening);
  std::optional<render::Image> reference;
  if (!options.reference.empty()) reference = output::read_picture(options.reference);

  if (job.has_movies()) {
    output::MovieStyle& movie = job.options.movie;
    movie = output::available_movie(options.movie, job.scene.fps);
    if (output::is_video(movie.format)) scene::require_time_code(job.scene, movie.fps);
  }
  catch_interrupts();
  std::optional<NothingToKeep> reading(std::in_place);
  Progress progress(options.verbosity, options.progress);
  if (const std::string other = output::other_format_text(options.movie, job.options.movie);
      !other.empty())
    progress.note(other);
  const auto context = render::gl::open_context(options.backend);
  progress.note(
      fmt::format("OpenGL: {}, {}, {}", context->backend, context->renderer, context->version));
  ThreadPool pool(options.threads);
  render::Renderer renderer(*context, options.shader_dir, &pool);
  check_picture_sizes(job, renderer.max_size());
  run::check_plates(job);
  if (!job.lut.empty()) run::read_lut(job.lut);
  // The lock comes before anything else of the run: another one may be writing there.
  const output::FolderLock lock(job.folder, "neve render");

  const auto seeded = std::make_shared<const setup::SeededScene>(setup::seed_scene(job.scene));
  warn_about_start(job, *seeded, progress);
  if (options.predicts) predict_full(options, job, progress);
  setup::resolve(job.scene, seeded->planned);
  reading.reset();
  timeline::Timeline timeline = timeline::open(job, seeded, options.threads, progress);
  note_start(job, plan, seeded->particles.x.size(), progress);

  if (job.fork) run::go_to_fork(job, timeline, progress);
  run::RenderRun run(job, timeline, *context, renderer, progress);
  const run::RenderResult result = run.run();
  const sim::Simulation& simulation = timeline.simulation();
  for (const std::string& warning : run::step_warnings(job.scene, simulation))
    progress.warning(warning);
  if (const std::size_t trials = simulation.warnings().inverted_trials; trials > 0)
    progress.detail(fmt::format("{} trial deformations were inverted and repaired", trials));
  if (run.laws()) report_laws(*run.laws(), progress);
  const int code = finish(options, job, run, result, progress);
  if (code == exit_ok && run.laws() && run.laws()->has_errors())
    throw Error(exit_check_failed, text_of_laws(*run.laws()), job.scene_file,
                "the pictures are in " + job.folder.string());
  if (code == exit_ok && reference && !run.record().frames.empty()) {
    // A resumed run that was complete has drawn nothing.
    const auto file = output::frame_path(job.folder, run.record().views.front(),
                                         scene::number_of(job.scene, job.frames.last));
    const render::Image picture =
        result.last_picture ? *result.last_picture : output::read_picture(file);
    return compare_with_reference(options, job, picture, *reference);
  }
  return code;
}

}  // namespace neve::app::cli
