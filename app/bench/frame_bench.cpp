#include "app/bench/bench.h"

#include <algorithm>
#include <memory>

#include "app/bench/measure.h"
#include "app/bench/timed_run.h"
#include "app/picture/frame_builder.h"
#include "app/scene/coarsen.h"
#include "app/scene/read.h"
#include "app/scene/toml/value.h"
#include "app/setup/resolve.h"
#include "app/setup/seed_scene.h"
#include "app/support/interrupt.h"
#include "app/support/machine.h"
#include "app/support/text.h"
#include "render/gl/context.h"
#include "render/renderer.h"

namespace neve::app::bench {

namespace {

// Rows say which transfer they take, and do not follow the defaults of scenes.
constexpr const char* flip = "transfer = \"flip\"\nkernel = \"cubic\"\n";
constexpr const char* mls = "transfer = \"mls\"\nkernel = \"quadratic\"\n";

struct BoxSize {
  double x, y, z;  ///< m
};
constexpr BoxSize large_box{1.0, 0.6, 0.5};    // 300 000 particles
constexpr BoxSize middle_box{0.4, 0.3, 0.25};  // 30 000
constexpr BoxSize small_box{0.2, 0.2, 0.1};    // 4000
constexpr BoxSize quick_box{0.16, 0.16, 0.16};

/// A box of the paper's snow that hits the floor within the first frame, 8 particles to a cell.
/// @param solver more keys of [solver]
scene::Scene falling_box(const BoxSize& size, const std::string& solver) {
  const std::string middle = scene::toml::number_text(0.03 + 0.5 * size.y);
  return scene::read_scene_text(
      "frames = 1\nfps = 24\n[solver]\ncell_size = 0.02\n"
      "time_step = \"fixed\"\ndt = 2e-4\n" +
          solver + "[[body]]\nshape = { box = { center = [0, " + middle + ", 0], size = [" +
          scene::toml::number_text(size.x) + ", " + scene::toml::number_text(size.y) + ", " +
          scene::toml::number_text(size.z) +
          "] } }\nvelocity = [0, -3, 0]\nsampling = \"lattice\"\n"
          "[[collider]]\nshape = { plane = { point = [0, 0, 0], "
          "normal = [0, 1, 0] } }\n[[view]]\nname = \"particles\"\n[output]\nsize = [640, 360]\n",
      "bench frame");
}

/// A box of snow that hits the floor, adaptive steps as long as motion and strain allow.
/// @param youngs_modulus Pa
scene::Scene stiff_box(const BoxSize& size, double youngs_modulus, bool is_implicit) {
  scene::Scene scene = falling_box(size, mls);
  scene.solver.time_step = sim::TimeStep::adaptive;
  scene.solver.max_dt = 4e-3;
  scene.solver.beta = is_implicit ? 1 : 0;
  scene.solver.collide_after_solve = true;
  scene.materials.front().youngs_modulus = youngs_modulus;
  return scene;
}

/// Objects needed to draw a scene.
class Drawing {
 public:
  Drawing(const std::string& backend, int threads)
      : context_(render::gl::open_context(backend)),
        pool_(threads),
        renderer_(*context_, {}, &pool_) {}

  /// Seconds until the picture of the simulation's state is in memory.
  double draw(const scene::Scene& scene, const sim::Simulation& simulation) {
    const Stopwatch watch;
    setup::SeededScene seeded;
    seeded.spacing = 0.5 * scene.solver.cell_size;
    const picture::FrameBuilder builder(scene, seeded);
    const picture::Snapshot snapshot = picture::take_snapshot(scene, scene.views, simulation, 1);
    renderer_.draw(builder.build(scene.views.front(), snapshot));
    return watch.wall();
  }

 private:
  std::unique_ptr<render::gl::Context> context_;
  ThreadPool pool_;
  render::Renderer renderer_;
};

class FrameBench {
 public:
  FrameBench(const BenchOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        rounds_(options.rounds_or(1, 3)),
        drawing_(options.backend, options.threads) {}
  std::vector<BenchRow> run();

 private:
  double simulate(const std::string& name, const scene::Scene& scene, int frames,
                  bool is_drawn = false);
  void coarsen_2();
  void dust();
  void implicit_steps();
  template <class Measure>
  void measure(const std::string& name, const std::string& unit, const Measure& once);

  BenchOptions options_;
  Progress& progress_;
  int rounds_;
  Drawing drawing_;
  /// Threads of the last simulation, for its row.
  int threads_ = 0;
  std::size_t particles_ = 0;
  std::string simd_;
  std::vector<BenchRow> rows_;
};

/// Adds a row that measures the same thing in every round.
template <class Measure>
void FrameBench::measure(const std::string& name, const std::string& unit, const Measure& once) {
  std::vector<double> samples;
  for (int round = 0; round < rounds_; ++round) {
    stop_if_interrupted();
    samples.push_back(once());
  }
  rows_.push_back({name, threads_, particles_, simd_, statistics_of(samples), unit});
  progress_.note(name + ": " + fixed_text(rows_.back().value.median, 3) + " " + unit);
}

/// Seconds that the frames take, from a fresh start; making the particles is not counted.
double FrameBench::simulate(const std::string& name, const scene::Scene& scene, int frames,
                            bool is_drawn) {
  sim::Simulation simulation(scene.solver, scene.materials, scene::sim_colliders(scene),
                             setup::seed_scene(scene).particles, options_.threads);
  threads_ = simulation.threads();
  particles_ = simulation.particle_count();
  simd_ = simulation.simd();
  double seconds = 0;
  for (int frame = 1; frame <= frames; ++frame) {
    const Stopwatch watch;
    simulation.advance_to(frame / scene.fps, is_interrupted);
    seconds += watch.wall();
    stop_if_interrupted();
    check_health(simulation, name);
  }
  return is_drawn ? seconds + drawing_.draw(scene, simulation) : seconds;
}

/// Simulation time of a scene in cells twice as large, over that of the scene itself.
void FrameBench::coarsen_2() {
  const scene::Scene full =
      scene::read_scene_file((default_scene().parent_path() / "snowball_drop.toml").string());
  scene::Scene coarse = full;
  scene::coarsen(coarse, 2);
  const int frames = options_.is_quick ? std::min(full.frames, 2) : full.frames;
  measure("coarsen_2", "of the full time", [&] {
    const double few = simulate("coarsen_2", coarse, frames);
    return few / simulate("coarsen_2", full, frames);
  });
}

/// Time of a powder avalanche with its cloud, simulated and drawn, over that of one without: by
/// programs of their own, in turns.
void FrameBench::dust() {
  const std::string scene = (default_scene().parent_path() / "powder_avalanche.toml").string();
  const std::string frames = options_.is_quick ? "4" : "60";
  const auto seconds = [&](const std::string& shed) {
    return seconds_of_render(
        "dust_time", ScratchFolder().path(), options_,
        {scene, "--frames", frames, "--set", "material.powder.dust=" + shed, "--no-movie",
         "--no-keep-states", "--checkpoint-every", "0", "--size", "1280x720"});
  };
  measure("dust_time", "x without", [&] { return seconds("0.008") / seconds("0"); });
}

/// The first frame by semi-implicit steps, and how many times longer explicit ones take.
void FrameBench::implicit_steps() {
  const BoxSize& size = options_.is_quick ? quick_box : middle_box;
  const double youngs_modulus = 1.4e5;  // stiffer snow breaks a rule in steps as long as these
  const scene::Scene by_solve = stiff_box(size, youngs_modulus, true);
  const scene::Scene by_force = stiff_box(size, youngs_modulus, false);
  const std::string row = "implicit_snow";
  std::vector<double> ratios;
  measure(row, "s", [&] {
    const double seconds = simulate(row, by_solve, 1);
    ratios.push_back(simulate(row, by_force, 1) / seconds);
    return seconds;
  });
  rows_.push_back(
      {row + "_gain", threads_, particles_, simd_, statistics_of(ratios), "x explicit"});
  progress_.note(rows_.back().name + ": " + fixed_text(rows_.back().value.median, 2));
}

std::vector<BenchRow> FrameBench::run() {
  const BoxSize& large = options_.is_quick ? quick_box : large_box;
  const scene::Scene flip_scene = falling_box(large, flip), mls_scene = falling_box(large, mls);
  scene::Scene small = falling_box(small_box, flip);
  setup::resolve(small, 4000);
  measure("flip_cubic_300k", "s", [&] { return simulate("flip_cubic_300k", flip_scene, 1); });
  measure("mls_quadratic_300k", "s", [&] { return simulate("mls_quadratic_300k", mls_scene, 1); });
  drawing_.draw(small, sim::Simulation(small.solver, small.materials, scene::sim_colliders(small),
                                       setup::seed_scene(small).particles,
                                       1));  // the first one compiles shaders
  measure("flip_cubic_4000_drawn", "s",
          [&] { return simulate("flip_cubic_4000_drawn", small, 1, true); });
  implicit_steps();
  dust();
  coarsen_2();
  // Last: its particles are those of the default scene, which the row before it simulated.
  measure("first_picture", "s", [&] {
    return seconds_of_render("first_picture", ScratchFolder().path(), options_, {"--frames", "0"});
  });
  return rows_;
}

}  // namespace

std::vector<BenchRow> bench_frame(const BenchOptions& options, Progress& progress) {
  FrameBench bench(options, progress);
  progress.note("neve bench frame");
  return bench.run();
}

}  // namespace neve::app::bench
