#pragma once
/// Pixels of a PNG that anyone may have made.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "app/support/errors.h"
#include "app/support/room.h"
#include "render/image/image.h"

namespace neve::app::output {

/// Returns what decode() makes of the bytes of a file. Its errors then name the file.
/// @throws Error with the advice, for bytes that are no whole picture; LimitError for one that
/// becomes more than memory_room()
template <class Decode>
auto decoded(const std::filesystem::path& file, const std::string& advice, const Decode& decode) {
  try {
    return decode();
  } catch (const render::ImageSizeError& error) {
    require_room(error.bytes, error.what(), file.string());
    throw;
  } catch (const render::ImageError& error) {
    throw Error(exit_invalid_scene, file.string() + ": error: " + error.what(), file.string(),
                advice);
  }
}

/// @throws IoError; Error for bytes that are no whole PNG; LimitError for one that becomes more
/// than memory_room()
render::Image read_picture(const std::filesystem::path& file);
/// @param file  named in errors
render::Image decode_picture(std::span<const std::uint8_t> bytes,
                             const std::filesystem::path& file);

}  // namespace neve::app::output
