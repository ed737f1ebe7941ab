#include "render/light/smoke_volume.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/frame/colormap.h"
#include "render/light/light_fields.h"
#include "render/light/shading_constants.h"

namespace neve::render::light {
namespace {

/// Interpolated light volume at a place between its cells.
struct Lit {
  Vec3f body;
  float key = 0, sky = 0;
};

/// The light volume, read with linear interpolation; beyond its edge as at its edge.
class LightReader {
 public:
  explicit LightReader(const LightVolume& volume) : volume_(volume) {}

  Lit at(Vec3f place) const {
    const LightGrid& grid = volume_.grid;
    const Vec3f x = (place - grid.origin) / grid.cell - Vec3f{0.5f, 0.5f, 0.5f};
    std::array<std::size_t, 3> low{}, high{};
    std::array<float, 3> part{};
    for (std::size_t a = 0; a < 3; ++a) {
      const int axis = static_cast<int>(a), last = grid.size[axis] - 1;
      const float clamped = std::clamp(x[axis], 0.0f, static_cast<float>(last));
      const int i = std::min(static_cast<int>(clamped), std::max(last - 1, 0));
      low[a] = static_cast<std::size_t>(i);
      high[a] = static_cast<std::size_t>(std::min(i + 1, last));
      part[a] = clamped - static_cast<float>(i);
    }
    const std::size_t row = static_cast<std::size_t>(grid.size.x),
                      slice = row * static_cast<std::size_t>(grid.size.y);
    std::array<float, 3> body{};
    float key = 0, sky = 0;
    for (std::size_t n = 0; n < 8; ++n) {
      const bool is_x = n & 1, is_y = n & 2, is_z = n & 4;
      const float w = (is_x ? part[0] : 1 - part[0]) * (is_y ? part[1] : 1 - part[1]) *
                      (is_z ? part[2] : 1 - part[2]);
      const std::size_t i = (is_z ? high[2] : low[2]) * slice + (is_y ? high[1] : low[1]) * row +
                            (is_x ? high[0] : low[0]);
      const std::int8_t* from = volume_.body.data() + 4 * i;
      const std::uint16_t* light = volume_.light.data() + 2 * i;
      for (std::size_t a = 0; a < 3; ++a) body[a] += w * static_cast<float>(from[a]);
      key += w * static_cast<float>(light[0]);
      sky += w * static_cast<float>(light[1]);
    }
    constexpr float per_body = 1.0f / 127, per_light = 1.0f / 65535;
    return {per_body * Vec3f{body[0], body[1], body[2]}, per_light * key, per_light * sky};
  }

 private:
  const LightVolume& volume_;
};

/// Light that leaves a texel towards the eye, as fractions of the light on open smoke.
struct Glow {
  float key, sky, inside;
};

/// Light goes deeper into snow than shadows suggest, because most of it is scattered on, not
/// swallowed: the powers below. The surface of a body is lit by its slope, like a
/// matte surface. @param contrast below 1 lifts shadows, so that colours stay readable
Glow glow(const Lit& lit, Vec3f toward_light, float contrast) {
  const float certainty = std::min(length(lit.body), 1.0f);
  const Vec3f n = normalized(lit.body);
  constexpr float wrap = 0.4f;
  const float facing = std::max(0.0f, (dot(n, toward_light) + wrap) / (1 + wrap));
  const float slope = 1 + contrast * certainty * (facing - 1);
  const float key = std::pow(lit.key, 0.5f * contrast);
  const float sky =
      std::pow(lit.sky, 0.9f * contrast) * (1 + 0.3f * contrast * certainty * (n.y - 1));
  return {slope * key, sky, std::pow(lit.key, 0.15f)};
}

void mark_bricks(const SmokeGrid& grid, SmokeVolume& volume) {
  constexpr int side = brick_side;
  for (int axis = 0; axis < 3; ++axis) volume.brick_count[axis] = (grid.size[axis] - 1) / side + 1;
  const Vec3i count = volume.brick_count;
  volume.bricks.assign(static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) *
                           static_cast<std::size_t>(count.z),
                       0);
  // A texel on the face between two bricks counts for both.
  const auto first = [](int i) { return i > 0 && i % side == 0 ? i / side - 1 : i / side; };
  for (int z = 0; z < grid.size.z; ++z) {
    for (int y = 0; y < grid.size.y; ++y) {
      const float* row = grid.opacity.data() + grid.index(0, y, z);
      for (int x = 0; x < grid.size.x; ++x) {
        if (!(row[x] > 0)) continue;
        for (int c = first(z); c <= z / side; ++c) {
          for (int b = first(y); b <= y / side; ++b) {
            for (int a = first(x); a <= x / side; ++a)
              volume.bricks[static_cast<std::size_t>((c * count.y + b) * count.x + a)] = 255;
          }
        }
      }
    }
  }
}

}  // namespace

SmokeVolume make_smoke_volume(const SmokeGrid& grid, const LightVolume& light, Vec3f toward_light,
                              ThreadPool* pool) {
  SmokeVolume volume;
  volume.texels.resize(4 * grid.opacity.size());
  mark_bricks(grid, volume);
  const LightReader reader(light);
  const std::vector<float>&opacities = grid.opacity, &values = grid.value;
  const bool has_values = !values.empty();
  const float contrast = has_values ? 0.6f : 1.0f;
  for_each_task(grid.size.z, pool, [&](int z) {
    for (int y = 0; y < grid.size.y; ++y) {
      for (int x = 0; x < grid.size.x; ++x) {
        const std::size_t i = grid.index(x, y, z);
        const float opacity = opacities[i];
        if (!(opacity > 0)) continue;
        const Vec3f at = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        const Glow g = glow(reader.at(grid.origin + grid.spacing * at), toward_light, contrast);
        float* out = volume.texels.data() + 4 * i;
        out[0] = opacity;
        out[1] = opacity * g.key;
        out[2] = opacity * g.sky;
        out[3] = has_values ? values[i] : opacity * g.inside;
      }
    }
  });
  return volume;
}

std::vector<float> linear_colors(ColorMap map) {
  std::vector<float> colors;
  for (int i = 0; i < colormap_width; ++i) {
    const Rgb8 color = map_color(map, static_cast<float>(i) / (colormap_width - 1));
    for (const std::uint8_t c : {color.r, color.g, color.b})
      colors.push_back(std::pow(static_cast<float>(c) / 255, 2.2f));
    colors.push_back(0);
  }
  return colors;
}

namespace {

/// Takes one brick into the spans of the tiles that it may touch.
void add_brick(const SmokeGrid& grid, Vec3i brick, const View& view, SmokeSpans& spans) {
  constexpr float huge = 1e9f;
  float left = huge, right = -huge, bottom = huge, top = -huge, near = huge * huge, far = 0;
  bool is_at_eye = false;
  for (int n = 0; n < 8; ++n) {
    const Vec3f corner = {static_cast<float>(brick_side * (brick.x + (n & 1))),
                          static_cast<float>(brick_side * (brick.y + (n >> 1 & 1))),
                          static_cast<float>(brick_side * (brick.z + (n >> 2)))};
    const Vec3f p = view.project(grid.origin + grid.spacing * corner);
    is_at_eye = is_at_eye || p.z <= view.near_distance;
    near = std::min(near, p.z);
    far = std::max(far, p.z);
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    bottom = std::min(bottom, p.y);
    top = std::max(top, p.y);
  }
  if (far <= view.near_distance) return;
  if (is_at_eye) {  // its outline on the picture has no meaning
    left = bottom = -huge;
    right = top = huge;
    near = view.near_distance;
  }
  const auto tile = [&](float sample, int count) {
    const float at = std::floor(sample / static_cast<float>(spans.tile));
    return static_cast<int>(std::clamp(at, -1.0f, static_cast<float>(count)));
  };
  spans.nearest = std::min(spans.nearest, near);
  spans.farthest = std::max(spans.farthest, far);
  const int first_column = std::max(tile(left, spans.columns), 0),
            last_column = std::min(tile(right, spans.columns), spans.columns - 1);
  const int last_row = std::min(tile(top, spans.rows), spans.rows - 1);
  for (int j = std::max(tile(bottom, spans.rows), 0); j <= last_row; ++j) {
    for (int i = first_column; i <= last_column; ++i) {
      float* span = spans.near_far.data() + 2 * (j * spans.columns + i);
      span[0] = std::min(span[0], near);
      span[1] = std::max(span[1], far);
    }
  }
}

}  // namespace

int samples_per_ray(const Smoke& smoke, const SmokeGrid& grid, const View& view) {
  if (smoke.samples_per_ray > 0) return smoke.samples_per_ray;
  constexpr float rays_per_texel = 3;  // smoke is straight between texels, its outline is not
  const Vec3f size{static_cast<float>(grid.size.x - 1), static_cast<float>(grid.size.y - 1),
                   static_cast<float>(grid.size.z - 1)};
  const float distance = view.project(grid.origin + (0.5f * grid.spacing) * size).z;
  if (!(distance > view.near_distance)) return 2;                       // the eye is in it
  const float texel = grid.spacing * view.pixels_per_slope / distance;  // samples
  return static_cast<int>(std::clamp(texel / rays_per_texel, 2.0f, 4.0f));
}

SmokeSpans make_smoke_spans(const SmokeGrid& grid, const SmokeVolume& volume, const View& view,
                            int tile) {
  constexpr float none = 1e30f;
  SmokeSpans spans;
  spans.tile = tile;
  spans.columns = (view.width + tile - 1) / tile;
  spans.rows = (view.height + tile - 1) / tile;
  spans.nearest = none;
  spans.near_far.resize(2 * static_cast<std::size_t>(spans.columns) *
                        static_cast<std::size_t>(spans.rows));
  for (std::size_t i = 0; i < spans.near_far.size(); i += 2) spans.near_far[i] = none;
  const Vec3i count = volume.brick_count;
  for (int z = 0; z < count.z; ++z) {
    for (int y = 0; y < count.y; ++y) {
      for (int x = 0; x < count.x; ++x) {
        if (volume.bricks[static_cast<std::size_t>((z * count.y + y) * count.x + x)])
          add_brick(grid, {x, y, z}, view, spans);
      }
    }
  }
  return spans;
}

}  // namespace neve::render::light
