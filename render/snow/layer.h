#pragma once
/// The snow of a frame as a continuous surface with grain, lit, and its spray as grains.
/// Drawn on the processor also where OpenGL draws the rest, so that there is one picture.

#include <memory>
#include <optional>

#include "render/cpu/tile_source.h"
#include "render/frame/view.h"
#include "render/light/lighting.h"
#include "render/snow/body.h"
#include "render/snow/exposed_nodes.h"
#include "render/snow/march.h"
#include "render/snow/shading.h"

namespace neve::render::snow {

class Batch;

class Layer : public cpu::TileSource {
 public:
  /// Makes the body, unless it is that of the last call.
  /// @param frame, view, volume  stay until the picture is drawn @param pool may be null
  void prepare(const Frame& frame, const View& view, const light::LightVolume& volume,
               ThreadPool* pool);
  /// Points to be drawn as spheres before the tiles.
  const Points& spray() const { return body_.spray; }
  void draw_tile(int x, int y, light::GBufferTile& tile, light::LitTile* lit) const override;

 private:
  /// Ray of a sample and its hit on the surface.
  struct Sample {
    Vec3f ray;
    float hit;  ///< m along the view; 0: none
    std::uint32_t padded;
  };
  void march(ThreadPool* pool);
  SnowPlace place_at(const Sample& sample, float distance) const;
  void add_surface(const Sample& sample, int at, light::GBufferTile& tile, Batch& batch) const;
  void add_grain(const Sample& sample, int at, const light::GBufferTile& tile, Batch& batch) const;

  Body body_;
  std::optional<Points> points_;      ///< that the body is made of
  std::vector<GroundPlane> grounds_;  ///< likewise
  const View* view_ = nullptr;
  float grain_size_ = 1;  ///< of a sample at a distance of 1, for the detail of grain
  const light::LightVolume* volume_ = nullptr;
  std::uint64_t serial_ = 0;  ///< of the light volume that nodes_ are made of
  std::optional<ExposedNodes> nodes_;
  std::optional<Marcher> marcher_;
  int columns_ = 0;             ///< of tiles
  std::vector<TileHits> hits_;  ///< of each tile
  SnowLight light_{};
};

}  // namespace neve::render::snow
