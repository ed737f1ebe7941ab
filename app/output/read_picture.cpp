#include "app/output/read_picture.h"

#include "app/output/atomic_file.h"
#include "app/support/room.h"

namespace neve::app::output {

render::Image read_picture(const std::filesystem::path& file) {
  return decode_picture(read_file(file), file);
}

render::Image decode_picture(std::span<const std::uint8_t> bytes,
                             const std::filesystem::path& file) {
  try {
    return render::decode_png(bytes, memory_room());
  } catch (const render::ImageSizeError& error) {
    require_room(error.bytes, error.what(), file.string());
    throw;
  } catch (const render::ImageError& error) {
    throw Error(exit_invalid_scene, file.string() + ": error: " + error.what(), file.string());
  }
}

}  // namespace neve::app::output
