#pragma once
/// Command line options of neve view, and of all that has a screen.

#include <cstdint>
#include <optional>
#include <string>

#include "app/run/render_options.h"

namespace neve::app::view {

/// Place of a screen: a window, a page or a script.
struct ScreenOptions {
  bool is_web = false, is_window = false;  ///< neither: whichever fits
  std::string listen;                      ///< address of the page; empty: this machine alone
  int port = 0;                            ///< of the page; 0: a free one
  std::string public_url;                  ///< of a proxy that shows the page; empty: none
  std::string replay, record;              ///< files of scripts
  int pictures = 0;                        ///< ends after so many; 0: never
};

struct ViewOptions {
  run::RenderOptions run;  ///< scene, overrides, coarsening, threads, views, size, out, backend
  ScreenOptions screen;
  bool is_running = false;     ///< from the start
  bool is_live = false;        ///< with cells and steps that keep up with the clock
  std::optional<double> at{};  ///< s, the moment of a run that is shown first; absent: its last
};

}  // namespace neve::app::view
