#include "app/run/drawing.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/output/atomic_file.h"
#include "app/output/read_picture.h"
#include "app/record/picture_files.h"
#include "app/setup/plan.h"
#include "app/support/errors.h"
#include "app/support/room.h"
#include "render/image/exr.h"
#include "render/image/jpeg.h"
#include "sim/shapes/numbered_files.h"

namespace neve::app::run {

namespace {

/// sRGB from linear light. Source: IEC 61966-2-1.
std::uint8_t srgb_of(double light) {
  const double c = std::clamp(light, 0.0, 1.0);
  const double value = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * value));
}

/// Returns linear light from sRGB, or from samples of another exponent.
double light_of(std::uint8_t sample, double gamma) {
  const double c = sample / 255.0;
  if (gamma > 0) return std::pow(c, 1 / gamma);
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// Grey becomes RGB, alpha lies over black, and another gamma becomes that of sRGB.
render::Image as_rgb(const render::Image& image, double gamma) {
  constexpr double usual = 1 / 2.2, near = 0.005;
  const bool is_srgb = gamma == 0 || std::abs(gamma - usual) < near;
  const auto channels = static_cast<std::size_t>(image.channels);
  const bool has_alpha = channels == 2 || channels == 4;
  render::Image out{image.width, image.height, 3, {}};
  out.pixels.reserve(image.pixels.size() / channels * 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const std::uint8_t alpha = has_alpha ? image.pixels[i + channels - 1] : 255;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint8_t sample = image.pixels[i + (channels < 3 ? 0 : c)];
      const bool is_kept = is_srgb && alpha == 255;
      out.pixels.push_back(
          is_kept ? sample : srgb_of(light_of(sample, is_srgb ? 0 : gamma) * alpha / 255.0));
    }
  }
  return out;
}

/// Returns RGB of linear light, as compositors write it: premultiplied, with alpha over black.
render::Image rgb_of_exr(const std::vector<std::uint8_t>& bytes) {
  const render::ExrPicture picture = render::decode_exr(bytes, memory_room());
  render::Image out{picture.width, picture.height, 3, {}};
  out.pixels.resize(3 * static_cast<std::size_t>(picture.width) *
                    static_cast<std::size_t>(picture.height));
  std::array<std::vector<float>, 3> light;
  const char* const names[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const render::ExrChannel* channel = picture.find(names[c]);
    if (!channel) channel = picture.find("Y");
    if (!channel)
      throw render::ImageError(std::string("the OpenEXR file has no channel ") + names[c]);
    light[c] = render::numbers_of(*channel);
  }
  const bool is_rec709 = picture.to_rec709 == render::ExrPicture{}.to_rec709;
  for (std::size_t i = 0; i < light[0].size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::array<float, 3>& row = picture.to_rec709[c];
      const float own = is_rec709
                            ? light[c][i]
                            : row[0] * light[0][i] + row[1] * light[1][i] + row[2] * light[2][i];
      out.pixels[3 * i + c] = std::isfinite(own) ? srgb_of(own) : 255;
    }
  return out;
}

/// @param file  named in errors
render::Image rgb_of(const std::vector<std::uint8_t>& bytes, const std::filesystem::path& file) {
  const auto begins = [&](std::initializer_list<std::uint8_t> start) {
    return bytes.size() > start.size() && std::equal(start.begin(), start.end(), bytes.begin());
  };
  return output::decoded(file, "a plate is a PNG, a JPEG or an OpenEXR file", [&] {
    if (begins({0x76, 0x2f, 0x31, 0x01})) return rgb_of_exr(bytes);
    if (begins({0xff, 0xd8, 0xff})) return as_rgb(render::decode_jpeg(bytes, memory_room()), 0);
    return as_rgb(render::decode_png(bytes, memory_room()), render::read_png_gamma(bytes));
  });
}

/// The first number that a plate has, where the shot begins with another one; -1: there is none.
int first_plate(const RenderJob& job) {
  constexpr int highest = 9999;
  std::error_code error;
  for (int number = 0; number <= highest; ++number)
    if (std::filesystem::exists(plate_path(job.plate, number), error)) return number;
  return -1;
}

}  // namespace

std::filesystem::path plate_path(const std::string& pattern, int frame) {
  std::error_code error;
  if (std::filesystem::is_regular_file(pattern, error)) return pattern;
  const std::string name = sim::shapes::numbered_file(pattern, frame);
  if (std::filesystem::path(name).filename().string().find('%') != std::string::npos)
    throw UsageError("--plate", "cannot read \"" + pattern + "\"",
                     "expected a picture, or one for each frame, as in street/%04d.png");
  return name;
}

namespace {

/// @param file  of the frame
render::Image read_file_of(const RenderJob& job, int frame, const std::filesystem::path& file) {
  if (job.picture && job.options.plate.empty())
    record::require_listed(*job.picture, file.string(), job.scene_file);
  std::error_code error;
  const int first = std::filesystem::exists(file, error) ? -1 : first_plate(job);
  if (first > frame) {
    const bool has_its_number = job.scene.first_frame == first;
    const int last = scene::number_of(job.scene, job.frames.last);
    throw UsageError(
        "--plate", file.string() + " is missing",
        fmt::format("the plates begin with {}: {}", plate_path(job.plate, first).string(),
                    has_its_number ? fmt::format("--frames {}-{}, or --set handles=0", first, last)
                                   : fmt::format("--set first_frame={}", first)));
  }
  return rgb_of(output::read_file(file), file);
}

void require_size(const render::Image& image, const std::filesystem::path& file,
                  const std::string& view, const scene::PictureSize& size) {
  const std::string advice = std::min(image.width, image.height) < scene::min_side
                                 ? fmt::format("pictures are at least {0}x{0}", scene::min_side)
                                 : fmt::format("draw with --size {}x{}", image.width, image.height);
  if (image.width != size.width || image.height != size.height)
    throw Error(
        exit_invalid_scene,
        fmt::format("{}: error: the plate is {}x{} and the view {} is {}x{}; {}", file.string(),
                    image.width, image.height, view, size.width, size.height, advice),
        file.string(), advice);
}

}  // namespace

render::Image read_plate(const RenderJob& job, int frame, const std::string& view,
                         const scene::PictureSize& size) {
  const std::filesystem::path file = plate_path(job.plate, frame);
  render::Image image = read_file_of(job, frame, file);
  require_size(image, file, view, size);
  return image;
}

void check_plates(const RenderJob& job) {
  if (job.plate.empty()) return;
  const int last = job.options.resume ? job.frames.first : job.frames.last;
  std::filesystem::path before;
  for (int frame = job.frames.first; frame <= last; ++frame) {
    const int number = scene::number_of(job.scene, frame);
    const std::filesystem::path file = plate_path(job.plate, number);
    if (file == before) return;  // one picture for all frames
    before = file;
    const render::Image image = read_file_of(job, number, file);
    for (const scene::View& view : job.scene.views)
      require_size(image, file, view.name, setup::size_of(job.scene, view));
  }
}

render::CubeLut read_lut(const std::string& file) {
  const auto bytes = output::read_file(file);
  return output::decoded(file, "a look is a .cube file, as grading programs export it", [&] {
    return render::parse_cube({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
  });
}

}  // namespace neve::app::run
