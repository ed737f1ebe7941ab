#include "app/bench/bench.h"

#include <array>
#include <map>
#include <string>

#include "app/bench/measure.h"
#include "app/bench/render_frames.h"
#include "app/scene/scene.h"
#include "app/support/text.h"
#include "render/surface/nearby.h"
#include "render/surface/surface.h"

namespace neve::app::bench {

namespace {

struct SurfaceSize {
  const char* name;
  double particles, quick;
};
constexpr std::array<SurfaceSize, 4> surface_sizes{
    {{"4k", 4000, 2000}, {"100k", 1e5, 3000}, {"300k", 3e5, 4000}, {"1m", 1e6, 5000}}};

/// splashsurf 0.14 at cube size 1 and smoothing length 2 radii, ms.
constexpr int must = 380, aim = 200;
constexpr const char* main_row = "surface_300k";

/// Snow of the picture benchmark, with the settings that an export has.
struct SurfaceCase {
  explicit SurfaceCase(double particles) : points(particles_frame(particles).points) {
    const float d = points.spacing;
    volume.assign(points.position.size(), d * d * d);
    const scene::Export usual;
    settings.kernel = {d * static_cast<float>(usual.surface_cell),
                       d * static_cast<float>(usual.surface_smoothing)};
    settings.smallest_piece = usual.smallest_piece;
  }
  render::surface::Grains grains() const { return {points.position, volume}; }

  render::Points points;
  std::vector<float> volume;
  render::surface::Settings settings;
};

void measure(const std::string& size, const SurfaceCase& snow, ThreadPool& pool, RowSamples& rows) {
  const auto add = [&](const std::string& name, double seconds) {
    rows.add({name + size, pool.thread_count(), snow.points.position.size(), "none", {}, "ms"},
             1e3 * seconds);
  };
  const Stopwatch watch;
  const render::surface::Surface surface = make_surface(snow.grains(), snow.settings, &pool);
  add("surface_", watch.wall());
  const Stopwatch again;
  render::surface::shares_of(surface.mesh.position, snow.grains(), surface.spray,
                             render::surface::attribute_reach * snow.settings.kernel.width, &pool);
  add("attributes_", again.wall());
}

}  // namespace

std::vector<BenchRow> bench_surface(const BenchOptions& options, Progress& progress) {
  ThreadPool pool(options.threads), one(1);
  const int rounds = options.rounds_or(1, 7);
  std::map<std::string, SurfaceCase> cases;
  for (const SurfaceSize& size : surface_sizes)
    cases.try_emplace(size.name, options.is_quick ? size.quick : size.particles);
  RowSamples rows;
  for (int round = 0; round < rounds; ++round) {
    for (const SurfaceSize& size : surface_sizes) {
      stop_if_interrupted();
      measure(size.name, cases.at(size.name), pool, rows);
    }
    measure("300k_1_thread", cases.at("300k"), one, rows);
    progress.note("round " + std::to_string(round + 1) + " of " + std::to_string(rounds));
  }
  const std::vector<BenchRow> found = rows.rows();
  for (const BenchRow& row : found)
    if (row.name == main_row && !options.is_quick)
      progress.note(row.name + ": " + fixed_text(row.value.median, 1) +
                    " ms; the target on two quiet cores is at most " + std::to_string(must) +
                    " ms, better " + std::to_string(aim) + " ms");
  return found;
}

}  // namespace neve::app::bench
