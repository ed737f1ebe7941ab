#include "app/exports/surface_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/picture/snow_volume.h"
#include "app/picture/to_float.h"
#include "app/scene/toml/value.h"
#include "app/setup/plan.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "render/surface/nearby.h"

namespace neve::app::exports {

namespace {

using render::surface::Shares;
using render::surface::Surface;

Surface make_surface(const SnowGrains& grains, const render::surface::Settings& settings,
                     const scene::Export& e) {
  try {
    return render::surface::make_surface(grains.view(), settings, nullptr);
  } catch (const render::surface::MemoryError& error) {
    throw LimitError(
        "refused: a surface with surface_cell = " + scene::toml::number_text(e.surface_cell) +
            " needs more than " + bytes_text(static_cast<std::uint64_t>(error.bytes)) +
            " of memory; limits.memory or --max-memory allow " + bytes_text(settings.max_bytes),
        "surface_cell",
        "use a larger surface_cell (--surface-cell), or let a [[sink]] with outside = "
        "true remove snow that is far away");
  }
}

/// Mixes the rows of the particles around a vertex.
template <class T>
void mix_row(const std::vector<T>& numbers, std::size_t width, const Shares& shares, std::size_t v,
             T* out) {
  constexpr std::size_t max_width = 9;  // a tensor
  const std::uint32_t first = shares.first[v], end = shares.first[v + 1];
  if constexpr (std::is_integral_v<T>) {
    std::copy_n(numbers.data() + shares.grain[first] * width, width, out);
  } else {
    std::array<double, max_width> sum{};
    for (std::uint32_t k = first; k < end; ++k) {
      const double share = static_cast<double>(shares.share[k]);
      const T* row = numbers.data() + shares.grain[k] * width;
      for (std::size_t c = 0; c < width; ++c) sum[c] += share * static_cast<double>(row[c]);
    }
    for (std::size_t c = 0; c < width; ++c) out[c] = static_cast<T>(sum[c]);
  }
}

/// Numbers of the vertices, then those of the spray, row by row.
template <class T>
std::vector<T> mixed(const std::vector<T>& numbers, std::size_t width, const Shares& shares,
                     const std::vector<std::uint32_t>& spray) {
  const std::size_t vertices = shares.first.size() - 1;
  std::vector<T> out((vertices + spray.size()) * width);
  for (std::size_t v = 0; v < vertices; ++v)
    mix_row(numbers, width, shares, v, out.data() + v * width);
  T* to = out.data() + vertices * width;
  for (const std::uint32_t p : spray) to = std::copy_n(numbers.data() + p * width, width, to);
  return out;
}

sim::Vec3d vector_of(Vec3f v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Places of the vertices, then those of the spray.
std::vector<double> mixed_places(const Axes& axes, const Surface& surface,
                                 const std::vector<double>& of_particles) {
  std::vector<double> places;
  places.reserve(3 * (surface.mesh.position.size() + surface.spray.size()));
  for (const Vec3f& x : surface.mesh.position) {
    const sim::Vec3d place = axes.placed(vector_of(x));
    places.insert(places.end(), place.data(), place.data() + 3);
  }
  for (const std::size_t p : surface.spray)
    for (std::size_t a = 0; a < 3; ++a) places.push_back(of_particles[3 * p + a]);
  return places;
}

MeshRows mesh_rows(const Axes& axes, const Surface& surface) {
  MeshRows mesh;
  mesh.vertices = surface.mesh.position.size();
  mesh.corners.assign(surface.mesh.index.begin(), surface.mesh.index.end());
  mesh.normal.reserve(3 * (mesh.vertices + surface.spray.size()));
  for (const Vec3f& n : surface.mesh.normal) {
    const sim::Vec3d normal = axes.direction(vector_of(n));
    for (int a = 0; a < 3; ++a) mesh.normal.push_back(static_cast<float>(normal[a]));
  }
  mesh.normal.resize(3 * (mesh.vertices + surface.spray.size()));
  return mesh;
}

}  // namespace

SnowGrains grains_of(const scene::Scene& scene, const sim::ParticleArrays& particles,
                     std::span<const std::size_t> rows) {
  SnowGrains grains;
  for (const std::size_t p : rows) {
    grains.position.push_back(picture::to_float(particles.x[p]));
    grains.volume.push_back(static_cast<float>(picture::snow_volume(scene, particles, p)));
  }
  return grains;
}

double particle_spacing(const scene::Scene& scene) {
  double fewest = 0;
  const auto include = [&](double per_cell) {
    if (per_cell > 0) fewest = fewest > 0 ? std::min(fewest, per_cell) : per_cell;
  };
  for (const sim::seeding::Body& body : scene.bodies) include(body.particles_per_cell);
  for (const sim::seeding::Emitter& emitter : scene.emitters) include(emitter.particles_per_cell);
  return scene.solver.cell_size / std::cbrt(fewest > 0 ? fewest : 8);
}

render::surface::Settings surface_settings(const scene::Scene& scene, const scene::Export& e) {
  const double spacing = particle_spacing(scene);
  return {{static_cast<float>(e.surface_cell * spacing),
           static_cast<float>(e.surface_smoothing * spacing)},
          e.smallest_piece,
          setup::memory_limit(scene).bytes};
}

Table surface_table(const scene::Scene& scene, const scene::Export& e, const State& state,
                    std::span<const std::size_t> rows, const Table& particles) {
  const Axes axes(scene, e);
  const SnowGrains grains = grains_of(scene, state.particles, rows);
  const render::surface::Settings settings = surface_settings(scene, e);
  const Surface surface = make_surface(grains, settings, e);
  Table table;
  table.rows = surface.mesh.position.size() + surface.spray.size();
  table.mesh = mesh_rows(axes, surface);
  Shares shares;
  if (particles.columns.size() > 1)
    shares = render::surface::shares_of(surface.mesh.position, grains.view(), surface.spray,
                                        render::surface::attribute_reach * settings.kernel.width,
                                        nullptr);
  for (const Column& column : particles.columns) {
    Column& out = table.columns.emplace_back(column);
    if (column.attribute == scene::ExportAttribute::x)
      out.numbers = mixed_places(axes, surface, particles.places());
    else
      out.numbers = std::visit(
          [&](const auto& numbers) {
            return Numbers(
                mixed(numbers, static_cast<std::size_t>(column.components), shares, surface.spray));
          },
          column.numbers);
  }
  return table;
}

}  // namespace neve::app::exports
