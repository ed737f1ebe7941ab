#pragma once
/// Messages between the page and the program; docs/view_web.md has the list.

#include <cstdint>
#include <string>
#include <string_view>

#include "app/view/frontend/frontend.h"

namespace neve::app::view::web {

/// Pixels that a browser is sent at most: more is scaled up there.
inline constexpr double max_web_pixels = 8.3e6;

/// One message of the page.
struct PageMessage {
  enum class Kind {
    none,  ///< nothing that a page of ours says
    event,
    size,     ///< of its window
    shown,    ///< a picture has been shown
    visible,  ///< its tab came to the front, or left it
  };
  Kind kind = Kind::none;
  frontend::InputEvent event;
  frontend::ScreenSize size;
  std::uint32_t number = 0;  ///< of the picture
  bool is_visible = true;
};

/// Reads a message; the text is UTF-8. Numbers out of range are brought into it.
PageMessage read_page_message(std::string_view text);

/// A size that pictures may have: not tiny, not above max_web_pixels; a larger one keeps its
/// shape and is scaled up by the browser.
frontend::ScreenSize limited_size(frontend::ScreenSize size);

/// A message to the page: {"title": "..."}; bytes that are not UTF-8 are replaced.
std::string page_text(const char* key, const std::string& value);

/// A picture for the page: its number in four bytes, the lowest first, and the JPEG.
std::string page_picture(std::uint32_t number, std::string_view jpeg);

}  // namespace neve::app::view::web
