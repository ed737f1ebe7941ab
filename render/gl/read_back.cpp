#include "render/gl/read_back.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace neve::render::gl {
namespace {

/// RGBA whose colour is premultiplied to RGBA whose colour is not.
void straighten(const std::uint8_t* from, std::uint8_t* to) {
  const int alpha = from[3];
  for (int c = 0; c < 3; ++c)
    to[c] =
        alpha == 0
            ? std::uint8_t{0}
            : static_cast<std::uint8_t>(std::min(255, (255 * int{from[c]} + alpha / 2) / alpha));
  to[3] = from[3];
}

/// @param rgba premultiplied, lowest row first
Image upright(const std::uint8_t* rgba, int picture_width, int picture_height, bool has_alpha) {
  Image image{picture_width, picture_height, has_alpha ? 4 : 3, {}};
  const auto width = static_cast<std::size_t>(picture_width);
  const auto height = static_cast<std::size_t>(picture_height);
  const auto channels = static_cast<std::size_t>(image.channels);
  image.pixels.resize(channels * width * height);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* from = rgba + 4 * width * (height - 1 - y);
    std::uint8_t* to = image.pixels.data() + channels * width * y;
    for (std::size_t x = 0; x < width; ++x, from += 4, to += channels) {
      if (has_alpha) {
        straighten(from, to);
      } else {
        to[0] = from[0];
        to[1] = from[1];
        to[2] = from[2];
      }
    }
  }
  return image;
}

}  // namespace

void ReadBack::begin(int width, int height, bool has_alpha) {
  Copy copy;
  copy.width = width;
  copy.height = height;
  copy.has_alpha = has_alpha;
  const std::size_t bytes = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadBuffer(GL_COLOR_ATTACHMENT0);
  if (is_buffered_) {
    if (spare_.empty()) spare_.emplace_back(gl_);
    copy.buffer = std::move(spare_.back());
    spare_.pop_back();
    gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, copy.buffer.id());
    gl_.BufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
    gl_.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  } else {
    copy.rgba.resize(bytes);
    gl_.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, copy.rgba.data());
  }
  copies_.push_back(std::move(copy));
}

Image ReadBack::finish_oldest() {
  if (copies_.empty()) throw std::logic_error("no picture is being read back");
  Copy copy = std::move(copies_.front());
  copies_.pop_front();
  return finish(std::move(copy));
}

Image ReadBack::finish_newest() {
  if (copies_.empty()) throw std::logic_error("no picture is being read back");
  Copy copy = std::move(copies_.back());
  copies_.pop_back();
  return finish(std::move(copy));
}

Image ReadBack::finish(Copy copy) {
  if (!is_buffered_) return upright(copy.rgba.data(), copy.width, copy.height, copy.has_alpha);
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, copy.buffer.id());
  const auto bytes = static_cast<GLsizeiptr>(4) * copy.width * copy.height;
  const void* mapped = gl_.MapBufferRange(GL_PIXEL_PACK_BUFFER, 0, bytes, GL_MAP_READ_BIT);
  if (!mapped) {
    gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    throw std::runtime_error("the OpenGL driver does not return a picture that it has drawn");
  }
  Image image =
      upright(static_cast<const std::uint8_t*>(mapped), copy.width, copy.height, copy.has_alpha);
  gl_.UnmapBuffer(GL_PIXEL_PACK_BUFFER);
  gl_.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  spare_.push_back(std::move(copy.buffer));
  return image;
}

}  // namespace neve::render::gl
