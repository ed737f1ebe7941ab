#include "app/output/read_picture.h"

#include "app/output/atomic_file.h"

namespace neve::app::output {

render::Image read_picture(const std::filesystem::path& file) {
  return decode_picture(read_file(file), file);
}

render::Image decode_picture(std::span<const std::uint8_t> bytes,
                             const std::filesystem::path& file) {
  return decoded(file, "", [&] { return render::decode_png(bytes, memory_room()); });
}

}  // namespace neve::app::output
