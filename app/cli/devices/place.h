#pragma once
/// The window, the page or the script in which a screen is shown and worked.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/view/frontend/window_frontend.h"
#include "app/view/replay/recording_frontend.h"
#include "app/view/view_options.h"
#include "app/view/web/web_frontend.h"
#include "render/gl/context.h"

namespace neve::app::cli::devices {

struct PlaceOptions {
  view::ScreenOptions screen;
  std::string backend = "auto";  ///< of a page and of a script
  std::filesystem::path out;     ///< folder of a script's screenshots
  std::optional<view::frontend::ScreenSize> size{};
};

/// A frontend with its drawing context.
struct Place {
  std::unique_ptr<view::frontend::Frontend> front;
  std::unique_ptr<render::gl::Context> own_context;  ///< none if the window has one
  render::gl::Context* context = nullptr;
  view::frontend::WindowFrontend* window = nullptr;
  view::web::WebFrontend* web = nullptr;
  std::unique_ptr<view::replay::RecordingFrontend> recording;  ///< with --record

  /// Returns the frontend that input comes from.
  view::frontend::Frontend& shown() { return recording ? *recording : *front; }
  void set_title(const std::string& title);
};

bool has_display();

/// Opens a window if there is a display and no page is requested.
/// @throws ContextError, IoError, Error of exit code 2 for a page that cannot be served
Place open_place(const PlaceOptions& options);

/// Prints the address of a page, with advice; as JSON where it is to be read by a program.
void announce(const Place& place, bool is_json, bool is_quiet);

}  // namespace neve::app::cli::devices
