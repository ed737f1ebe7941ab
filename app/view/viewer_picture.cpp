/// The picture between the panels: its contents, and when it is drawn again.

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/output/atomic_file.h"
#include "app/picture/frame_builder.h"
#include "app/scene/names.h"
#include "app/setup/camera_path.h"
#include "app/support/clock.h"
#include "app/support/round_number.h"
#include "app/view/viewer.h"
#include "render/frame/compose.h"

namespace neve::app::view {

namespace {

/// s; a picture that takes longer is drawn smaller while it moves. As much again is for panels,
/// encoding, and the simulation behind it: 30 pictures a second.
constexpr double quick_enough = 1.0 / 60;
constexpr double smallest_scale = 0.45;

}  // namespace

StateKey Viewer::state_key() const {
  return {bench_.document().scene(), state_.live->number, state_.shows_incident, state_.view};
}

PictureKey Viewer::picture_key() const {
  return {state_key(), state_.viewport.width, state_.viewport.height, state_.orbit,
          state_.is_camera_of_scene};
}

/// A picture that cannot be drawn is a message, and the one before stays.
void Viewer::paint_picture() {
  try {
    paint_new_picture();
  } catch (const std::exception& error) {
    points_of_.reset();
    painted_ = picture_key();  // not again before something changes
    painted_number_ = state_.live->number;
    bench_.session().taken(state_.live->number);
    bench_.say(session::Message::Kind::error, std::string("no picture: ") + error.what());
  }
}

/// The sheet of the sweep in the place of the picture, whole. @return false where none is to be
/// shown, or it cannot be read, which is a message
bool Viewer::show_sheet() {
  // Pictures that are to be kept have to be painted.
  if (state_.is_recording || state_.wants_picture) state_.sweep.shows_sheet = false;
  if (!state_.sweep.shows_sheet) {
    sheet_file_.clear();
    return false;
  }
  const std::filesystem::path file = bench_.sweep().progress().sheet();
  const render::PicturePlace& p = state_.viewport;
  try {
    if (file != sheet_file_ || sheet_room_ != std::pair(p.width, p.height)) {
      const render::Image whole = render::decode_png(output::read_file(file));
      const double scale = std::min({1.0, static_cast<double>(p.width) / whole.width,
                                     static_cast<double>(p.height) / whole.height});
      const int width = std::max(1, static_cast<int>(scale * whole.width)),
                height = std::max(1, static_cast<int>(scale * whole.height));
      sheet_ =
          render::compose(width, height, {0, 0, 0}, {{0, 0, render::shrink(whole, width, height)}});
      sheet_room_ = {p.width, p.height};
    }
  } catch (const std::exception& error) {
    state_.sweep.shows_sheet = false;
    bench_.say(session::Message::Kind::error, std::string("no sheet: ") + error.what());
    return false;
  }
  sheet_file_ = file;
  screen_.end(sheet_, {p.x + (p.width - sheet_.width) / 2, p.y + (p.height - sheet_.height) / 2,
                       sheet_.width, sheet_.height});
  return true;
}

/// The camera of the scene at this moment, for a picture of the viewport's shape.
void Viewer::follow_camera() {
  if (!state_.is_camera_of_scene) return;
  const scene::Scene& scene = *state_.live->scene;
  const scene::View& view = panels::current_view(state_);
  const scene::CameraSettings settings =
      view.camera ? *view.camera : *bench_.document().scene()->camera;
  scene::View placed = view;
  placed.camera = settings;
  const setup::CameraPlace place =
      picture::camera_place(scene, placed, *state_.live->seeded, state_.live->snapshot);
  const scene::PictureSize framed = setup::size_of(*bench_.document().scene(), view);
  const double narrower = (static_cast<double>(framed.width) / framed.height) /
                          (static_cast<double>(state_.viewport.width) / state_.viewport.height);
  // A narrow picture is taken from further away, with the same left and right: a wider angle
  // would stay, as a fish-eye, when the window grows.
  const sim::Vec3d eye = place.target + std::max(1.0, narrower) * (place.eye - place.target);
  state_.orbit = panels::Orbit(eye, place.target, settings.up, place.fov);
}

void Viewer::paint_new_picture() {
  follow_camera();
  const bool is_moving = seconds_since(moved_at_) < still_after;
  double scale = 1;
  if (is_moving && full_seconds_ > quick_enough)
    scale = std::clamp(std::sqrt(quick_enough / full_seconds_), smallest_scale, 1.0);
  PictureKey key = picture_key();
  if (key == painted_ && scale <= scale_) return;
  if (!has_what_is_shown()) return;
  const auto start = Clock::now();
  const scene::PictureSize size{
      std::max(16, static_cast<int>(std::lround(scale * state_.viewport.width))),
      std::max(16, static_cast<int>(std::lround(scale * state_.viewport.height)))};
  scene::View view = shown_view();
  view.size = size;
  view.camera = state_.orbit.settings();
  view.background = scene::Background::gradient;  // there is nothing behind the picture
  render::Frame frame = picture_frame(view);
  frame.font_size = std::max(8, static_cast<int>(std::lround(scale * font_size())));
  // Snow may be near: the scene's own camera keeps it out of the corner.
  frame.has_caption_plate = !state_.is_camera_of_scene;
  renderer_.paint(frame);
  keep_points(std::move(frame.points));
  bench_.session().taken(state_.live->number);
  if (scale >= 1) full_seconds_ = seconds_since(start);
  scale_ = scale;
  painted_number_ = state_.live->number;
  painted_ = std::move(key);
}

bool Viewer::has_what_is_shown() const {
  return picture::has_all(state_.live->snapshot, shown_view());
}

/// The current view; inside a step its arrows show the result of the stage.
scene::View Viewer::shown_view() const {
  scene::View view = panels::current_view(state_);
  // Single nodes are shown around what is looked at.
  if (state_.live->probe) view.slice.dense_near = state_.live->probe->place;
  const std::vector<scene::View>& asked = state_.live->scene->views;
  if (state_.live->stage && !asked.empty() && asked.front().name == view.name) {
    view.slice.field = asked.front().slice.field;
    // Forces differ by orders of magnitude from step to step, and from the nodes that are pressed
    // to all others, whose arrows would be dots beside the largest.
    constexpr double of_the_mean = 6;
    const std::string name =
        view.slice.field == scene::VectorField::velocity ? "v_old" : scene::name(view.slice.field);
    view.slice.range = asked.front().slice.range;
    for (const session::QuantitySummary& quantity : state_.live->stage->quantities)
      if (quantity.name == name && quantity.magnitudes.greatest > 0)
        view.slice.range =
            scene::Range{0, round_up(std::min(quantity.magnitudes.greatest,
                                              of_the_mean * quantity.magnitudes.mean))};
  }
  return view;
}

void Viewer::keep_points(render::Points points) {
  points_ = std::move(points);
  points_of_ = state_key();
}

render::Frame Viewer::picture_frame(const scene::View& view) {
  const session::LiveFrame& live = *state_.live;
  const scene::Scene scene = bench_.display_scene(live);
  const picture::FrameBuilder builder(
      scene, *live.seeded,
      {setup::Quality::preview, bench_.overrides(live), bench_.document().whole_coarsening()});
  std::optional<render::Points> points;
  if (points_of_ == state_key()) points = std::move(points_);
  points_of_.reset();
  if (live.divergence && live.diagnosis && state_.shows_incident)
    return builder.build_incident(view, live.snapshot, *live.divergence, *live.diagnosis,
                                  std::move(points));
  return builder.build(view, live.snapshot, std::move(points));
}

}  // namespace neve::app::view
