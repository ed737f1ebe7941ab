#pragma once
/// Needs of a run, estimated before anything is allocated, and the limits it must keep.

#include <cstdint>
#include <limits>
#include <string>

#include "app/scene/scene.h"
#include "app/support/json.h"

namespace neve::app::setup {

enum class Quality { draft, preview, final };
const char* name(Quality quality);
/// @throws UsageError for an unknown name
Quality quality_named(const std::string& name);

/// The first and the last frame drawn; those before are simulated only. Counted from 0, or numbers
/// of a scene's files.
struct FrameRange {
  static constexpr int from_start = std::numeric_limits<int>::min();  ///< as first: of the scene's
  int first = 0, last = 0;
  int count() const { return last - first + 1; }
};

/// The numbers of frames that are counted from 0.
FrameRange numbers_of(const scene::Scene& scene, const FrameRange& frames);
/// Frames counted from 0 of numbers. @throws UsageError for numbers before the first of the scene
FrameRange frames_of(const scene::Scene& scene, const FrameRange& numbers);

struct Plan {
  double particles = 0;      ///< an estimate; a double, so that absurd scenes do not overflow it
  double emitted = 0;        ///< of those, particles that emitters make until the last frame
  std::uint64_t memory = 0;  ///< bytes, particles, grid and pictures
  std::uint64_t memory_limit = 0;  ///< bytes
  double particle_limit = 0;
  /// The limits are caps() instead of those of the scene.
  bool is_memory_capped = false, are_particles_capped = false;
  double pictures = 0;         ///< bytes of the memory that pictures take
  double largest_picture = 0;  ///< pixels, supersamples included
  FrameRange frames;
  int first_number = 0;  ///< of frame 0
  double volume = 0;     ///< m3 of all bodies and of emitted snow
};

/// Bytes that a run of the scene may take.
struct MemoryLimit {
  std::uint64_t bytes;
  bool is_capped;  ///< by caps() instead of the scene
};
MemoryLimit memory_limit(const scene::Scene& scene);

int supersampling(Quality quality);

/// Checks before any step that a picture of this size can be drawn. @param largest  side that the
/// backend draws
/// @throws LimitError
void check_picture(const std::string& what, const scene::PictureSize& size, int largest,
                   const std::string& place, const std::string& advice);

scene::PictureSize size_of(const scene::Scene& scene, const scene::View& view);

/// @throws sim::ShapeError for meshes that cannot be read
/// @param channel_bytes  of a pixel of pictures with passes; 0: none
Plan make_plan(const scene::Scene& scene, const FrameRange& frames, Quality quality, int threads,
               double channel_bytes = 0);

/// @param coarsening of --coarsen, for advice
/// @throws LimitError naming the limit and how to keep it, or to raise it where this machine can
void check_limits(const scene::Scene& scene, const Plan& plan, double coarsening = 1);

/// Adds the memory of a run that ends before this one begins, which is not available yet, to a
/// limit that is what is available.
void count_on(std::uint64_t bytes, const scene::Scene& scene, Plan& plan);

Json to_json(const Plan& plan);

}  // namespace neve::app::setup
