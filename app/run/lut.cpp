#include "app/run/lut.h"

#include "app/output/atomic_file.h"
#include "app/support/errors.h"

namespace neve::app::run {

render::CubeLut read_lut(const std::string& file) {
  const auto bytes = output::read_file(file);
  try {
    return render::parse_cube({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
  } catch (const render::ImageError& error) {
    throw Error(exit_invalid_scene, error.what(), file,
                "a look is a .cube file, as grading programs export it");
  }
}

}  // namespace neve::app::run
