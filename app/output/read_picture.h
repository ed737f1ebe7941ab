#pragma once
/// Pixels of a PNG that anyone may have made.

#include <cstdint>
#include <filesystem>
#include <span>

#include "render/image/image.h"

namespace neve::app::output {

/// @throws IoError; Error for bytes that are no whole PNG; LimitError for one that becomes more
/// than memory_room()
render::Image read_picture(const std::filesystem::path& file);
/// @param file  named in errors
render::Image decode_picture(std::span<const std::uint8_t> bytes,
                             const std::filesystem::path& file);

}  // namespace neve::app::output
