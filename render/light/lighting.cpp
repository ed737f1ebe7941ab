#include "render/light/lighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "render/light/light_fields.h"
#include "sim/base/lanes.h"

namespace neve::render::light {
namespace {

// Extinction per cell of packed snow. Less for the sky, whose light also comes around corners.
constexpr float key_extinction = 0.55f, sky_extinction = 0.36f, solid_extinction = 8.0f;

/// The sky is sampled straight above and on three sides 37 degrees up; the mean represents all of
/// it.
constexpr std::array<Vec3f, 4> sky_directions = {
    {{0.01f, 0.9999f, 0.01f}, {0.8f, 0.6f, 0}, {-0.4f, 0.6f, 0.693f}, {-0.4f, 0.6f, -0.693f}}};

/// One slice of the extinction of the key light and of the sky.
void fill_extinction(const std::vector<float>& solid, std::size_t begin, std::size_t end,
                     LightBuffers& buffers) {
  for (std::size_t i = begin; i < end; ++i) {
    buffers.key[i] = key_extinction * buffers.density[i];
    buffers.sky[i] = sky_extinction * buffers.density[i];
  }
  if (solid.empty()) return;
  for (std::size_t i = begin; i < end; ++i) {
    buffers.key[i] += solid_extinction * solid[i];
    buffers.sky[i] += solid_extinction * solid[i];
  }
}

// Four cells at a time; the compiler finds branches here that it cannot take out of a loop.
using V = Lanes<float, 4>;
using I = MaskOf<V>;

/// Signed bytes of -1 to 1, in the lowest 8 bits.
I to_snorm(V x) {
  const V scaled = 127.0f * smaller_lanes(larger_lanes(x, all<V>(-1)), all<V>(1));
  const V half = scaled < V{} ? all<V>(-0.5f) : all<V>(0.5f);
  return __builtin_convertvector(scaled + half, I) & 0xff;
}

I to_unorm(V x) {
  const V scaled = 65535.0f * smaller_lanes(larger_lanes(x, V{}), all<V>(1));
  return __builtin_convertvector(scaled + 0.5f, I);
}

/// Rows of densities around the one in question, each with an empty cell at both ends.
struct Neighbours {
  const float *row, *below, *above, *before, *behind;
};

/// One row of bodies: the direction in which density falls. Its length, up to 1, is the certainty.
/// @param count a multiple of four
void fill_body_row(const Neighbours& at, std::size_t count, std::uint32_t* body) {
  for (std::size_t i = 1; i <= count; i += 4) {
    const V x = load_lanes<V>(at.row + i - 1) - load_lanes<V>(at.row + i + 1);
    const V y = load_lanes<V>(at.below + i) - load_lanes<V>(at.above + i);
    const V z = load_lanes<V>(at.before + i) - load_lanes<V>(at.behind + i);
    const V steepness = square_root_lanes(x * x + y * y + z * z);
    const V scale =
        smaller_lanes(6 * steepness, all<V>(1)) / larger_lanes(steepness, all<V>(1e-30f));
    const I packed = to_snorm(x * scale) | to_snorm(y * scale) << 8 | to_snorm(z * scale) << 16 |
                     to_snorm(load_lanes<V>(at.row + i)) << 24;
    std::memcpy(body + i - 1, &packed, sizeof packed);
  }
}

/// Bodies of one slice; outside the grid there is nothing.
void fill_body(const std::vector<float>& smooth, const LightGrid& grid, int k,
               std::vector<std::int8_t>& body) {
  const std::size_t count = (static_cast<std::size_t>(grid.size.x) + 3) / 4 * 4, pitch = count + 2;
  std::vector<float> padded(5 * pitch);
  std::vector<std::uint32_t> packed(pitch);
  for (int j = 0; j < grid.size.y; ++j) {
    const auto copy_row = [&](std::size_t to, int y, int z) {
      float* out = padded.data() + to * pitch + 1;
      if (y < 0 || z < 0 || y >= grid.size.y || z >= grid.size.z) {
        std::fill_n(out, grid.size.x, 0.0f);
        return;
      }
      std::copy_n(smooth.data() + (static_cast<std::ptrdiff_t>(z) * grid.size.y + y) * grid.size.x,
                  grid.size.x, out);
    };
    copy_row(0, j, k);
    copy_row(1, j - 1, k);
    copy_row(2, j + 1, k);
    copy_row(3, j, k - 1);
    copy_row(4, j, k + 1);
    const float* p = padded.data();
    fill_body_row({p, p + pitch, p + 2 * pitch, p + 3 * pitch, p + 4 * pitch}, count,
                  packed.data());
    std::memcpy(body.data() + 4 * (static_cast<std::ptrdiff_t>(k) * grid.size.y + j) * grid.size.x,
                packed.data(), 4 * static_cast<std::size_t>(grid.size.x));
  }
}

/// Key light and mean of the sky, of four cells.
I packed_light(const std::array<const float*, 5>& from, std::size_t i) {
  const auto at = [&](std::size_t n) { return load_lanes<V>(from[n] + i); };
  return to_unorm(at(0)) | to_unorm(0.25f * ((at(1) + at(2)) + (at(3) + at(4)))) << 16;
}

void fill_light(const LightBuffers& buffers, std::size_t begin, std::size_t end,
                std::uint16_t* light) {
  std::array<const float*, 5> from;
  for (std::size_t n = 0; n < 5; ++n) from[n] = buffers.arriving[n].data();
  std::size_t i = begin;
  for (; i + 4 <= end; i += 4) {
    const I packed = packed_light(from, i);
    std::memcpy(light + 2 * i, &packed, sizeof packed);
  }
  if (i == end) return;
  std::array<std::array<float, 4>, 5> rest{};
  for (std::size_t n = 0; n < 5; ++n) {
    std::copy(from[n] + i, from[n] + end, rest[n].begin());
    from[n] = rest[n].data();
  }
  const I packed = packed_light(from, 0);
  std::memcpy(light + 2 * i, &packed, 4 * (end - i));
}

LightInputs inputs_of(const Frame& frame, const SmokeGrid& smoke) {
  LightInputs inputs;
  inputs.points.position = frame.points.position;
  inputs.points.spacing = frame.points.spacing;
  for (const TriangleMesh& mesh : frame.meshes)
    if (!mesh.is_holdout) inputs.meshes.push_back({mesh.position, {}, mesh.index});
  inputs.smoke = smoke;
  inputs.toward_light = toward_light(frame.light);
  return inputs;
}

void fill_volume(const LightInputs& in, ThreadPool* pool, LightBuffers& buffers,
                 LightVolume& volume) {
  const LightGrid& grid = volume.grid = fit_light_grid(in.points, in.meshes, in.smoke, pool);
  bin_points(in.points, grid, pool, buffers);
  if (!in.smoke.is_empty()) add_smoke(in.smoke, grid, pool, buffers.density);
  const std::vector<float> solid =
      in.meshes.empty() ? std::vector<float>{} : voxelize(in.meshes, grid);
  const std::size_t slice =
      static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y);
  buffers.key.resize(grid.count());
  buffers.sky.resize(grid.count());
  for_each_task(grid.size.z, pool, [&](int k) {
    const std::size_t begin = slice * static_cast<std::size_t>(k);
    fill_extinction(solid, begin, begin + slice, buffers);
  });

  // Sweeps are independent of one another: one task each, so that no slice needs a barrier.
  for_each_task(5, pool, [&](int task) {
    const auto t = static_cast<std::size_t>(task);
    sweep_light(t == 0 ? buffers.key : buffers.sky, grid,
                t == 0 ? in.toward_light : sky_directions[t - 1], buffers.arriving[t]);
  });

  blur(grid, pool, buffers);
  volume.body.resize(4 * grid.count());
  volume.light.resize(2 * grid.count());
  for_each_task(grid.size.z, pool, [&](int k) {
    const std::size_t begin = slice * static_cast<std::size_t>(k);
    fill_body(buffers.smooth, grid, k, volume.body);
    fill_light(buffers, begin, begin + slice, volume.light.data());
  });
}

}  // namespace

Vec3f toward_light(const Light& light) {
  const Vec3f direction = normalized(light.direction);
  return length(direction) > 0.5f ? direction : Vec3f{0, 1, 0};
}

LightVolume make_light_volume(const Frame& frame, const SmokeGrid& smoke, ThreadPool* pool) {
  LightBuffers buffers;
  LightVolume volume;
  fill_volume(inputs_of(frame, smoke), pool, buffers, volume);
  return volume;
}

Lighting::Lighting() = default;
Lighting::~Lighting() = default;

const LightVolume& Lighting::volume(const Frame& frame, const SmokeGrid& smoke, ThreadPool* pool) {
  LightInputs inputs = inputs_of(frame, smoke);
  if (inputs_ == inputs) return volume_;
  if (!buffers_) buffers_ = std::make_unique<LightBuffers>();
  const std::uint64_t serial = volume_.serial + 1;
  inputs_.reset();  // should something throw, there is no volume
  fill_volume(inputs, pool, *buffers_, volume_);
  volume_.serial = serial;
  inputs_ = std::move(inputs);
  return volume_;
}

}  // namespace neve::render::light
