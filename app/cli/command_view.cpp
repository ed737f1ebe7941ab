#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>

#include "app/cli/commands.h"
#include "app/cli/devices/place.h"
#include "app/predict/live.h"
#include "app/record/picture_record.h"
#include "app/run/render_job.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/out_folder.h"
#include "app/timeline/origin.h"
#include "app/timeline/times.h"
#include "app/view/viewer.h"

namespace neve::app::cli {

namespace {

devices::PlaceOptions place_options(const view::ViewOptions& options) {
  devices::PlaceOptions place{options.screen, options.run.backend, options.run.out, std::nullopt};
  if (options.run.size) place.size = {options.run.size->width, options.run.size->height, 1};
  return place;
}

/// @return what to open next, if there is anything
std::optional<view::session::Opened> look_at(view::session::Opened opened,
                                             const view::ViewOptions& options,
                                             devices::Place& place) {
  const std::string file = opened.document.file();
  view::session::WorkbenchOptions bench_options;
  bench_options.session.threads = options.run.threads;
  bench_options.session.past = std::move(opened.past);
  bench_options.overrides = std::move(opened.overrides);
  bench_options.backend = options.run.backend;
  bench_options.is_remote = place.web != nullptr;
  bench_options.folder = options.run.out.empty()
                             ? out_folder() / (scene::name_of_scene(file) + "-view")
                             : std::filesystem::path(options.run.out);
  view::session::Workbench bench(std::move(opened.document), std::move(bench_options),
                                 [&place] { place.front->wake(); });
  ThreadPool pool(options.run.threads);
  render::Renderer renderer(*place.context, options.run.shader_dir, &pool);
  render::Screen screen(*place.context, options.run.shader_dir);
  if (options.at)
    bench.session().show_frame(timeline::frame_at(*options.at, bench.document().scene()->fps));
  const std::string title = std::filesystem::path(file).filename().string() + " - neve";
  place.set_title(title);
  view::ViewerOptions viewer_options;
  viewer_options.max_pictures = options.screen.replay.empty() ? options.screen.pictures : 0;
  viewer_options.is_running = options.is_running;
  viewer_options.has_own_clock = !options.screen.replay.empty();
  if (!options.run.views.empty()) {
    viewer_options.view = options.run.views.front();
    scene::find_view(*bench.document().scene(), *viewer_options.view);
  }
  view::Viewer viewer(bench, place.shown(), screen, renderer, viewer_options);
  viewer.run();
  // Nobody reads the messages of a script.
  if (!options.screen.replay.empty() && !bench.not_saved().empty())
    throw IoError(bench.not_saved(), options.screen.replay,
                  "the script continued; its other files were saved");
  return std::move(viewer.state().dropped);
}

/// Chooses cells and steps with which simulated time keeps up with the clock, and says which.
void take_live_choice(view::ViewOptions& options) {
  const bool is_quiet = options.run.verbosity == Verbosity::quiet;
  run::RenderOptions start = options.run;
  start.is_start_only = true;
  const run::RenderJob job = run::make_job(start);
  if (!job.run.empty())
    throw UsageError("--live", options.run.scene + " is the folder of a run: it keeps its cells",
                     "name its scene file");
  if (!is_quiet)
    std::cerr << "neve: live: looks for cells that keep up with the clock" << std::endl;
  const predict::LiveChoice choice =
      predict::choose_live(job.scene, job.frames.last,
                           scene::addresses_of(scene::parse_overrides(options.run.overrides)),
                           predict::measured_pace(options.run.threads));
  if (!is_quiet) std::cerr << "neve: live: " << choice.sentence() << std::endl;
  if (choice.coarsening > 1) options.run.coarsening = choice.coarsening;
  if (choice.fast)
    options.run.overrides.insert(options.run.overrides.end(), choice.fast->overrides.begin(),
                                 choice.fast->overrides.end());
}

}  // namespace

int run_view(const view::ViewOptions& given) {
  catch_interrupts();
  view::ViewOptions options = given;
  if (options.run.is_fast) {
    run::RenderOptions start = options.run;
    start.is_start_only = true;
    start.is_agreed = true;  // it is asked for below, before anything is simulated
    const forecast::FastLook look = *run::make_job(start).fast;
    if (options.run.verbosity != Verbosity::quiet)
      std::cerr << "neve: " << look.sentence() << std::endl;
    options.run.overrides.insert(options.run.overrides.end(), look.overrides.begin(),
                                 look.overrides.end());
  }
  if (options.is_live) take_live_choice(options);
  const std::string file = options.run.scene.empty() ? default_scene().string() : options.run.scene;
  // A scene that cannot be read is told before a window opens.
  std::optional<NothingToKeep> reading(std::in_place);
  std::optional<view::session::Opened> opened = view::session::open_document(
      options.run.scene, options.run.overrides, options.run.coarsening.value_or(1),
      options.run.is_agreed ? timeline::Agreement::given : timeline::Agreement::asked);
  if (timeline::is_folder(file) && !(opened->past && opened->past->newest))
    std::cerr
        << "neve: warning: " << file
        << " has no checkpoint that this program can continue: the view starts at its first frame"
        << std::endl;
  if (record::is_picture(file))
    if (const std::size_t changes = record::read_picture_record(file).changes.size(); changes > 0)
      std::cerr
          << "neve: warning: " << changes
          << " changes were made while the run of this picture ran; the view starts without them"
          << std::endl;
  if (options.at) timeline::require_before_end("--at", *options.at, timeline::Origin::of(file, {}));
  reading.reset();
  devices::Place place = devices::open_place(place_options(options));
  devices::announce(place, options.run.is_json, options.run.verbosity == Verbosity::quiet);
  // Overrides, the view and the moment belong to the first scene only; the coarsening applies to
  // later scenes too.
  while (opened) {
    opened = look_at(*std::move(opened), options, place);
    options.run.views.clear();
    options.at.reset();
  }
  if (place.recording) place.recording->save();
  return exit_ok;
}

}  // namespace neve::app::cli
