#include "render/lighting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/light_fields.h"

namespace neve::render {
namespace {

// Extinction per cell of packed snow. Less for the sky, whose light also comes around corners.
constexpr float key_extinction = 0.55f, sky_extinction = 0.36f, solid_extinction = 8.0f;

/// The sky is sampled straight above and on three sides 37 degrees up; the mean stands for all of
/// it.
constexpr std::array<Vec3f, 4> sky_directions = {
    {{0.01f, 0.9999f, 0.01f}, {0.8f, 0.6f, 0}, {-0.4f, 0.6f, 0.693f}, {-0.4f, 0.6f, -0.693f}}};

std::vector<float> extinction_of(const std::vector<float>& density, const std::vector<float>& solid,
                                 float snow) {
  std::vector<float> extinction(density.size());
  for (std::size_t i = 0; i < density.size(); ++i)
    extinction[i] = snow * density[i] + (solid.empty() ? 0 : solid_extinction * solid[i]);
  return extinction;
}

std::int8_t to_snorm(float x) {
  return static_cast<std::int8_t>(std::lround(127 * std::clamp(x, -1.0f, 1.0f)));
}

std::uint16_t to_unorm(float x) {
  return static_cast<std::uint16_t>(65535 * std::clamp(x, 0.0f, 1.0f) + 0.5f);
}

/// Direction in which density falls, as long as we are sure of it.
void fill_body(const std::vector<float>& smooth, const LightGrid& grid, int k,
               std::vector<std::int8_t>& body) {
  const std::ptrdiff_t row = grid.size.x, slice = row * grid.size.y;
  const auto at = [&](int i, int j, int l) {
    const bool is_inside =
        i >= 0 && j >= 0 && l >= 0 && i < grid.size.x && j < grid.size.y && l < grid.size.z;
    return is_inside ? smooth[static_cast<std::size_t>(l * slice + j * row + i)] : 0;
  };
  for (int j = 0; j < grid.size.y; ++j) {
    for (int i = 0; i < grid.size.x; ++i) {
      const Vec3f fall = {at(i - 1, j, k) - at(i + 1, j, k), at(i, j - 1, k) - at(i, j + 1, k),
                          at(i, j, k - 1) - at(i, j, k + 1)};
      const float steepness = length(fall);
      const Vec3f n = normalized(fall) * std::clamp(6 * steepness, 0.0f, 1.0f);
      std::int8_t* out = body.data() + 4 * (k * slice + j * row + i);
      out[0] = to_snorm(n.x);
      out[1] = to_snorm(n.y);
      out[2] = to_snorm(n.z);
      out[3] = to_snorm(at(i, j, k));
    }
  }
}

}  // namespace

Vec3f toward_light(const Light& light) {
  const Vec3f direction = normalized(light.direction);
  return length(direction) > 0.5f ? direction : Vec3f{0, 1, 0};
}

LightVolume make_light_volume(const Frame& frame, const SmokeGrid& smoke, ThreadPool* pool) {
  LightVolume volume;
  const LightGrid& grid = volume.grid = fit_light_grid(frame.points, frame.meshes, smoke);
  std::vector<float> density = bin_points(frame.points, grid, pool);
  if (!smoke.is_empty()) add_smoke(smoke, grid, pool, density);
  const std::vector<float> solid =
      frame.meshes.empty() ? std::vector<float>{} : voxelize(frame.meshes, grid);

  // Sweeps are independent of one another: one task each, so that no slice needs a barrier.
  const std::vector<float> key = extinction_of(density, solid, key_extinction);
  const std::vector<float> sky = extinction_of(density, solid, sky_extinction);
  std::array<std::vector<float>, 5> arriving;
  for_each_task(5, pool, [&](int task) {
    const auto t = static_cast<std::size_t>(task);
    arriving[t] = t == 0 ? sweep_light(key, grid, toward_light(frame.light))
                         : sweep_light(sky, grid, sky_directions[t - 1]);
  });

  const std::vector<float> smooth = blur(density, grid, pool);
  volume.body.resize(4 * grid.count());
  volume.light.resize(2 * grid.count());
  for_each_task(grid.size.z, pool, [&](int k) {
    fill_body(smooth, grid, k, volume.body);
    const std::size_t slice =
        static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y);
    for (std::size_t i = slice * static_cast<std::size_t>(k);
         i < slice * static_cast<std::size_t>(k + 1); ++i) {
      volume.light[2 * i] = to_unorm(arriving[0][i]);
      volume.light[2 * i + 1] =
          to_unorm(0.25f * ((arriving[1][i] + arriving[2][i]) + (arriving[3][i] + arriving[4][i])));
    }
  });
  return volume;
}

}  // namespace neve::render
