#include "render/passes/solid_cache.h"

#include <algorithm>

#include "render/frame/same_bytes.h"

namespace neve::render::passes {
namespace {

bool is_same_view(const View& a, const View& b) {
  return a.eye == b.eye && a.right == b.right && a.up == b.up && a.forward == b.forward &&
         a.pixels_per_slope == b.pixels_per_slope && a.width == b.width && a.height == b.height &&
         a.near_distance == b.near_distance;
}

bool is_same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.color == b.color && same_bytes(a.position, b.position) &&
         same_bytes(a.normal, b.normal) && same_bytes(a.index, b.index);
}

bool is_same_map(const HeatMap& a, const HeatMap& b) {
  return a.corner == b.corner && a.across == b.across && a.up == b.up && a.columns == b.columns &&
         a.rows == b.rows && a.isoline_step == b.isoline_step && a.colormap == b.colormap &&
         a.range_min == b.range_min && a.range_max == b.range_max && same_bytes(a.value, b.value);
}

bool are_same_arrows(const Arrows& a, const Arrows& b) {
  return a.length_per_value == b.length_per_value && a.max_length == b.max_length &&
         a.colormap == b.colormap && a.range_min == b.range_min && a.range_max == b.range_max &&
         same_bytes(a.position, b.position) && same_bytes(a.vector, b.vector);
}

}  // namespace

struct SolidCache::Key {
  View view;
  int supersampling;  ///< lines are as wide as asked for on the finished picture
  std::vector<TriangleMesh> meshes;
  std::vector<HeatMap> heat_maps;
  std::vector<Arrows> arrows;
};

SolidCache::SolidCache() = default;
SolidCache::~SolidCache() = default;

bool SolidCache::holds(const Frame& frame, const View& view) const {
  return key_ && key_->supersampling == frame.supersampling && is_same_view(key_->view, view) &&
         std::ranges::equal(key_->meshes, frame.meshes, is_same_mesh) &&
         std::ranges::equal(key_->heat_maps, frame.heat_maps, is_same_map) &&
         std::ranges::equal(key_->arrows, frame.arrows, are_same_arrows);
}

cpu::SolidSamples& SolidCache::renew(const Frame& frame, const View& view) {
  key_ = std::make_unique<Key>(
      Key{view, frame.supersampling, frame.meshes, frame.heat_maps, frame.arrows});
  samples_.resize(view.width, view.height);
  ++renewals_;
  return samples_;
}

}  // namespace neve::render::passes
