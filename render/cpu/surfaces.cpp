#include "render/cpu/surfaces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/frame/ground_place.h"
#include "render/light/light_fields.h"
#include "render/light/shading_constants.h"

namespace neve::render::cpu {
namespace {

/// Memory that needs no clearing; it only grows.
template <class T>
void make_room(std::unique_ptr<T[]>& memory, std::size_t& size, std::size_t wanted) {
  if (size >= wanted) return;
  memory.reset();
  memory = std::make_unique_for_overwrite<T[]>(wanted);
  size = wanted;
}

GroundJob ground_job(const GroundPlane& ground, const Frame& frame, const View& view) {
  const GroundPlace place = place_ground(ground, frame, view);
  const auto root = [](float x) { return std::sqrt(std::max(x, 0.0f)); };
  return {lane_view(view),     place.point,
          place.normal,        place.tangent,
          place.bitangent,     {place.eye_on_grid[0], place.eye_on_grid[1]},
          place.line_spacing,  place.fade_center,
          place.fade_distance, {root(ground.color.x), root(ground.color.y), root(ground.color.z)},
          place.line_width,    ground.is_holdout ? light::kind_holdout : light::kind_ground};
}

light::LightCells light_cells(const light::LightVolume& volume, Vec3f eye) {
  // Four bytes of a cell are read at once.
  return {volume.grid.origin - eye, volume.grid.cell, volume.grid.size,
          reinterpret_cast<const unsigned*>(volume.body.data()),
          reinterpret_cast<const unsigned*>(volume.light.data())};
}

}  // namespace

light::LaneView lane_view(const View& view) {
  return {view.right,         view.up,    view.forward, view.pixels_per_slope,
          view.near_distance, view.width, view.height};
}

void SolidSamples::resize(int new_width, int new_height) {
  constexpr std::size_t past_the_end = 16;
  width = new_width;
  height = new_height;
  const std::size_t count =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + past_the_end;
  depth.resize(count);
  normal_kind.resize(4 * count);
  albedo.resize(count);
}

void Surfaces::prepare(const Frame& frame, const View& view, const Points& spheres,
                       const TileSource* over) {
  frame_ = &frame;
  over_ = over;
  view_ = lane_view(view);
  eye_ = view.eye;
  solids_ = nullptr;
  has_kept_ = false;
  lit_.clear();
  splatter_.prepare(spheres, view, pool_);
  grounds_.clear();
  for (const GroundPlane& ground : frame.grounds)
    if (is_seen_from_above(ground, view)) grounds_.push_back(ground_job(ground, frame, view));
  pitch_ = splatter_.columns() * light::tile_width;
}

void Surfaces::add_points(int tile, light::GBufferTile& out, light::LitTile* lit) {
  splatter_.draw_tile(tile, out);
  if (!over_) return;
  const int columns = splatter_.columns();
  over_->draw_tile(tile % columns * light::tile_width, tile / columns * light::tile_height, out,
                   lit);
}

void Surfaces::add_grounds(int tile, light::GBufferTile& out) const {
  const int columns = splatter_.columns();
  for (const GroundJob& job : grounds_)
    kernels_.ground_tile(job, out, tile % columns * light::tile_width,
                         tile / columns * light::tile_height);
}

void Surfaces::add_solids(int tile, light::GBufferTile& out) const {
  if (!solids_ || solids_->width == 0) return;
  const int columns = splatter_.columns();
  const int x = tile % columns * light::tile_width, y = tile / columns * light::tile_height;
  const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(solids_->width) +
                         static_cast<std::size_t>(x);
  kernels_.solid_tile(
      {view_.near_distance, solids_->depth.data() + at, solids_->normal_kind.data() + 4 * at,
       solids_->albedo.data() + at, solids_->width, std::min(light::tile_width, solids_->width - x),
       std::min(light::tile_height, solids_->height - y)},
      out);
}

void Surfaces::keep_points(bool has_parts) {
  const int count = splatter_.columns() * splatter_.rows();
  make_room(kept_, kept_size_, static_cast<std::size_t>(count));
  lit_.clear();
  if (has_parts && over_) lit_.resize(static_cast<std::size_t>(count));
  light::for_each_task(count, pool_, [&](int tile) {
    const auto at = static_cast<std::size_t>(tile);
    if (lit_.empty()) return add_points(tile, kept_[at]);
    auto lit = std::make_unique<light::LitTile>();
    add_points(tile, kept_[at], lit.get());
    if (std::ranges::find(kept_[at].kind, int{light::kind_lit}) != std::end(kept_[at].kind))
      lit_[at] = std::move(lit);
  });
  has_kept_ = true;
}

void Surfaces::keep_grounds() {
  light::for_each_task(splatter_.columns() * splatter_.rows(), pool_,
                       [&](int tile) { add_grounds(tile, kept_[static_cast<std::size_t>(tile)]); });
}

void Surfaces::keep_solids() {
  light::for_each_task(splatter_.columns() * splatter_.rows(), pool_,
                       [&](int tile) { add_solids(tile, kept_[static_cast<std::size_t>(tile)]); });
}

void Surfaces::uncover_grounds() {
  constexpr unsigned color = 0xffffff;  // without the cover
  light::for_each_task(splatter_.columns() * splatter_.rows(), pool_, [&](int task) {
    light::GBufferTile& tile = kept_[static_cast<std::size_t>(task)];
    for (int at = 0; at < light::tile_samples; ++at)
      if (tile.kind[at] == light::kind_ground) tile.albedo[at] &= color;
  });
}

/// Index of the tile's lower left sample in the picture.
std::size_t Surfaces::corner_of(int tile) const {
  const int columns = splatter_.columns();
  return static_cast<std::size_t>(tile / columns * light::tile_height) *
             static_cast<std::size_t>(pitch_) +
         static_cast<std::size_t>(tile % columns * light::tile_width);
}

void Surfaces::write_depth(int tile, const light::GBufferTile& from) {
  float* to = depth_.get() + corner_of(tile);
  for (int y = 0; y < light::tile_height; ++y, to += pitch_) {
    const float* row = from.inverse + y * light::tile_width;
    for (int x = 0; x < light::tile_width; ++x)
      to[x] = std::max(1 - view_.near_distance * row[x], 0.0f);
  }
}

ShadeJob Surfaces::shade_job(const light::LightVolume& light,
                             const light::SmokeCover* smoke) const {
  ShadeJob job{};
  job.view = view_;
  job.light = light_cells(light, eye_);
  job.toward_light = light::toward_light(frame_->light);
  job.key_intensity = frame_->light.intensity;
  job.ambient_intensity = frame_->light.ambient;
  job.holdout_key_intensity = job.key_intensity;
  job.holdout_ambient_intensity = job.ambient_intensity;
  job.is_transparent = frame_->is_transparent ? 1 : 0;
  job.smoke = smoke;
  job.pitch = pitch_;
  return job;
}

void Surfaces::shade_linear(const light::LightVolume& light, const light::SmokeCover* smoke,
                            Parts parts, LinearSamples& out) const {
  const int columns = splatter_.columns(), count = columns * splatter_.rows();
  const std::size_t samples = static_cast<std::size_t>(count) * light::tile_samples;
  out.pitch = pitch_;
  for (std::vector<float>& plane : out.color) plane.resize(samples);
  out.cover.resize(samples);
  ShadeJob job = shade_job(light, smoke);
  if (!parts.has_sun) job.key_intensity = 0;
  if (!parts.has_sky) job.ambient_intensity = 0;
  if (parts.has_lit_holdouts) {
    job.holdout_key_intensity = job.key_intensity;
    job.holdout_ambient_intensity = job.ambient_intensity;
  }
  job.lit_sun = parts.has_sun && !parts.is_open ? 1 : 0;
  job.lit_open_sun = parts.has_sun && parts.is_open ? 1 : 0;
  job.lit_around = parts.has_sky ? 1 : 0;
  light::for_each_task(count, pool_, [&](int tile) {
    ShadeJob mine = job;
    mine.tile = &kept_[static_cast<std::size_t>(tile)];
    mine.lit = kept_parts(tile);
    mine.x = tile % columns * light::tile_width;
    mine.y = tile / columns * light::tile_height;
    for (std::size_t c = 0; c < 3; ++c) mine.linear[c] = out.color[c].data() + corner_of(tile);
    mine.cover = out.cover.data() + corner_of(tile);
    kernels_.shade_tile(mine);
  });
}

void Surfaces::shade(const light::LightVolume& light, const light::SmokeCover* smoke,
                     bool wants_depth) {
  const int columns = splatter_.columns(), count = columns * splatter_.rows();
  const std::size_t samples = static_cast<std::size_t>(count) * light::tile_samples;
  make_room(picture_, picture_size_, samples);
  if (wants_depth) make_room(depth_, depth_size_, samples);
  const ShadeJob job = shade_job(light, smoke);
  light::for_each_task(count, pool_, [&](int tile) {
    light::GBufferTile drawn;
    ShadeJob mine = job;
    mine.tile = &drawn;
    if (has_kept_) {
      mine.tile = &kept_[static_cast<std::size_t>(tile)];
    } else {
      add_points(tile, drawn);
      add_grounds(tile, drawn);
      add_solids(tile, drawn);
    }
    mine.x = tile % columns * light::tile_width;
    mine.y = tile / columns * light::tile_height;
    mine.out = picture_.get() + corner_of(tile);
    kernels_.shade_tile(mine);
    if (wants_depth) write_depth(tile, *mine.tile);
  });
}

}  // namespace neve::render::cpu
