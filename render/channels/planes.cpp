#include "render/channels/planes.h"

#include <utility>

namespace neve::render::channels {
namespace {

constexpr std::array axes{"X", "Y", "Z"}, colors{"R", "G", "B"};

/// Collects channels of one picture.
struct Channels {
  std::vector<ExrChannel>& list;

  void add_half(const std::string& name, Plane plane) { list.push_back({name, to_half(plane)}); }
  void add(const std::string& name, Plane plane) { list.push_back({name, std::move(plane)}); }
  void add_colors(const std::string& layer, ColorPlanes planes) {
    for (std::size_t c = 0; c < 3; ++c)
      add_half((layer.empty() ? "" : layer + ".") + colors[c], std::move(planes[c]));
  }
};

/// Share of the direct light that shadows leave; 1 if there is none to lose.
ColorPlanes shadow_of(const LightPlanes& light) {
  ColorPlanes shadow;
  for (std::size_t c = 0; c < 3; ++c) {
    shadow[c].assign(light.shaded[c].size(), 1);
    for (std::size_t i = 0; i < shadow[c].size(); ++i)
      if (light.open[c][i] > 1e-6f) shadow[c][i] = light.shaded[c][i] / light.open[c][i];
  }
  return shadow;
}

void add_data(const Request& request, DataPlanes data, Channels& out) {
  const auto has = [&](Pass pass) { return request.passes.contains(pass); };
  if (has(Pass::depth)) out.add("depth.Z", std::move(data.depth));
  for (std::size_t a = 0; a < 3; ++a) {
    if (has(Pass::position))
      out.add(std::string("position.") + axes[a], std::move(data.position[a]));
    if (has(Pass::normal))
      out.add_half(std::string("normal.") + axes[a], std::move(data.normal[a]));
  }
  if (has(Pass::albedo)) out.add_colors("albedo", std::move(data.albedo));
  constexpr std::array motions{"forward.u", "forward.v", "backward.u", "backward.v"};
  for (std::size_t m = 0; m < 4 && has(Pass::motion); ++m)
    out.add(motions[m], std::move(data.motion[m]));
  if (has(Pass::id)) out.add("id.Y", std::move(data.id));
  if (has(Pass::body)) out.add("body.Y", std::move(data.body));
  if (has(Pass::collider)) out.add("collider.Y", std::move(data.collider));
  std::size_t at = 0;
  for (const PointNumbers& numbers : request.numbers)
    for (const std::string& channel : numbers.channels)
      out.add(numbers.name + "." + channel, std::move(data.numbers[at++]));
}

}  // namespace

ExrPicture to_picture(int width, int height, const Request& request, LightPlanes light,
                      DataPlanes data) {
  ExrPicture picture{width, height, {}};
  Channels out{picture.channels};
  const auto has = [&](Pass pass) { return request.passes.contains(pass); };
  if (has(Pass::shadow)) out.add_colors("shadow", shadow_of(light));
  out.add_colors("", std::move(light.beauty));
  out.add_half("A", std::move(light.cover));
  if (has(Pass::direct)) out.add_colors("direct", std::move(light.direct));
  if (has(Pass::indirect)) out.add_colors("indirect", std::move(light.indirect));
  if (has(Pass::emission)) out.add_colors("emission", std::move(light.emission));
  add_data(request, std::move(data), out);
  return picture;
}

}  // namespace neve::render::channels
