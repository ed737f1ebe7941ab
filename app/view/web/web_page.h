#pragma once
/// The one page that a viewer's browser shows.

#include <string>
#include <string_view>

namespace neve::app::view::web {

/// The answer with the page. Its script and its style carry a number of this answer only, so that
/// nothing else can run in it, and it may connect only to these places.
/// @param sockets  origins of web sockets between blanks, of checked hosts: "ws://localhost:8080"
std::string page_answer(const std::string& sockets);

/// Answer to a request without token. A reloaded tab finds its token again.
std::string no_token_answer();

/// Files of this folder that are compiled in; see cmake/EmbedFiles.cmake.
std::string_view find_embedded_page(std::string_view file_name);

}  // namespace neve::app::view::web
