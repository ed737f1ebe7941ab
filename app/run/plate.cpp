#include "app/run/plate.h"

#include <fmt/core.h>

#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "sim/shapes/numbered_files.h"

namespace neve::app::run {

namespace {

/// Grey becomes RGB, and alpha is dropped.
render::Image as_rgb(const render::Image& image) {
  const auto channels = static_cast<std::size_t>(image.channels);
  render::Image out{image.width, image.height, 3, {}};
  out.pixels.reserve(image.pixels.size() / channels * 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += channels)
    for (std::size_t c = 0; c < 3; ++c)
      out.pixels.push_back(image.pixels[i + (channels < 3 ? 0 : c)]);
  return out;
}

}  // namespace

std::filesystem::path plate_path(const std::string& pattern, int frame) {
  const std::string name = sim::shapes::numbered_file(pattern, frame);
  if (std::filesystem::path(name).filename().string().find('%') != std::string::npos)
    throw UsageError("--plate", "cannot read \"" + pattern + "\"",
                     "expected a PNG, or one for each frame, as in street/%04d.png");
  return name;
}

render::Image read_plate(const std::filesystem::path& file, const std::string& view,
                         scene::PictureSize size) {
  render::Image image;
  try {
    image = render::decode_png(output::read_file(file));
  } catch (const render::ImageError& error) {
    throw Error(exit_invalid_scene, file.string() + ": error: " + error.what(), file.string(),
                "a plate is a PNG");
  }
  if (image.width != size.width || image.height != size.height)
    throw Error(exit_invalid_scene,
                fmt::format("{}: error: the plate is {}x{} and the view {} is {}x{}", file.string(),
                            image.width, image.height, view, size.width, size.height),
                file.string(), fmt::format("draw with --size {}x{}", image.width, image.height));
  return as_rgb(image);
}

}  // namespace neve::app::run
