#include "render/snow/batch.h"

#include <algorithm>
#include <cmath>

#include "render/light/shading_constants.h"

namespace neve::render::snow {

namespace {

/// As the G-buffer has colours without light: square roots as bytes, red lowest.
unsigned root_word(Vec3f color) {
  const auto byte = [](float c) {
    return static_cast<unsigned>(255 * std::sqrt(std::clamp(c, 0.0f, 1.0f)) + 0.5f);
  };
  return byte(color.x) | byte(color.y) << 8 | byte(color.z) << 16 | 0xff000000u;
}

}  // namespace

Batch::Batch(const Body& body, const SnowLight& light, const cpu::DrawKernels& kernels,
             light::GBufferTile& tile, light::LitTile* lit)
    : body_(body), light_(light), kernels_(kernels), tile_(tile), lit_(lit) {}

void Batch::finish() {
  if (count_ == 0) return;
  find_grains();
  look_at_grains();
  light_samples();
  count_ = 0;
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

/// First a list of all grains that are looked at, then their looks: without a decision in between,
/// many are on their way at the same time.
void Batch::look_at_grains() {
  int sample[2 * size], looks = 0;
  std::uint32_t grain[2 * size];
  float part[2 * size];
  for (int n = 0; n < count_; ++n) {
    const float other =
        part_of_second(nearest_squared_.at[n], second_squared_.at[n], body_.spacing);
    const bool has_first = nearest_[n] != surface::no_block,
               has_second = second_[n] != surface::no_block && other > 0;
    set(slope_, n, {});
    set(facet_, n, {});
    height_.at[n] = 0;
    sample[looks] = n;
    grain[looks] = nearest_[n];
    part[looks] = 1;
    looks += has_first ? 1 : 0;
    sample[looks] = n;
    grain[looks] = second_[n];
    part[looks] = other;
    looks += has_second ? 1 : 0;
  }
  GrainLook look[2 * size];
  for (int l = 0; l < looks; ++l) {
    const int n = sample[l];
    const float pixels = body_.spacing / sample_size_.at[n];
    look[l] = look_of_grain(body_, {world_[0].at[n], world_[1].at[n], world_[2].at[n]}, pixels,
                            part[l] == 1 && pixels > least_sparkling, grain[l]);
  }
  for (int l = 0; l < looks; ++l) mix_in(look[l], part[l], sample[l]);
}

/// Goes over from the look of a sample into this one.
void Batch::mix_in(const GrainLook& look, float part, int n) {
  const auto go_over = [&](Vectors& of, Vec3f to) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float& from = of[axis].at[n];
      from += (to[static_cast<int>(axis)] - from) * part;
    }
  };
  if (part == 1) {
    set(albedo_, n, look.albedo);
    set(slope_, n, look.slope);
    set(facet_, n, look.facet);
    height_.at[n] = look.height;
  } else {
    go_over(albedo_, look.albedo);
    go_over(slope_, look.slope);
    height_.at[n] += (look.height - height_.at[n]) * part;
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
