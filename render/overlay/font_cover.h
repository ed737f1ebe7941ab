#pragma once
/// Characters that the font of words over pictures has.

#include <string>

namespace neve::render::overlay {

/// The characters of a text (UTF-8) that it lacks, each once, in their order.
std::string characters_without_glyph(const std::string& text);

}  // namespace neve::render::overlay
