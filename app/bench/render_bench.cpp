#include "app/bench/bench.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>

#include "app/bench/measure.h"
#include "app/bench/render_frames.h"
#include "app/support/text.h"
#include "render/cpu/draw_kernels.h"
#include "render/gl/context.h"
#include "render/renderer.h"

namespace neve::app::bench {

namespace {

struct Size {
  const char* name;
  double particles, quick;
};
constexpr std::array<Size, 4> sizes{
    {{"4k", 4000, 4000}, {"100k", 1e5, 5000}, {"300k", 3e5, 6000}, {"1m", 1e6, 8000}}};
constexpr const char* main_size = "300k";

/// design.md: what a picture on a machine without a GPU may take, ms.
struct SphereTarget {
  const char* row;
  int must, aim;
};
constexpr std::array<SphereTarget, 3> targets{
    {{"particles_300k", 55, 30}, {"all_layers_300k", 110, 60}, {"png", 20, 20}}};

class RenderBench {
 public:
  RenderBench(const BenchOptions& options, Progress& progress);
  std::vector<BenchRow> run();

 private:
  void measure_particles(const std::string& size, render::Frame& frame);
  void measure_all_layers(render::Frame& frame);
  void measure_snow(render::Frame& frame);
  void measure_png();
  void add(const std::string& name, double seconds, const render::Frame& frame);
  render::Image draw(const std::string& name, const render::Frame& frame);
  void compare_with_targets(const std::vector<BenchRow>& rows);

  BenchOptions options_;
  Progress& progress_;
  int rounds_;
  std::unique_ptr<render::gl::Context> context_;
  ThreadPool pool_;
  render::Renderer renderer_, by_gl_, by_cpu_;
  render::Image picture_;  ///< the last one of the main size
  RowSamples rows_;
};

RenderBench::RenderBench(const BenchOptions& options, Progress& progress)
    : options_(options),
      progress_(progress),
      rounds_(options.rounds_or(1, 7)),
      context_(render::gl::open_context(options.backend)),
      pool_(options.threads),
      renderer_(*context_, {}, &pool_),
      by_gl_(*context_, {}, &pool_, render::ParticlePath::gl),
      by_cpu_(*context_, {}, &pool_, render::ParticlePath::cpu) {}

void RenderBench::add(const std::string& name, double seconds, const render::Frame& frame) {
  rows_.add({name,
             pool_.thread_count(),
             frame.points.position.size(),
             render::cpu::chosen_draw_kernels().simd,
             {},
             "ms"},
            1e3 * seconds);
}

/// The picture as users get it.
render::Image RenderBench::draw(const std::string& name, const render::Frame& frame) {
  const Stopwatch watch;
  render::Image image = renderer_.draw(frame);
  add(name, watch.wall(), frame);
  return image;
}

/// Times of the phases of a picture of this frame. Measuring them makes the driver wait, so their
/// sum is slightly more than the time of the picture.
std::vector<render::PhaseTime> phases_of(render::Renderer& renderer, const render::Frame& frame) {
  std::vector<render::PhaseTime> times;
  renderer.draw(frame, &times);
  return times;
}

double phase_seconds(const std::vector<render::PhaseTime>& times, const std::string& phase) {
  const auto found = std::ranges::find(times, phase, &render::PhaseTime::phase);
  return found == times.end() ? 0 : found->seconds;
}

/// The picture as users get it, and only its spheres, once by OpenGL and once by the CPU.
void RenderBench::measure_particles(const std::string& size, render::Frame& frame) {
  // Another state than before, so that nothing of the last picture can be used again.
  frame.points.position.edit().front().x *= -1;
  render::Image image = draw("particles_" + size, frame);
  draw("particles_" + size + "_same_state", frame);
  add("spheres_" + size + "_by_gl", phase_seconds(phases_of(by_gl_, frame), "particles"), frame);
  add("spheres_" + size + "_by_cpu", phase_seconds(phases_of(by_cpu_, frame), "particles"), frame);
  if (size == main_size) picture_ = std::move(image);
}

/// Another state than before in every layer, so that nothing of the last picture can be used again.
void change_state(render::Frame& frame) {
  frame.points.position.edit().front().x *= -1;
  for (render::Arrows& arrows : frame.arrows) arrows.vector.edit().front().y += 1e-3f;
  for (float& density : frame.smoke.density.edit()) density *= 1.001f;
}

void RenderBench::measure_all_layers(render::Frame& frame) {
  const std::string name = std::string("all_layers_") + main_size;
  change_state(frame);
  draw(name, frame);
  // The camera moves as in a view that turns.
  frame.camera.eye.x += 1e-3f;
  draw(name + "_same_state", frame);
  change_state(frame);
  for (const render::PhaseTime& time : phases_of(renderer_, frame))
    add(std::string("phase_") + time.phase, time.seconds, frame);
  // The layers that scripts ask for one by one.
  change_state(frame);
  std::vector<render::HeatMap> heat_maps;
  std::swap(heat_maps, frame.heat_maps);
  const std::vector<render::PhaseTime> times = phases_of(renderer_, frame);
  add("smoke", phase_seconds(times, "smoke"), frame);
  add("arrows", phase_seconds(times, "slices"), frame);
  std::swap(heat_maps, frame.heat_maps);
}

/// The same points as a surface of snow, and again from another side.
void RenderBench::measure_snow(render::Frame& frame) {
  const std::string name = std::string("snow_") + main_size;
  frame.has_snow_surface = true;
  // Another state than ever before.
  frame.points.position.edit().front().y += 1e-5f;
  draw(name, frame);
  frame.camera.eye.x += 1e-3f;
  draw(name + "_same_state", frame);
  frame.has_snow_surface = false;
}

void RenderBench::measure_png() {
  const render::PngText text = {{"neve:scene", std::string(4000, '#')}};
  const Stopwatch watch;
  encode_png(picture_, text);
  render::Frame none;
  add("png", watch.wall(), none);
}

std::vector<BenchRow> RenderBench::run() {
  progress_.note("neve bench render: " + context_->backend + ", " + context_->renderer +
                 ", 1280x720, " + std::to_string(rounds_) + " rounds; spheres by " +
                 (renderer_.particle_path() == render::ParticlePath::cpu ? "the CPU" : "OpenGL"));
  std::map<std::string, render::Frame> frames;
  for (const Size& size : sizes)
    frames[size.name] = particles_frame(options_.is_quick ? size.quick : size.particles);
  const double main_particles = options_.is_quick ? sizes[2].quick : sizes[2].particles;
  render::Frame all_layers = all_layers_frame(main_particles);
  // The first picture of each kind compiles shaders and fills caches.
  for (render::Renderer* renderer : {&renderer_, &by_gl_, &by_cpu_}) renderer->draw(frames["4k"]);
  renderer_.draw(all_layers);
  for (int round = 0; round < rounds_; ++round) {
    for (const Size& size : sizes) {
      stop_if_interrupted();
      measure_particles(size.name, frames[size.name]);
    }
    measure_all_layers(all_layers);
    measure_snow(frames[main_size]);
    measure_png();
    progress_.note("round " + std::to_string(round + 1) + " of " + std::to_string(rounds_));
  }
  const std::vector<BenchRow> found = rows_.rows();
  if (context_->is_software && !options_.is_quick) compare_with_targets(found);
  return found;
}

void RenderBench::compare_with_targets(const std::vector<BenchRow>& rows) {
  for (const SphereTarget& target : targets) {
    const auto row = std::ranges::find(rows, std::string(target.row), &BenchRow::name);
    if (row == rows.end()) continue;
    progress_.note(
        std::string(target.row) + ": " + fixed_text(row->value.median, 1) +
        " ms; the target on two quiet cores is at most " + std::to_string(target.must) + " ms" +
        (target.aim < target.must ? ", better " + std::to_string(target.aim) + " ms" : ""));
  }
}

}  // namespace

std::vector<BenchRow> bench_render(const BenchOptions& options, Progress& progress) {
  return RenderBench(options, progress).run();
}

}  // namespace neve::app::bench
