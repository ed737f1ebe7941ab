#include "app/bench/bench.h"

#include <cmath>

#include "app/bench/measure.h"
#include "app/output/atomic_file.h"
#include "app/support/machine.h"
#include "app/view/viewer.h"
#include "render/gl/context.h"
#include "render/image/jpeg.h"
#include "sim/kernels/simd.h"

namespace neve::app::bench {

namespace {

/// 97336 particles, as in bench sim: a ball that falls into a box of snow.
constexpr const char* viewed_scene = R"(
title = "bench"
frames = 1000
[solver]
cell_size = 0.02
[[body]]
name = "ball"
shape = { sphere = { center = [0, 0.62, 0], radius = 0.2 } }
velocity = [0, -3, 0]
[[body]]
name = "slab"
shape = { box = { center = [0, 0.132, 0], size = [0.8, 0.1, 0.8] } }
[[collider]]
shape = { plane = { point = [0, 0.08, 0], normal = [0, 1, 0] } }
[camera]
eye = [1.6, 1.1, 2.2]
target = [0, 0.25, 0]
)";

constexpr int picture_width = 960, picture_height = 540;

/// Input of a user who drags the camera without pause; every picture is shown at once.
class BenchFrontend : public view::frontend::Frontend {
 public:
  explicit BenchFrontend(int pictures) : pictures_(pictures) {}

  std::string where() const override { return "bench"; }
  view::frontend::ScreenSize size() const override { return {picture_width, picture_height, 1}; }

  std::vector<view::frontend::InputEvent> wait(double) override {
    asked_ = Stopwatch();
    std::vector<view::frontend::InputEvent> events;
    view::frontend::InputEvent event;
    event.x = 480 + 200 * std::sin(0.05f * static_cast<float>(shown_));
    event.y = 270 + 60 * std::cos(0.08f * static_cast<float>(shown_));
    if (shown_ == 0) {
      view::frontend::InputEvent hide;  // the panels: all of the window is picture
      hide.kind = view::frontend::InputEvent::Kind::key;
      hide.key = view::frontend::key::tab;
      hide.is_down = true;
      events.push_back(hide);
      hide.is_down = false;
      events.push_back(hide);
    }
    if (shown_ == 8) {
      event.kind = view::frontend::InputEvent::Kind::button;
      event.is_down = true;
    }
    if (shown_ >= pictures_) event.kind = view::frontend::InputEvent::Kind::close;
    events.push_back(event);
    return events;
  }
  void wake() override {}
  bool is_ready() const override { return true; }
  bool is_picture_wanted() const override { return true; }
  void show(render::Screen& screen) override {
    const render::Image image = screen.pixels();
    bytes_ += render::encode_jpeg(image, 80, false).size();
    if (++shown_ > warm_up) {
      answers_.push_back(asked_.wall());
      if (shown_ == warm_up + 1) measured_ = Stopwatch();
    }
  }
  void set_clipboard(const std::string&) override {}
  std::string clipboard() const override { return {}; }

  double pictures_per_second() const {
    return static_cast<double>(shown_ - warm_up - 1) / seconds_;
  }
  void stop_clock() { seconds_ = measured_.wall(); }
  const std::vector<double>& answers() const { return answers_; }

 private:
  static constexpr int warm_up = 12;
  int pictures_, shown_ = 0;
  std::size_t bytes_ = 0;
  double seconds_ = 1;
  Stopwatch asked_, measured_;
  std::vector<double> answers_;
};

/// @param suffix  of its rows
void measure_view(const std::string& file, const BenchOptions& options, bool is_running,
                  const std::string& suffix, RowSamples& rows) {
  const auto context = render::gl::open_context(options.backend);
  ThreadPool pool(options.threads);
  render::Renderer renderer(*context, {}, &pool);
  render::Screen screen(*context);
  BenchFrontend front(options.is_quick ? 30 : 150);
  view::session::WorkbenchOptions bench_options;
  bench_options.session.threads = options.threads;
  view::session::Workbench bench(view::session::open_document(file, {}, 1).document, bench_options,
                                 {});
  view::ViewerOptions viewer_options;
  viewer_options.is_running = is_running;
  view::Viewer viewer(bench, front, screen, renderer, viewer_options);
  viewer.run();
  front.stop_clock();
  stop_if_interrupted();
  const auto add = [&](const char* name, double sample, const char* unit) {
    rows.add({name + suffix,
              core_count(options.threads),
              viewer.state().live->snapshot.particles.x.size(),
              sim::kernels::name(sim::kernels::chosen_simd_level()),
              {},
              unit},
             sample);
  };
  add("frames_per_second", front.pictures_per_second(), "1/s");
  add("input_to_picture", 1e3 * statistics_of(front.answers()).median, "ms");
}

}  // namespace

std::vector<BenchRow> bench_view(const BenchOptions& options, Progress& progress) {
  const ScratchFolder scratch;
  const std::string file = (scratch.path() / "scene.toml").string();
  output::write_file(file, viewed_scene);
  const int rounds = options.rounds_or(1, 3);
  RowSamples rows;
  for (int k = 0; k < rounds; ++k) {
    progress.line("round " + std::to_string(k + 1) + " of " + std::to_string(rounds));
    measure_view(file, options, true, "", rows);
    measure_view(file, options, false, "_paused", rows);
  }
  progress.clear();
  return rows.rows();
}

}  // namespace neve::app::bench
