#include "render/snow/batch.h"

#include <algorithm>
#include <cmath>

#include "render/cpu/lane_math.h"
#include "render/light/shading_constants.h"
#include "render/snow/grain_noise.h"

namespace neve::render::snow {

namespace {

/// Encodes a colour without light for the G-buffer: square roots as bytes, red lowest.
unsigned root_word(Vec3f color) {
  const auto byte = [](float c) {
    return static_cast<unsigned>(255 * std::sqrt(std::clamp(c, 0.0f, 1.0f)) + 0.5f);
  };
  return byte(color.x) | byte(color.y) << 8 | byte(color.z) << 16 | 0xff000000u;
}

/// Part of the look of the second grain: half of it where both are equally near.
/// @param spacing  m
template <class V>
NEVE_INLINE V part_of_second(V first_squared, V second_squared, float spacing) {
  constexpr float blend = 0.35f;  // spacings over which one grain goes over into the next
  const V between =
      (square_root_lanes(second_squared) - square_root_lanes(first_squared)) / spacing;
  const V t = cpu::unit_lanes(between / blend);
  return 0.5f * (1 - t * t * (3 - 2 * t));
}

}  // namespace

Batch::Batch(const Body& body, const SnowLight& light, const cpu::DrawKernels& kernels,
             light::GBufferTile& tile, light::LitTile* lit)
    : body_(body), light_(light), kernels_(kernels), tile_(tile), lit_(lit) {}

void Batch::finish() {
  if (count_ == 0) return;
  mix_exposures();
  find_grains();
  look_at_grains();
  light_samples();
  count_ = cells_ = 0;
}

void Batch::mix_exposures() {
  kernels_.mix_exposures(
      {cells_,
       corner_,
       row_,
       slice_,
       {part_[0].at, part_[1].at, part_[2].at},
       of_cell_,
       {normal_[0].at, normal_[1].at, normal_[2].at, sun_.at, sky_.at, crevice_.at, through_.at}});
}

void Batch::find_grains() {
  const GrainList& grains = body_.grains;
  kernels_.find_nearest({count_,
                         block_,
                         {node_[0].at, node_[1].at, node_[2].at},
                         {world_[0].at, world_[1].at, world_[2].at},
                         reinterpret_cast<const std::uint32_t(*)[27]>(body_.field.near.data()),
                         grains.first.data(),
                         {grains.along[0].data(), grains.along[1].data(), grains.along[2].data()},
                         nearest_,
                         second_,
                         nearest_squared_.at,
                         second_squared_.at});
}

/// Looks at the grains. Lanes beyond the samples take the first grain, so that vectors are whole.
void Batch::look_at_grains() {
  if (body_.grains.grain.empty()) {
    for (int n = 0; n < count_; ++n) without_grain(n);
    return;
  }
  look_at_nearest();
  mix_in_second();
}

void Batch::without_grain(int n) {
  set(slope_, n, {});
  set(facet_, n, {});
  height_.at[n] = 0;
}

cpu::GrainLookJob Batch::look_job(int count, const std::uint32_t* grain, Vectors& world,
                                  const Numbers& sample_size, Vectors& albedo, Vectors& slope,
                                  Numbers& height) const {
  const GrainNoise& noise = grain_noise();
  return {count,
          body_.spacing,
          body_.grains.grain.data(),
          {noise.texels(0), noise.texels(1), noise.texels(2)},
          grain,
          {world[0].at, world[1].at, world[2].at},
          sample_size.at,
          0,
          {albedo[0].at, albedo[1].at, albedo[2].at},
          {slope[0].at, slope[1].at, slope[2].at},
          height.at,
          {}};
}

void Batch::look_at_nearest() {
  std::uint32_t grain[size];
  int without[size], missing = 0;
  Vec3f albedo[size];
  for (int n = 0; n < count_; ++n) {
    const bool has_grain = nearest_[n] != surface::no_block;
    grain[n] = has_grain ? nearest_[n] : 0;
    without[missing] = n;
    albedo[missing] = {albedo_[0].at[n], albedo_[1].at[n], albedo_[2].at[n]};
    missing += has_grain ? 0 : 1;
  }
  std::fill(grain + count_, grain + size, 0u);
  cpu::GrainLookJob job = look_job(count_, grain, world_, sample_size_, albedo_, slope_, height_);
  job.wants_facets = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) job.facet[axis] = facet_[axis].at;
  kernels_.look_at_grains(job);
  for (int m = 0; m < missing; ++m) {
    set(albedo_, without[m], albedo[m]);
    without_grain(without[m]);
  }
}

/// Goes over into the look of the second grain, where that is nearly as near.
void Batch::mix_in_second() {
  int sample[size], count = 0;
  std::uint32_t grain[size];
  float part[size];
  Vectors world, albedo, slope;
  Numbers sample_size, height, part_of;
  using V = Lanes<float, 4>;
  for (int n = 0; n < count_; n += lane_count<V>)
    store_lanes(part_of_second(load_lanes<V>(nearest_squared_.at + n),
                               load_lanes<V>(second_squared_.at + n), body_.spacing),
                part_of.at + n);
  for (int n = 0; n < count_; ++n) {
    const float other = part_of.at[n];
    sample[count] = n;
    part[count] = other;
    grain[count] = second_[n];
    set(world, count, {world_[0].at[n], world_[1].at[n], world_[2].at[n]});
    sample_size.at[count] = sample_size_.at[n];
    count += second_[n] != surface::no_block && other > 0 ? 1 : 0;
  }
  std::fill(grain + count, grain + size, 0u);
  kernels_.look_at_grains(look_job(count, grain, world, sample_size, albedo, slope, height));
  const auto go_over = [&](Numbers& from, const Numbers& to, int m) {
    float& x = from.at[sample[m]];
    x += (to.at[m] - x) * part[m];
  };
  for (int m = 0; m < count; ++m) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      go_over(albedo_[axis], albedo[axis], m);
      go_over(slope_[axis], slope[axis], m);
    }
    go_over(height_, height, m);
  }
}

void Batch::light_samples() {
  const auto from = [](const Vectors& v) { return std::array{v[0].at, v[1].at, v[2].at}; };
  Vectors lit_sun, lit_open_sun, lit_around;
  const auto ray = from(ray_), normal = from(normal_), albedo = from(albedo_), slope = from(slope_),
             facet = from(facet_);
  kernels_.light_snow({count_,
                       light_.toward,
                       light_.key,
                       light_.ambient,
                       light_.is_value ? 1 : 0,
                       body_.spacing,
                       {ray[0], ray[1], ray[2]},
                       sample_size_.at,
                       {normal[0], normal[1], normal[2]},
                       sun_.at,
                       sky_.at,
                       crevice_.at,
                       through_.at,
                       {albedo[0], albedo[1], albedo[2]},
                       {slope[0], slope[1], slope[2]},
                       height_.at,
                       {facet[0], facet[1], facet[2]},
                       {normal_[0].at, normal_[1].at, normal_[2].at},
                       word_,
                       lit_ ? 1 : 0,
                       {lit_sun[0].at, lit_sun[1].at, lit_sun[2].at},
                       {lit_open_sun[0].at, lit_open_sun[1].at, lit_open_sun[2].at},
                       {lit_around[0].at, lit_around[1].at, lit_around[2].at}});
  for (int n = 0; n < count_; ++n) {
    const int at = sample_[n];
    tile_.kind[at] = light::kind_lit;
    tile_.normal_x[at] = normal_[0].at[n];
    tile_.normal_y[at] = normal_[1].at[n];
    tile_.normal_z[at] = normal_[2].at[n];
    tile_.albedo[at] = word_[n];
  }
  if (lit_) write_parts(lit_sun, lit_open_sun, lit_around);
}

void Batch::write_parts(const Vectors& sun, const Vectors& open_sun, const Vectors& around) const {
  for (int n = 0; n < count_; ++n) {
    const int at = sample_[n];
    lit_->albedo[at] = root_word({albedo_[0].at[n], albedo_[1].at[n], albedo_[2].at[n]});
    for (std::size_t c = 0; c < 3; ++c) {
      lit_->sun[c][at] = sun[c].at[n];
      lit_->open_sun[c][at] = open_sun[c].at[n];
      lit_->around[c][at] = around[c].at[n];
    }
  }
}

}  // namespace neve::render::snow
