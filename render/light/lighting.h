#pragma once
/// Light on a body of snow, computed on the CPU on a coarse grid around points and smoke: how much
/// of the key light and of the sky reaches each place, and which way the surface of the body faces.
/// Depends on the frame alone: not on the order of the points, not on the number of threads.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/frame/frame.h"
#include "render/light/smoke_grid.h"
#include "sim/base/thread_pool.h"

namespace neve::render::light {

/// A box of cells; index = (z * size.y + y) * size.x + x.
struct LightGrid {
  Vec3f origin;    ///< lower corner, m
  float cell = 1;  ///< edge of a cell, m
  Vec3i size{1, 1, 1};

  std::size_t count() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
           static_cast<std::size_t>(size.z);
  }
};

struct LightVolume {
  LightGrid grid;
  /// Another number for every volume that Lighting makes, so that users of one know whether they
  /// have it already; 0 in those that others make.
  std::uint64_t serial = 0;
  /// Four signed bytes per cell: the outward normal of the body times how sure it is, and density.
  std::vector<std::int8_t> body;
  /// Two 16-bit fractions per cell: key light and sky that arrive there.
  std::vector<std::uint16_t> light;
};

/// Unit vector towards the key light; straight up where the frame names no direction.
Vec3f toward_light(const Light& light);

/// Fits a grid to the points (leaving out far strays), the smoke and meshes near them.
/// @param pool may be null
LightGrid fit_light_grid(const Points& points, const std::vector<TriangleMesh>& meshes,
                         const SmokeGrid& smoke = {}, ThreadPool* pool = nullptr);

/// @param smoke that of the frame, may be empty @param pool may be null
LightVolume make_light_volume(const Frame& frame, const SmokeGrid& smoke, ThreadPool* pool);

struct LightBuffers;

/// Everything that a light volume is made of; the rest of a frame is left at its defaults.
struct LightInputs {
  Points points;                     ///< position and spacing
  std::vector<TriangleMesh> meshes;  ///< position and index
  SmokeGrid smoke;
  Vec3f toward_light;
  bool operator==(const LightInputs&) const = default;
};

/// Makes light volumes, and only when something that light falls on or its direction has changed:
/// several views of one state share theirs.
class Lighting {
 public:
  Lighting();
  ~Lighting();
  /// Returns the volume of a frame, valid until the next call.
  const LightVolume& volume(const Frame& frame, const SmokeGrid& smoke, ThreadPool* pool);

 private:
  std::optional<LightInputs> inputs_;  ///< of volume_
  std::unique_ptr<LightBuffers> buffers_;
  LightVolume volume_;
};

}  // namespace neve::render::light
