#pragma once
/// Files compiled into the binary; see cmake/EmbedFiles.cmake.

#include <string_view>

namespace neve::render::gl {

/// Text of a file in shaders/, empty for an unknown name.
std::string_view find_embedded_shader(std::string_view file_name);

/// Bytes of DejaVuSans.ttf.
std::string_view find_embedded_font(std::string_view file_name);

}  // namespace neve::render::gl
