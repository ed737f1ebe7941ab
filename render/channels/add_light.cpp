#include <algorithm>

#include "render/channels/gather.h"

namespace neve::render::channels {
namespace {

/// Adds weight times the mean of the samples of each pixel.
void add_mean(const std::vector<float>& samples, int pitch, const Frame& frame, float weight,
              Plane& out) {
  const int ss = frame.supersampling;
  const float share = weight / static_cast<float>(ss * ss);
  out.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  std::size_t at = 0;
  for (int y = frame.height - 1; y >= 0; --y)
    for (int x = 0; x < frame.width; ++x, ++at) {
      float sum = 0;
      for (int j = 0; j < ss; ++j)
        for (int i = 0; i < ss; ++i)
          sum += samples[static_cast<std::size_t>(y * ss + j) * static_cast<std::size_t>(pitch) +
                         static_cast<std::size_t>(x * ss + i)];
      out[at] += share * sum;
    }
}

void add_means(const cpu::LinearSamples& samples, const Frame& frame, float weight,
               ColorPlanes& out) {
  for (std::size_t c = 0; c < 3; ++c)
    add_mean(samples.color[c], samples.pitch, frame, weight, out[c]);
}

/// a += factor b
void add(ColorPlanes& a, float factor, const ColorPlanes& b) {
  for (std::size_t c = 0; c < 3; ++c) {
    a[c].resize(b[c].size());
    for (std::size_t i = 0; i < b[c].size(); ++i) a[c][i] += factor * b[c][i];
  }
}

}  // namespace

light::LightVolume without_shadow(const light::LightVolume& light) {
  light::LightVolume open = light;
  std::ranges::fill(open.light, std::uint16_t{0xffff});
  return open;
}

/// Light is linear in the strengths of sun and sky: each part is a picture without the others.
/// Holdouts leave the same of the background in all of them, but for those of the shadow.
void add_light(const LitSurfaces& lit, const Request& request, float weight, LightPlanes& out) {
  const Frame& frame = lit.frame;
  const auto has = [&](Pass pass) { return request.passes.contains(pass); };
  const bool has_shadow = has(Pass::shadow), has_indirect = has(Pass::indirect);
  cpu::LinearSamples samples;
  const auto shade = [&](const light::LightVolume& light, cpu::Surfaces::Parts parts,
                         ColorPlanes& to) {
    lit.surfaces.shade_linear(light, lit.smoke, parts, samples);
    add_means(samples, frame, weight, to);
  };
  ColorPlanes beauty, own, direct, open;
  shade(lit.light, {}, beauty);
  add_mean(samples.cover, samples.pitch, frame, weight, out.cover);
  add(out.beauty, 1, beauty);
  if (!has(Pass::direct) && !has_indirect && !has(Pass::emission) && !has_shadow) return;
  shade(lit.light, {false, false}, own);
  add(out.emission, 1, own);
  shade(lit.light, {true, false}, direct);
  add(direct, -1, own);
  add(out.direct, 1, direct);
  if (has_indirect) {
    add(beauty, -1, own);
    add(beauty, -1, direct);
    add(out.indirect, 1, beauty);
  }
  if (!has_shadow) return;
  // The background behind a holdout is no direct light, but the sun's shadow falls on it.
  const bool has_holdouts = std::ranges::any_of(frame.meshes, &TriangleMesh::is_holdout) ||
                            std::ranges::any_of(frame.grounds, &GroundPlane::is_holdout);
  if (has_holdouts) {
    for (ColorPlanes* part : {&own, &direct}) *part = {};
    shade(lit.light, {false, false, false, true}, own);
    shade(lit.light, {true, false, false, true}, direct);
    add(direct, -1, own);
  }
  add(out.shaded, 1, direct);
  shade(without_shadow(lit.light), {true, false, true, true}, open);
  add(open, -1, own);
  add(out.open, 1, open);
}

}  // namespace neve::render::channels
