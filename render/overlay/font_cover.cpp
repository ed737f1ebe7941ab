#include "render/overlay/font_cover.h"

#include <imgui_internal.h>
#include <stb/stb_truetype.h>

#include <string_view>

#include "render/gl/embedded.h"

namespace neve::render::overlay {

std::string characters_without_glyph(const std::string& text) {
  const std::string_view bytes = gl::find_embedded_font("DejaVuSans.ttf");
  stbtt_fontinfo font;
  if (!stbtt_InitFont(&font, reinterpret_cast<const unsigned char*>(bytes.data()), 0)) return {};
  std::string missing;
  for (const char *at = text.c_str(), *end = at + text.size(); at < end;) {
    unsigned code = 0;
    const int length = ImTextCharFromUtf8(&code, at, end);
    const std::string_view character(at, static_cast<std::size_t>(length));
    at += length;
    if (code < 0x20 || missing.find(character) != std::string::npos) continue;
    // ImGui keeps 16 bits of a code.
    if (code > 0xffff || stbtt_FindGlyphIndex(&font, static_cast<int>(code)) == 0)
      missing += character;
  }
  return missing;
}

}  // namespace neve::render::overlay
