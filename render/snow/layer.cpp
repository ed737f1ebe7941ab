#include "render/snow/layer.h"

#include <algorithm>

#include "render/light/light_fields.h"
#include "render/light/shading_constants.h"
#include "render/snow/batch.h"

namespace neve::render::snow {

namespace {

Vec3f albedo_of(unsigned word) {
  const auto byte = [&](int shift) { return static_cast<float>(word >> shift & 0xff) / 255; };
  return {byte(0) * byte(0), byte(8) * byte(8), byte(16) * byte(16)};
}

}  // namespace

void Layer::prepare(const Frame& frame, const View& view, const light::LightVolume& volume,
                    ThreadPool* pool) {
  marcher_.reset();
  const SnowLight light = {light::toward_light(frame.light), frame.light.intensity,
                           frame.light.ambient, !frame.points.value.empty()};
  const bool has_body = points_ == frame.points && grounds_ == frame.grounds;
  const bool has_nodes = has_body && nodes_ && volume.serial != 0 && volume.serial == serial_ &&
                         light.toward == light_.toward;
  if (!has_body) {
    points_.reset();  // should something throw, there is no body
    body_ = make_body(frame.points, frame.grounds, pool);
    points_ = frame.points;
    grounds_ = frame.grounds;
  }
  view_ = &view;
  grain_size_ = 1 / (view.pixels_per_slope * static_cast<float>(frame.grain_detail));
  volume_ = &volume;
  light_ = light;
  if (!has_nodes) {
    nodes_.reset();
    nodes_.emplace(body_);
    serial_ = volume.serial;
  }
  marcher_.emplace(body_, view);
  march(pool);
  nodes_->expose_wanted(body_, volume, light, pool);
}

/// Meets the surface, so that what is seen of it can be lit.
void Layer::march(ThreadPool* pool) {
  columns_ = (view_->width + light::tile_width - 1) / light::tile_width;
  const int rows = (view_->height + light::tile_height - 1) / light::tile_height;
  hits_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows));
  light::for_each_task(columns_ * rows, pool, [&](int task) {
    const int x = task % columns_ * light::tile_width, y = task / columns_ * light::tile_height;
    TileHits& hits = hits_[static_cast<std::size_t>(task)];
    marcher_->march_tile(x, y, hits);
    for (int at = 0; at < light::tile_samples; ++at) {
      if (!(hits.distance[at] > 0)) continue;
      const Vec3f ray = marcher_->ray(x + at % light::tile_width, y + at / light::tile_width);
      nodes_->want(hits.block[at], marcher_->place_of(hits.block[at], ray * hits.distance[at]));
    }
  });
}

void Layer::draw_tile(int x, int y, light::GBufferTile& tile, light::LitTile* lit) const {
  const TileHits& hits =
      hits_[static_cast<std::size_t>(y / light::tile_height * columns_ + x / light::tile_width)];
  Batch batch(body_, light_, cpu::chosen_draw_kernels(), tile, lit);
  for (int at = 0; at < light::tile_samples; ++at) {
    const float hit = hits.distance[at];
    const bool is_sphere =
        tile.kind[at] == light::kind_snow || tile.kind[at] == light::kind_attribute;
    if (!is_sphere && !(hit > 0)) continue;
    const Sample sample{marcher_->ray(x + at % light::tile_width, y + at / light::tile_width), hit,
                        hits.block[at]};
    if (hit > 0 && !(is_sphere && hit * tile.inverse[at] >= 1))
      add_surface(sample, at, tile, batch);
    else
      add_grain(sample, at, tile, batch);
  }
  batch.finish();
}

SnowPlace Layer::place_at(const Sample& sample, float distance) const {
  SnowPlace place;
  place.sample_size = distance * grain_size_;
  place.world = view_->eye + sample.ray * distance;
  return place;
}

void Layer::add_surface(const Sample& sample, int at, light::GBufferTile& tile,
                        Batch& batch) const {
  SnowPlace place = place_at(sample, sample.hit);
  place.block = body_.padded_block[sample.padded];
  place.node = marcher_->place_of(sample.padded, sample.ray * sample.hit);
  tile.inverse[at] = 1 / sample.hit;
  batch.add(at, sample.ray, place, nodes_->cell_at(sample.padded, place.node));
}

void Layer::add_grain(const Sample& sample, int at, const light::GBufferTile& tile,
                      Batch& batch) const {
  const float distance = 1 / tile.inverse[at];
  SnowPlace place = place_at(sample, distance);
  Vec3f normal{tile.normal_x[at], tile.normal_y[at], tile.normal_z[at]};
  const FieldPlace field = find_place(body_, place.world);
  place.block = field.block;
  place.node = field.node;
  if (field.block != surface::no_block) {
    const float sure = std::min(3 * share_at(body_.field, field.block, field.node), 0.8f);
    normal =
        normalized(normal * (1 - sure) + normal_at(body_.field, field.block, field.node) * sure);
  }
  Exposure exposure = expose(body_, *volume_, light_, place, normal);
  if (sample.hit > 0) {
    // A grain that lies in the surface becomes a part of it.
    const float out = std::min((sample.hit - distance) / (0.7f * body_.spacing), 1.0f);
    const Vec3f below = normalized(
        nodes_->at(sample.padded, marcher_->place_of(sample.padded, sample.ray * sample.hit))
            .normal);
    exposure.normal = below * (1 - out) + normal * out;
  }
  const Vec3f white{1, 1, 1};
  batch.add(at, sample.ray, place, exposure,
            field.block == surface::no_block ? albedo_of(tile.albedo[at]) : white);
}

}  // namespace neve::render::snow
