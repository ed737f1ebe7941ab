#include "app/compare/pair_pictures.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/scene/read.h"
#include "app/support/film_rate.h"
#include "app/support/round_number.h"
#include "app/support/text.h"
#include "app/timeline/timeline.h"

namespace neve::app::compare {

namespace {

/// Cells that snow is displaced by at the last colour: a range that does not depend on the frames,
/// so that all have one.
constexpr double cells_of_range = 10;

/// Share of the density of packed snow at which a difference is all red or all blue: the opacity
/// says how much it is.
constexpr double full_color = 0.05;
/// Opacity of differences as a factor of that of snow: they are thinner.
constexpr float opacity = 3;

bool has_mode(const std::vector<Mode>& modes, Mode mode) {
  return std::find(modes.begin(), modes.end(), mode) != modes.end();
}

double densest(const scene::Scene& scene) {
  double density = 0;
  for (const sim::Material& material : scene.materials)
    density = std::max(density, material.density);
  return density;
}

/// A without a trace of B's look: camera, light and view are those of A.
scene::Scene looked_at_as(const scene::Scene& look, scene::Scene scene) {
  scene.camera = look.camera;
  scene.light = look.light;
  scene.views = look.views;
  scene.mosaics.clear();
  scene.size = look.size;
  scene.background = look.background;
  return scene;
}

}  // namespace

PairPainter::PairPainter(const PairOptions& options, const Pair& pair, render::Renderer& renderer)
    : options_(options),
      pair_(pair),
      renderer_(renderer),
      view_(options.view.empty() ? pair.a.job.scene.views.front()
                                 : scene::find_view(pair.a.job.scene, options.view)),
      range_(options.range.value_or(round_up(cells_of_range * pair.a.job.scene.solver.cell_size))),
      full_density_(std::max(densest(pair.a.job.scene), densest(pair.b.job.scene))) {
  // The strip has the words.
  std::erase(view_.layers, scene::Layer::caption);
  // Both runs have one legend, so the ends of a frame would be those of one run alone.
  view_.slice.range_from = scene::RangeFrom::scene;
}

void PairPainter::check_sizes(const std::vector<Mode>& modes) const {
  const scene::PictureSize one = setup::size_of(pair_.a.job.scene, view_);
  const int largest = renderer_.max_size();
  setup::check_picture("a picture of one run", one, largest, "--size", "give a smaller --size");
  for (const Mode mode : modes) {
    if (mode == Mode::metrics) continue;
    const bool is_single = mode == Mode::wipe || mode == Mode::mass;
    setup::check_picture(
        std::string("the picture of --mode ") + name(mode), size_with_strip(one, is_single ? 1 : 2),
        largest, "--size",
        is_single ? "give a smaller --size" : "give a smaller --size, or --mode wipe");
  }
}

scene::View PairPainter::view_for(Mode mode) const {
  scene::View view = view_;
  if (mode != Mode::displacement && mode != Mode::mass) return view;
  view.layers = {scene::Layer::ground, scene::Layer::colliders};
  view.clip.reset();
  if (mode == Mode::displacement) view.layers.push_back(scene::Layer::particles);
  view.particles.color_by = scene::ColorBy::snow;
  return view;
}

PairPainter::Taken PairPainter::take_side(const timeline::Timeline& timeline,
                                          const std::vector<Mode>& modes) const {
  Taken taken;
  taken.scene = looked_at_as(pair_.a.job.scene, timeline.scene());
  taken.seeded = &timeline.seeded();
  std::vector<scene::View> views{view_};
  if (has_mode(modes, Mode::mass)) {
    scene::View mass = view_;
    mass.layers = {scene::Layer::smoke};
    mass.smoke.field = scene::ScalarField::mass;
    views.push_back(mass);
  }
  taken.snapshot = timeline::take_snapshot(timeline, taken.scene, views, 0);
  return taken;
}

void PairPainter::take(const timeline::Timeline& a, const timeline::Timeline& b,
                       const std::vector<Mode>& modes, PairMoment& moment) {
  a_ = take_side(a, modes);
  b_ = take_side(b, modes);
  a_.snapshot.frame = b_.snapshot.frame = scene::frame_of(a_.scene, moment.frame);
  if (has_mode(modes, Mode::displacement)) {
    displacement_ = displacement(a_.snapshot.particles, b_.snapshot.particles);
    moment.displacement = displacement_;
  }
  if (!has_mode(modes, Mode::mass)) return;
  mass_ = mass_difference(a_.snapshot.fields, b_.snapshot.fields);
  mass_.smoke.full_density = static_cast<float>(full_density_);
  mass_.smoke.density_scale = opacity;
  mass_.smoke.range_max = static_cast<float>(full_color * full_density_);
  mass_.smoke.range_min = -mass_.smoke.range_max;
  moment.mass = {mass_.more_in_a, mass_.more_in_b};
}

std::array<render::Frame, 2> PairPainter::frames_for(Mode mode) const {
  const scene::View view = view_for(mode);
  const auto build = [&](const Side& side, const Taken& taken) {
    const picture::PictureOptions options{.overrides = side.job.overrides,
                                          .coarsening = side.job.coarsening};
    return picture::FrameBuilder(taken.scene, *taken.seeded, options).build(view, taken.snapshot);
  };
  std::array<render::Frame, 2> frames{build(pair_.a, a_), build(pair_.b, b_)};
  // A camera that follows a body follows that of A in both.
  frames[1].camera = frames[0].camera;
  if (mode != Mode::displacement) return frames;
  for (std::size_t side = 0; side < 2; ++side) {
    const picture::Snapshot& other = side == 0 ? b_.snapshot : a_.snapshot;
    color_by_displacement(other.particles, range_, frames[side].points);
    frames[side].points.colormap = render::ColorMap::turbo;
  }
  frames[1].legends = {
      {"displacement", "m", render::ColorMap::turbo, 0, static_cast<float>(range_)}};
  frames[1].legends[0].has_higher_values = displacement_.largest > range_;
  return frames;
}

std::string PairPainter::line_for(Mode mode) const {
  std::string line = fmt::format("frame {}   t = {}", scene::number_of(a_.scene, a_.snapshot.frame),
                                 time_text(a_.snapshot.time, a_.scene.fps));
  if (mode == Mode::displacement && displacement_.in_both == 0) line += "   no snow is in both";
  if (mode == Mode::displacement && displacement_.in_both > 0)
    line += fmt::format("   displaced by {} m on average, {} m at most",
                        rough_text(displacement_.mean), rough_text(displacement_.largest));
  if (mode == Mode::mass)
    line += fmt::format("   blue: {} kg only in A   red: {} kg only in B",
                        rough_text(mass_.more_in_a), rough_text(mass_.more_in_b));
  return line;
}

render::Image PairPainter::draw_with_words(std::vector<render::Image> images, Mode mode) const {
  for (render::Image& image : images) image = opaque(std::move(image));
  const auto words_of = [](const char* name, const Side& side) {
    return StripWords{name + side.job.scene_file, side.values};
  };
  return with_strip(images, {words_of("A   ", pair_.a), words_of("B   ", pair_.b)}, line_for(mode),
                    renderer_);
}

render::Image PairPainter::draw(Mode mode) const {
  std::array<render::Frame, 2> frames = frames_for(mode);
  if (mode == Mode::mass) {
    frames[0].smoke = mass_.smoke;
    return draw_with_words({renderer_.draw(frames[0])}, mode);
  }
  render::Image a = renderer_.draw(frames[0]), b = renderer_.draw(frames[1]);
  if (mode == Mode::wipe)
    return draw_with_words({wiped(opaque(std::move(a)), opaque(std::move(b)), options_.wipe)},
                           mode);
  return draw_with_words({std::move(a), std::move(b)}, mode);
}

}  // namespace neve::app::compare
