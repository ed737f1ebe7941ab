#include "render/channels/plate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/light/shading_constants.h"

namespace neve::render::channels {
namespace {

/// Applies the tone mapping of shaders/shade.frag.
float tone_mapped(float light) {
  const float c = light * light::exposure;
  const float mapped = c * (1 + c / light::white_point) / (1 + light::shoulder * c);
  return std::pow(std::clamp(mapped, 0.0f, 1.0f), 1 / light::display_gamma);
}

/// The light that each byte of a picture is the tone-mapped one of.
std::array<float, 256> light_of_bytes() {
  std::array<float, 256> lights{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    const float y = std::pow(static_cast<float>(byte) / 255, light::display_gamma);
    const float b = 1 - light::shoulder * y;
    lights[byte] = 0.5f * light::white_point * (std::sqrt(b * b + 4 * y / light::white_point) - b) /
                   light::exposure;
  }
  return lights;
}

/// Sets what is no ground to 1, and fades shadows out with the ground.
void keep_grounds(const LitSurfaces& lit, cpu::LinearSamples& share) {
  const int columns = lit.surfaces.columns();
  const auto tiles = static_cast<int>(share.cover.size() / light::tile_samples);
  for (int tile = 0; tile < tiles; ++tile) {
    const light::GBufferTile& drawn = lit.surfaces.kept()[tile];
    for (int at = 0; at < light::tile_samples; ++at) {
      const int x = tile % columns * light::tile_width + at % light::tile_width;
      const int y = tile / columns * light::tile_height + at / light::tile_width;
      const std::size_t to = static_cast<std::size_t>(y) * static_cast<std::size_t>(share.pitch) +
                             static_cast<std::size_t>(x);
      const bool is_ground = drawn.kind[at] == light::kind_ground;
      const float left = is_ground ? share.cover[to] : 0;
      for (std::vector<float>& plane : share.color) plane[to] = 1 + left * (plane[to] - 1);
    }
  }
}

}  // namespace

cpu::LinearSamples ground_shadow(const LitSurfaces& lit) {
  cpu::LinearSamples share, open;
  lit.surfaces.shade_linear(lit.light, nullptr, {}, share);
  lit.surfaces.shade_linear(without_shadow(lit.light), nullptr, {}, open);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < share.cover.size(); ++i)
      share.color[c][i] =
          open.color[c][i] > 1e-6f ? std::min(share.color[c][i] / open.color[c][i], 1.0f) : 1.0f;
  keep_grounds(lit, share);
  return share;
}

Image lay_over_plate(const cpu::LinearSamples& front, const cpu::LinearSamples& shadow,
                     const Frame& frame, const Image& plate) {
  static const std::array<float, 256> light_of = light_of_bytes();
  const int ss = frame.supersampling;
  Image image = plate;
  std::size_t at = 0;
  for (int row = frame.height - 1; row >= 0; --row)
    for (int column = 0; column < frame.width; ++column)
      for (std::size_t c = 0; c < 3; ++c, ++at) {
        float sum = 0;
        for (int sample = 0; sample < ss * ss; ++sample) {
          const auto y = static_cast<std::size_t>(row * ss + sample / ss);
          const std::size_t i = y * static_cast<std::size_t>(front.pitch) +
                                static_cast<std::size_t>(column * ss + sample % ss);
          const float behind = light_of[plate.pixels[at]] * shadow.color[c][i];
          sum += tone_mapped(front.color[c][i] + (1 - front.cover[i]) * behind);
        }
        const float mean = sum / static_cast<float>(ss * ss);
        image.pixels[at] = static_cast<std::uint8_t>(std::lround(255 * mean));
      }
  return image;
}

}  // namespace neve::render::channels
