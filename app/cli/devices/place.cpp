#include "app/cli/devices/place.h"

#include <cstdlib>
#include <iostream>

#include "app/scene/scene_file.h"
#include "app/scene/toml/error.h"
#include "app/support/json.h"
#include "app/support/progress.h"
#include "app/view/replay/replay_frontend.h"
#include "app/view/web/web_guard.h"

namespace neve::app::cli::devices {

bool has_display() {
  return std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
}

void Place::set_title(const std::string& title) {
  if (window) window->set_title(title);
  if (web) web->set_title(title);
}

namespace {

Place open_replay(const PlaceOptions& options) {
  Place place;
  const std::string& file = options.screen.replay;
  if (!std::filesystem::exists(file))
    throw scene::toml::SceneError(file, 0, 0, "No such file or directory",
                                  "--record FILE writes a script of input");
  const std::string text = scene::read_toml_file(file);
  view::replay::ReplayFrontend::Options replay;
  replay.folder = options.out.empty() ? "." : options.out;
  replay.frames = options.screen.pictures;
  if (options.size) replay.size = *options.size;
  const auto steps = view::replay::parse_replay(text, file);
  constexpr double long_while = 10;  // s
  if (const double seconds = view::replay::min_seconds(steps); seconds > long_while)
    std::cerr << "neve: " << file << ": " << steps.size() << " steps take "
              << duration_text(seconds) << " or more; Ctrl-C ends them" << std::endl;
  place.front = std::make_unique<view::replay::ReplayFrontend>(steps, file, replay);
  place.own_context = render::gl::open_context(options.backend);
  place.context = place.own_context.get();
  return place;
}

Place open_web(const PlaceOptions& options) {
  view::web::WebOptions web;
  if (!options.screen.listen.empty()) {
    web.address = options.screen.listen;
    web.is_risk_taken = true;
  }
  web.port = options.screen.port;
  web.public_url = options.screen.public_url;
  if (options.size) web.size = *options.size;
  Place place;
  // An address at which it cannot listen is an error and no risk.
  auto front = std::make_unique<view::web::WebFrontend>(web);
  if (const std::string risk = view::web::risk_of(web.address); web.is_risk_taken && !risk.empty())
    std::cerr << "neve: warning: " << risk << std::endl;
  place.web = front.get();
  place.front = std::move(front);
  place.own_context = render::gl::open_context(options.backend);
  place.context = place.own_context.get();
  return place;
}

Place open_window(const PlaceOptions& options) {
  Place place;
  auto front = std::make_unique<view::frontend::WindowFrontend>(
      "neve", options.size.value_or(view::frontend::ScreenSize{1440, 860, 1}));
  place.window = front.get();
  place.context = &front->context();
  place.front = std::move(front);
  return place;
}

Place open_what_fits(const PlaceOptions& options) {
  const view::ScreenOptions& screen = options.screen;
  if (!screen.replay.empty()) return open_replay(options);
  if (screen.is_window) return open_window(options);
  if (screen.is_web || !has_display()) return open_web(options);
  try {
    return open_window(options);
  } catch (const render::gl::ContextError& error) {
    std::cerr << "neve: no window: " << error.what() << "; serving a web page instead" << std::endl;
    return open_web(options);
  }
}

}  // namespace

Place open_place(const PlaceOptions& options) {
  Place place = open_what_fits(options);
  if (!options.screen.record.empty())
    place.recording =
        std::make_unique<view::replay::RecordingFrontend>(*place.front, options.screen.record);
  return place;
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
  std::cerr << "neve: open the address above in a browser; Ctrl-C ends" << std::endl;
  // Only these addresses are the same at the other end of a tunnel.
  const std::string where = place.front->where();
  if (where.starts_with("http://127.0.0.1:") || where.starts_with("http://localhost:"))
    std::cerr << "neve: from another machine: ssh -L " << place.web->port()
              << ":127.0.0.1:" << place.web->port() << " THIS_MACHINE, then the same address there"
              << std::endl;
}

}  // namespace neve::app::cli::devices
