#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "app/cli/commands.h"
#include "app/run/picture_record.h"
#include "app/run/render_job.h"
#include "app/scene/read.h"
#include "app/scene/scene_file.h"
#include "app/scene/toml/error.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/json.h"
#include "app/support/machine.h"
#include "app/support/out_folder.h"
#include "app/view/frontend/window_frontend.h"
#include "app/view/replay/recording_frontend.h"
#include "app/view/replay/replay_frontend.h"
#include "app/view/viewer.h"
#include "app/view/web/web_frontend.h"
#include "app/view/web/web_guard.h"
#include "render/gl/context.h"

namespace neve::app::cli {

namespace {

/// Frontend of the view, with its drawing context.
struct Place {
  std::unique_ptr<view::frontend::Frontend> front;
  std::unique_ptr<render::gl::Context> own_context;  ///< none where the window has one
  render::gl::Context* context = nullptr;
  view::frontend::WindowFrontend* window = nullptr;
  view::web::WebFrontend* web = nullptr;
};

bool has_display() {
  return std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
}

Place open_replay(const view::ViewOptions& options) {
  Place place;
  if (!std::filesystem::exists(options.replay))
    throw scene::toml::SceneError(options.replay, 0, 0, "No such file or directory",
                                  "--record FILE writes a script of input");
  const std::string text = scene::read_toml_file(options.replay);
  view::replay::ReplayFrontend::Options replay;
  replay.folder = options.run.out.empty() ? "." : options.run.out;
  replay.frames = options.pictures;
  if (options.run.size) replay.size = {options.run.size->width, options.run.size->height, 1};
  place.front = std::make_unique<view::replay::ReplayFrontend>(
      view::replay::parse_replay(text, options.replay), options.replay, replay);
  place.own_context = render::gl::open_context(options.run.backend);
  place.context = place.own_context.get();
  return place;
}

Place open_web(const view::ViewOptions& options) {
  view::web::WebOptions web;
  if (!options.listen.empty()) {
    web.address = options.listen;
    web.is_risk_taken = true;
    if (const std::string risk = view::web::risk_of(web.address); !risk.empty())
      std::cerr << "neve: warning: " << risk << std::endl;
  }
  web.port = options.port;
  if (options.run.size) web.size = {options.run.size->width, options.run.size->height, 1};
  Place place;
  auto front = std::make_unique<view::web::WebFrontend>(web);
  place.web = front.get();
  place.front = std::move(front);
  place.own_context = render::gl::open_context(options.run.backend);
  place.context = place.own_context.get();
  return place;
}

Place open_window(const view::ViewOptions& options) {
  view::frontend::ScreenSize size{1440, 860, 1};
  if (options.run.size) size = {options.run.size->width, options.run.size->height, 1};
  Place place;
  auto front = std::make_unique<view::frontend::WindowFrontend>("neve", size);
  place.window = front.get();
  place.context = &front->context();
  place.front = std::move(front);
  return place;
}

/// Opens a window if there is a display and no page is requested.
Place open_place(const view::ViewOptions& options) {
  if (!options.replay.empty()) return open_replay(options);
  if (options.is_window) return open_window(options);
  if (options.is_web || !has_display()) return open_web(options);
  try {
    return open_window(options);
  } catch (const render::gl::ContextError& error) {
    std::cerr << "neve: no window: " << error.what() << "; serving a web page instead" << std::endl;
    return open_web(options);
  }
}

void announce(const Place& place, bool is_json, bool is_quiet) {
  if (is_json) {
    const char* mode = place.web ? "web" : place.window ? "window" : "replay";
    Json json{{"mode", mode}};
    if (place.web) json["url"] = place.front->where();
    if (place.web) json["port"] = place.web->port();
    std::cout << to_text(json) << std::endl;
    return;
  }
  if (!place.web) return;
  std::cout << place.front->where() << std::endl;
  if (is_quiet) return;
  std::cerr << "neve: open the address above in a browser; Ctrl-C ends\n"
            << "neve: from another machine: ssh -L " << place.web->port()
            << ":127.0.0.1:" << place.web->port() << " THIS_MACHINE, then the same address there"
            << std::endl;
}

/// @return the scene to open next, if there is one
std::optional<view::session::Document> look_at(view::session::Document document,
                                               const std::vector<std::string>& overrides,
                                               const view::ViewOptions& options, Place& place,
                                               view::frontend::Frontend& front) {
  const std::string file = document.file();
  view::session::WorkbenchOptions bench_options;
  bench_options.session.threads = options.run.threads;
  bench_options.session.kept_budget = options.kept_memory;
  bench_options.overrides = overrides;
  bench_options.is_remote = place.web != nullptr;
  bench_options.folder = options.run.out.empty()
                             ? out_folder() / (scene::name_of_scene(file) + "-view")
                             : std::filesystem::path(options.run.out);
  view::session::Workbench bench(std::move(document), std::move(bench_options),
                                 [&place] { place.front->wake(); });
  ThreadPool pool(options.run.threads);
  render::Renderer renderer(*place.context, options.run.shader_dir, &pool);
  render::Screen screen(*place.context, options.run.shader_dir);
  const std::string title = std::filesystem::path(file).filename().string() + " - neve";
  if (place.window) place.window->set_title(title);
  if (place.web) place.web->set_title(title);
  view::ViewerOptions viewer_options;
  viewer_options.max_pictures = options.replay.empty() ? options.pictures : 0;
  viewer_options.is_running = options.is_running;
  viewer_options.has_own_clock = !options.replay.empty();
  if (!options.run.views.empty()) {
    viewer_options.view = options.run.views.front();
    scene::find_view(*bench.document().scene(), *viewer_options.view);
  }
  view::Viewer viewer(bench, front, screen, renderer, viewer_options);
  viewer.run();
  // Nobody reads the messages of a script.
  if (!options.replay.empty() && !bench.not_saved().empty())
    throw IoError(bench.not_saved(), options.replay,
                  "the script went on; what it saved besides is there");
  return std::move(viewer.state().dropped);
}

}  // namespace

int run_view(const view::ViewOptions& given) {
  catch_interrupts();
  view::ViewOptions options = given;
  if (options.run.is_fast) {
    const health::FastLook look = *run::make_job(options.run).fast;
    if (options.run.verbosity != Verbosity::quiet)
      std::cerr << "neve: " << look.sentence() << std::endl;
    options.run.overrides.insert(options.run.overrides.end(), look.overrides.begin(),
                                 look.overrides.end());
  }
  const std::string file = options.run.scene.empty() ? default_scene().string() : options.run.scene;
  // A scene that cannot be read is told before a window opens.
  std::optional<view::session::Document> document =
      view::session::open_document(file, options.run.overrides, options.run.coarsening.value_or(1));
  if (run::is_picture(file))
    if (const std::size_t changes = run::read_picture_record(file).changes.size(); changes > 0)
      std::cerr
          << "neve: warning: " << changes
          << " changes were made while the run of this picture ran; the view starts without them"
          << std::endl;
  Place place = open_place(options);
  announce(place, options.run.is_json, options.run.verbosity == Verbosity::quiet);
  std::unique_ptr<view::replay::RecordingFrontend> recording;
  if (!options.record.empty())
    recording = std::make_unique<view::replay::RecordingFrontend>(*place.front, options.record);
  view::frontend::Frontend& front = recording ? *recording : *place.front;
  document = look_at(*std::move(document), options.run.overrides, options, place, front);
  // Overrides belong to the first scene only; the coarsening applies to later scenes too.
  while (document) document = look_at(*std::move(document), {}, options, place, front);
  if (recording) recording->save();
  return exit_ok;
}

}  // namespace neve::app::cli
