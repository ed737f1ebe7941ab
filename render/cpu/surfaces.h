#pragma once
/// Draws and lights solid surfaces on the CPU, tile by tile: the picture of ParticlePass,
/// GroundPass and ShadePass, where OpenGL runs on the CPU too and is slower at it. A tile is drawn,
/// finished and lit while it is in the cache. Depends neither on the number of threads nor on the
/// instruction set.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/cpu/splat.h"
#include "render/cpu/tile_source.h"
#include "render/frame/frame.h"
#include "render/frame/view.h"
#include "render/light/lighting.h"
#include "sim/base/thread_pool.h"

namespace neve::render::cpu {

/// Contents of OpenGL's G-buffer, rows from the bottom up; see shaders/gbuffer.glsl.
struct SolidSamples {
  int width = 0, height = 0;  ///< 0: nothing
  std::vector<float> depth;
  std::vector<std::uint16_t> normal_kind;  ///< four half floats each
  std::vector<std::uint32_t> albedo;       ///< four bytes each

  /// Makes room for the samples, and some behind the last row, as lanes read past its end.
  void resize(int new_width, int new_height);
};

/// Linear light before the tone mapping, and the share of a sample that is covered; rows from the
/// bottom up, a whole number of tiles each.
struct LinearSamples {
  int pitch = 0;
  std::array<std::vector<float>, 3> color;  ///< premultiplied by cover
  std::vector<float> cover;
};

class Surfaces {
 public:
  /// @param pool may be null
  explicit Surfaces(ThreadPool* pool, const DrawKernels& kernels = chosen_draw_kernels())
      : kernels_(kernels), pool_(pool), splatter_(kernels) {}

  /// The frame has to stay until its picture is drawn.
  /// @param spheres of the frame, or what is drawn instead
  /// @param over draws over the spheres, may be null
  void prepare(const Frame& frame, const View& view, const Points& spheres,
               const TileSource* over = nullptr);
  /// Sets the part that OpenGL has drawn. Default: nothing.
  void set_solids(const SolidSamples* solids) { solids_ = solids; }

  /// Draws all tiles and keeps them, in three steps, for who has to know depths before the light or
  /// wants to time each step. Without: tile by tile while lighting.
  /// @param has_parts  whether to keep the parts of the light of what is lit already
  void keep_points(bool has_parts = false);
  void keep_grounds();
  void keep_solids();
  /// Lets the background through where a kept tile shows a ground, which keeps its depth.
  void uncover_grounds();
  /// Tile after tile, row by row from the lower left one.
  const light::GBufferTile* kept() const { return kept_.get(); }
  /// Parts of the light in a kept tile; null if nothing is lit already, or they are not kept.
  const light::LitTile* kept_parts(int tile) const {
    return lit_.empty() ? nullptr : lit_[static_cast<std::size_t>(tile)].get();
  }
  int columns() const { return splatter_.columns(); }

  /// @param smoke may be null
  /// @param wants_depth whether to make depth() too
  void shade(const light::LightVolume& light, const light::SmokeCover* smoke, bool wants_depth);

  /// Parts of the light: with the sun or without, with the sky or without.
  struct Parts {
    bool has_sun = true, has_sky = true;
    bool is_open =
        false;  ///< the sun as if nothing were in its way; given the volume of such light
    /// Holdouts leave the share of this light, as if they were lit, and not that of all light.
    bool has_lit_holdouts = false;
  };
  /// The same before the tone mapping, from kept tiles.
  void shade_linear(const light::LightVolume& light, const light::SmokeCover* smoke, Parts parts,
                    LinearSamples& out) const;

  /// Returns sRGB and alpha, rows from the bottom up.
  const std::uint32_t* picture() const { return picture_.get(); }
  int pitch() const { return pitch_; }  ///< samples from one row to the next
  /// Returns the depth of each sample as OpenGL has it, at the same pitch.
  const float* depth() const { return depth_.get(); }

 private:
  void add_points(int tile, light::GBufferTile& out, light::LitTile* lit = nullptr);
  void add_grounds(int tile, light::GBufferTile& out) const;
  void add_solids(int tile, light::GBufferTile& out) const;
  ShadeJob shade_job(const light::LightVolume& light, const light::SmokeCover* smoke) const;
  void write_depth(int tile, const light::GBufferTile& from);
  std::size_t corner_of(int tile) const;

  const DrawKernels& kernels_;
  ThreadPool* pool_;
  Splatter splatter_;
  light::LaneView view_{};
  const Frame* frame_ = nullptr;
  Vec3f eye_;
  std::vector<GroundJob> grounds_;
  const SolidSamples* solids_ = nullptr;
  const TileSource* over_ = nullptr;
  bool has_kept_ = false;
  std::size_t kept_size_ = 0, picture_size_ = 0, depth_size_ = 0;
  std::unique_ptr<light::GBufferTile[]> kept_;
  std::vector<std::unique_ptr<light::LitTile>> lit_;  ///< empty: not kept
  std::unique_ptr<std::uint32_t[]> picture_;
  std::unique_ptr<float[]> depth_;
  int pitch_ = 0;
};

/// The camera as kernels take it.
light::LaneView lane_view(const View& view);

}  // namespace neve::render::cpu
