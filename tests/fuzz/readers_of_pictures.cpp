#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "app/record/picture_record.h"
#include "app/support/errors.h"
#include "render/image/cube_lut.h"
#include "render/image/exr.h"
#include "render/image/image.h"
#include "render/image/jpeg.h"
#include "tests/fuzz/readers.h"

namespace neve::test::fuzz {

namespace {

using namespace neve::app;

constexpr const char* picture_scene = R"(
[solver]
cell_size = 0.06
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.12, 0], radius = 0.06 } }
)";

/// Bytes that pixels may take.
constexpr double room = 256e6;

/// The checksums of PNG chunks, as far as they are chunks.
Bytes with_right_checksums(std::span<const std::uint8_t> bytes) {
  Bytes png(bytes.begin(), bytes.end());
  constexpr std::size_t signature = 8, overhead = 12;
  for (std::size_t at = signature; at + overhead <= png.size();) {
    const std::size_t length = std::size_t{png[at]} << 24 | std::size_t{png[at + 1]} << 16 |
                               std::size_t{png[at + 2]} << 8 | std::size_t{png[at + 3]};
    if (length > png.size() - at - overhead) break;
    const auto sum = crc32_z(crc32_z(0, nullptr, 0), png.data() + at + 4, length + 4);
    for (int k = 0; k < 4; ++k)
      png[at + 8 + length + static_cast<std::size_t>(k)] =
          static_cast<std::uint8_t>(sum >> (24 - 8 * k));
    at += overhead + length;
  }
  return png;
}

template <class Read>
void try_picture(const Read& read) {
  try {
    read();
  } catch (const render::ImageError&) {
  } catch (const Error&) {
  }
}

/// A channel of each kind of number, of pixels that no two are alike.
render::ExrPicture small_exr(int width, int height) {
  std::vector<float> numbers(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 0.37f * static_cast<float>(i);
  return {width,
          height,
          {{"B", render::to_half(numbers)},
           {"G", render::to_half(numbers)},
           {"R", render::to_half(numbers)},
           {"Z", numbers}}};
}

}  // namespace

/// Reads the picture as neve info does, and its pixels as neve compare does.
void read_picture(std::span<const std::uint8_t> given) {
  const Bytes bytes = with_right_checksums(given);
  try_picture([&] { record::picture_record_of(render::read_png_text(bytes), "picture.png"); });
  try_picture([&] { render::decode_png(bytes, room); });
}

/// Reads the picture as neve info does, and its channels as neve render does with a plate.
void read_exr(std::span<const std::uint8_t> bytes) {
  try_picture([&] { record::picture_record_of(render::read_exr_text(bytes), "picture.exr"); });
  try_picture([&] {
    const render::ExrPicture picture = render::decode_exr(bytes, room);
    for (const render::ExrChannel& channel : picture.channels)
      require(render::numbers_of(channel).size() ==
              static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  });
}

/// A plate of a camera.
void read_jpeg(std::span<const std::uint8_t> bytes) {
  try_picture([&] { render::decode_jpeg(bytes, room); });
}

/// The look of a house, laid over a pixel.
void read_lut(std::span<const std::uint8_t> bytes) {
  try_picture([&] {
    render::Image image{1, 1, 3, {0, 128, 255}};
    render::apply(render::parse_cube(text_of(bytes), "look.cube"), image);
  });
}

std::vector<Bytes> pictures() {
  record::PictureRecord record;
  record.scene = picture_scene;
  record.overrides = {"material.snow.hardening=5"};
  record.view = "particles";
  record.state_hash = "0123456789abcdef";
  record.quality = "preview";
  const render::Image image{2, 2, 3, std::vector<std::uint8_t>(12, 100)};
  std::vector<Bytes> list{render::encode_png(image, record::to_png_text(record)),
                          render::encode_png(image)};
  // A kind of fault each.
  for (const auto& [key, value] :
       {std::pair{"files", R"({"/x/proc/self/pagemap":"0","a/a/a/b":"0"})"},
        {"frame", "2147483647"},
        {"coarsen", "inf"},
        {"changes", R"([{"step":0,"address":"solver.gravity","value":"[0, 1, 0]"}])"},
        {"strip", R"({"times":[0,0.01],"columns":1,"width":16384})"}}) {
    render::PngText text = record::to_png_text(record);
    text[std::string("neve:") + key] = value;
    list.push_back(render::encode_png(image, text));
  }
  return list;
}

std::vector<Bytes> exr_pictures() {
  render::ExrHeader header;
  record::PictureRecord record;
  record.scene = picture_scene;
  record.view = "particles";
  header.text = record::to_png_text(record);
  header.fps = 24;
  header.to_camera.emplace().fill(0.5f);
  std::vector<Bytes> list{render::encode_exr(small_exr(3, 2), header),
                          render::encode_exr(small_exr(40, 37))};
  // A window of billions of pixels, and an attribute of billions of bytes.
  for (const auto& [word, skip] : {std::pair{"dataWindow", 8u}, {"oiio:ColorSpace", 0u}}) {
    Bytes bytes = list.back();
    const std::string name = word;
    const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
    const std::int32_t vast = 1 << 29;
    const auto place = static_cast<std::size_t>(at - bytes.begin()) + name.size() + 1 +
                       (skip > 0 ? 6 + 4 + skip : 7);
    std::memcpy(bytes.data() + place, &vast, sizeof vast);
    list.push_back(bytes);
  }
  return list;
}

std::vector<Bytes> jpeg_pictures() {
  if (!render::can_encode_jpeg()) return {};
  render::Image image{17, 9, 3, {}};
  for (int i = 0; i < 17 * 9 * 3; ++i) image.pixels.push_back(static_cast<std::uint8_t>(37 * i));
  return {render::encode_jpeg(image, 90, true), render::encode_jpeg(image, 30, false)};
}

}  // namespace neve::test::fuzz
