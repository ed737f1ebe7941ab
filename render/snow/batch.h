#pragma once
/// Samples of snow in a tile on their way to its light: side by side, as the kernels want them.

#include <array>

#include "render/cpu/draw_kernels.h"
#include "render/light/gbuffer_tile.h"
#include "render/snow/exposed_nodes.h"

namespace neve::render::snow {

class Batch {
 public:
  /// All outlive it. @param tile  gets the light @param lit  gets it in parts; may be null
  Batch(const Body& body, const SnowLight& light, const cpu::DrawKernels& kernels,
        light::GBufferTile& tile, light::LitTile* lit);
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  /// @param at        sample of the tile
  /// @param ray       from the eye
  /// @param exposure  its normal need not be a unit
  /// @param albedo    linear, where no grain is near
  NEVE_INLINE void add(int at, Vec3f ray, const SnowPlace& place, const Exposure& exposure,
                       Vec3f albedo);
  /// The same for a place on the surface, whose exposure is interpolated.
  NEVE_INLINE void add(int at, Vec3f ray, const SnowPlace& place, const ExposedCell& cell);
  /// Lights those that were added.
  void finish();

 private:
  static constexpr int size = 64;
  static_assert(size % cpu::max_light_lanes == 0);
  struct alignas(64) Numbers {
    float at[size]{};  ///< whole vectors are read, those beyond the last sample too
  };
  using Vectors = std::array<Numbers, 3>;

  static NEVE_INLINE void set(Vectors& to, int n, Vec3f v) {
    to[0].at[n] = v.x;
    to[1].at[n] = v.y;
    to[2].at[n] = v.z;
  }
  NEVE_INLINE int add_place(int at, Vec3f ray, const SnowPlace& place);
  void mix_exposures();
  void find_grains();
  void look_at_grains();
  void look_at_nearest();
  void mix_in_second();
  void without_grain(int n);
  cpu::GrainLookJob look_job(int count, const std::uint32_t* grain, Vectors& world,
                             const Numbers& sample_size, Vectors& albedo, Vectors& slope,
                             Numbers& height) const;
  void light_samples();
  void write_parts(const Vectors& sun, const Vectors& open_sun, const Vectors& around) const;

  const Body& body_;
  const SnowLight& light_;
  const cpu::DrawKernels& kernels_;
  light::GBufferTile& tile_;
  light::LitTile* lit_;
  int count_ = 0, cells_ = 0;
  const float* corner_[size];
  int row_[size], slice_[size], of_cell_[size];
  Vectors part_;
  int sample_[size];
  std::uint32_t block_[size], nearest_[size], second_[size], word_[size];
  Numbers nearest_squared_, second_squared_;
  Vectors ray_, world_, node_, normal_, albedo_, slope_, facet_;
  Numbers sample_size_, sun_, sky_, crevice_, through_, height_;
};

int Batch::add_place(int at, Vec3f ray, const SnowPlace& place) {
  const int n = count_++;
  sample_[n] = at;
  block_[n] = place.block;
  set(ray_, n, ray);
  set(world_, n, place.world);
  set(node_, n, place.node);
  sample_size_.at[n] = place.sample_size;
  return n;
}

void Batch::add(int at, Vec3f ray, const SnowPlace& place, const ExposedCell& cell) {
  const int n = add_place(at, ray, place), m = cells_++;
  corner_[m] = reinterpret_cast<const float*>(cell.corner);
  row_[m] = cell.row * cpu::exposure_numbers;
  slice_[m] = cell.slice * cpu::exposure_numbers;
  of_cell_[m] = n;
  set(part_, m, cell.part);
  set(albedo_, n, {1, 1, 1});
  if (count_ == size) finish();
}

void Batch::add(int at, Vec3f ray, const SnowPlace& place, const Exposure& exposure, Vec3f albedo) {
  const int n = add_place(at, ray, place);
  set(normal_, n, exposure.normal);
  set(albedo_, n, albedo);
  sun_.at[n] = exposure.sun;
  sky_.at[n] = exposure.sky;
  crevice_.at[n] = exposure.crevice;
  through_.at[n] = exposure.through;
  if (count_ == size) finish();
}

}  // namespace neve::render::snow
