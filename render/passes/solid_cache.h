#pragma once
/// Meshes, heat maps and arrows as OpenGL has drawn them, kept in memory for as long as neither
/// they nor the camera change: colliders at rest are drawn once for a whole sequence.

#include <cstdint>
#include <optional>
#include <vector>

#include "render/cpu/surfaces.h"
#include "render/frame/frame.h"
#include "render/frame/view.h"

namespace neve::render::passes {

class SolidCache {
 public:
  /// True if the samples belong to this frame.
  bool holds(const Frame& frame, const View& view) const;
  /// Returns the samples, which now belong to this frame and have to be drawn anew.
  cpu::SolidSamples& renew(const Frame& frame, const View& view);
  const cpu::SolidSamples& samples() const { return samples_; }
  /// Number of times that the samples were drawn.
  std::uint64_t renewals() const { return renewals_; }

 private:
  struct Inputs {
    View view;
    int supersampling;  ///< lines are as wide as asked for on the finished picture
    std::vector<TriangleMesh> meshes;
    std::vector<HeatMap> heat_maps;
    std::vector<Arrows> arrows;
    bool operator==(const Inputs&) const = default;
  };
  std::optional<Inputs> inputs_;  ///< of samples_
  cpu::SolidSamples samples_;
  std::uint64_t renewals_ = 0;
};

}  // namespace neve::render::passes
