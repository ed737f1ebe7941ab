#include "app/view/viewer.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/camera_path.h"
#include "app/frame_builder.h"
#include "app/interrupt.h"
#include "app/output/atomic_file.h"
#include "app/output/run_json.h"
#include "app/output/sequence.h"
#include "app/round_number.h"
#include "app/scene/names.h"
#include "app/view/labels.h"

namespace neve::app {

namespace {

constexpr double idle_wait = 0.5;          // s; between looks at Ctrl-C and at the file
constexpr double quick_enough = 1.0 / 30;  // s; a picture that takes longer is drawn smaller
constexpr double still_after = 0.25;       // s without a move
constexpr double smallest_scale = 0.45;
constexpr auto file_interval = std::chrono::seconds(1);

double seconds_of_wall(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

int font_size_of(const ScreenSize& size) {
  return std::clamp(static_cast<int>(std::lround(14 * size.scale)), 11, 48);
}

/// Whether all that the view shows was worked out for this moment: a view that was just chosen has
/// to wait for the session.
bool has_all(const Snapshot& snapshot, const View& view) {
  Scene scene;
  scene.views = {view};
  const FieldNeeds needs = field_needs(scene);
  const auto& fields = snapshot.fields;
  return (!needs.is_needed || fields.lattice) &&
         (!needs_stress(scene) || !snapshot.kirchhoff.empty()) &&
         std::all_of(needs.scalars.begin(), needs.scalars.end(),
                     [&](ScalarField field) { return fields.scalars.contains(field); }) &&
         std::all_of(needs.vectors.begin(), needs.vectors.end(),
                     [&](VectorField field) { return fields.vectors.contains(field); });
}

/// Vertical angle of view of a picture that many times narrower, with the same left and right.
double widened(double fov, double narrower) {
  constexpr double radians = 3.14159265358979323846 / 180;
  return 2 * std::atan(narrower * std::tan(0.5 * fov * radians)) / radians;
}

/// @param scale px per point, of every distance
void style_panels(float scale) {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.085f, 0.095f, 0.12f, 1);
  style.Colors[ImGuiCol_FrameBg] = ImVec4(0.16f, 0.18f, 0.22f, 1);
  style.Colors[ImGuiCol_Button] = ImVec4(0.20f, 0.23f, 0.29f, 1);
  style.Colors[ImGuiCol_PlotHistogram] = ImVec4(0.24f, 0.45f, 0.70f, 1);
  style.Colors[ImGuiCol_Header] = ImVec4(0.18f, 0.27f, 0.38f, 1);
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
}

}  // namespace

Viewer::Viewer(Workbench& bench, Front& front, render::Screen& screen, render::Renderer& renderer,
               const ViewerOptions& options)
    : bench_(bench),
      front_(front),
      screen_(screen),
      renderer_(renderer),
      options_(options),
      input_((screen.select_panels(), front)),
      state_{.bench = bench} {
  state_.view = options.view.value_or(bench.document().scene()->views.front().name);
  state_.copy = [this](const std::string& text) { front_.set_clipboard(text); };
  announce_view(state_);
  if (options.is_running) bench_.session().run();
}

void Viewer::run() {
  while (!is_closed_ && !is_interrupted()) {
    const bool is_busy = settle_ > 0 || state_.is_playing || !is_still();
    take_events(front_.wait(is_busy ? (options_.has_own_clock ? 0 : 1.0 / 60) : idle_wait));
    if (is_closed_) break;
    if (!front_.is_ready()) continue;
    const std::uint64_t before = state_.live ? state_.live->number : 0;
    take_live_frame();
    show_news();
    const bool is_more = input_.feed();
    const bool is_new = state_.live->number != before;
    if (!is_busy && !is_new && !has_input_ && !front_.is_picture_wanted()) continue;
    if (has_input_ || is_more) settle_ = 3;
    has_input_ = false;
    draw();
    settle_ = is_more ? 3 : std::max(0, settle_ - 1);
    if (options_.most_pictures > 0 && ++pictures_ >= options_.most_pictures) break;
  }
  if (state_.is_recording) bench_.session().set_recording(false);
  writer_.finish();
}

void Viewer::take_events(std::vector<InputEvent> events) {
  has_input_ = has_input_ || !events.empty();
  for (const InputEvent& event : events) {
    if (event.kind == InputEvent::Kind::close) is_closed_ = true;
    if (event.kind == InputEvent::Kind::drop) take_drop(event.text);
  }
  input_.push(std::move(events));
}

/// The present run goes on when the file is no scene.
void Viewer::take_drop(const std::string& file) {
  try {
    open_document(file, {}, 1);
    state_.dropped_file = file;
    is_closed_ = true;
  } catch (const std::exception& error) {
    bench_.say(Message::Kind::error, error.what());
    state_.panels.right = true;
    state_.go_to_tab = tab::messages;
  }
}

void Viewer::take_live_frame() {
  const std::shared_ptr<const LiveFrame> live = bench_.session().latest();
  if (state_.live && live->number == state_.live->number) return;
  state_.live = live;
  if (live->probe) {
    ProbeTrace& trace = state_.trace;
    if (trace.quantity.empty() && !live->probe->rows.empty())
      trace.quantity = live->probe->is_node ? live->probe->rows.front().name : "v";
    for (const ProbeRow& row : live->probe->rows) {
      if (row.name != trace.quantity) continue;
      while (!trace.points.empty() && trace.points.back().first >= live->snapshot.time)
        trace.points.pop_back();
      trace.points.emplace_back(live->snapshot.time, row.magnitude);
    }
  }
  follow();
}

/// What went wrong since the last picture becomes a message, and its tab is opened.
void Viewer::show_news() {
  const LiveFrame& live = *state_.live;
  if (live.errors != state_.errors_seen) {
    state_.errors_seen = live.errors;
    bench_.say(Message::Kind::error, live.error);
    state_.go_to_tab = tab::messages;
  }
  if (!live.divergence) {
    state_.is_divergence_told = state_.shows_incident = false;
  } else if (!state_.is_divergence_told) {
    state_.is_divergence_told = true;
    state_.panels.right = true;
    state_.go_to_tab = tab::messages;
  }
  const auto now = Clock::now();
  if (now - file_looked_at_ < file_interval) return;
  file_looked_at_ = now;
  const bool has_changed = bench_.has_file_changed();
  if (has_changed && !state_.is_reload_offered) settle_ = 3;
  state_.is_reload_offered = has_changed;
}

void Viewer::follow() {
  if (!state_.follows_probe || !state_.live->probe) {
    state_.last_followed.reset();
    return;
  }
  const sim::Vec3d place = state_.live->probe->place;
  if (state_.last_followed)
    state_.orbit.move_target(state_.orbit.target() + place - *state_.last_followed);
  state_.last_followed = place;
  state_.is_camera_of_scene = false;
}

bool Viewer::is_still() const {
  return scale_ >= 1 || state_.live->is_running;
}

double Viewer::seconds_passed() {
  const auto now = Clock::now();
  const double passed = options_.has_own_clock ? 1.0 / 60 : seconds_of_wall(now - drawn_at_);
  drawn_at_ = now;
  return std::clamp(passed, 1e-4, 0.25);
}

void Viewer::draw() {
  const auto start = Clock::now();
  const ScreenSize size = front_.size();
  const double passed = seconds_passed();
  if (size.scale != styled_scale_) {
    screen_.select_panels();
    style_panels(size.scale);
    styled_scale_ = size.scale;
  }
  play(passed);
  const Orbit camera_before = state_.orbit;
  lay_out();
  // Panels are laid out and used first: what they change is in this picture already.
  screen_.begin(size.width, size.height, font_size_of(size), static_cast<float>(passed));
  draw_panels();
  if (!(camera_before == state_.orbit)) {
    moved_at_ = Clock::now();
    settle_ = 3;
  }
  paint_picture();
  screen_.end(renderer_, state_.viewport);
  if (state_.wants_picture && has_picture_to_save()) save_picture();
  front_.set_progress(state_.live->frame, state_.live->is_running);
  front_.show(screen_);
  const double took = seconds_of_wall(Clock::now() - start);
  state_.picture_ms = 1e3 * took;
  state_.frames_per_second = 0.9 * state_.frames_per_second + 0.1 / std::max(passed, 1e-3);
}

/// What the picture shows, from wherever it is seen.
std::string Viewer::state_key() const {
  char text[120];
  std::snprintf(
      text, sizeof text, "%p %llu %d ", static_cast<const void*>(bench_.document().scene().get()),
      static_cast<unsigned long long>(state_.live->number), state_.shows_incident ? 1 : 0);
  return text + state_.view;
}

/// Everything that the picture depends on.
std::string Viewer::picture_key() const {
  const sim::Vec3d eye = state_.orbit.eye(), target = state_.orbit.target();
  char text[400];
  std::snprintf(text, sizeof text, " %d %d %a %a %a %a %a %a %a %d", state_.viewport.width,
                state_.viewport.height, eye.x(), eye.y(), eye.z(), target.x(), target.y(),
                target.z(), state_.orbit.fov(), state_.is_camera_of_scene ? 1 : 0);
  return state_key() + text;
}

void Viewer::paint_picture() {
  if (state_.is_camera_of_scene) {
    const Scene& scene = *state_.live->scene;
    const View& view = current_view(state_);
    const CameraSettings settings = view.camera ? *view.camera : *bench_.document().scene()->camera;
    const CameraPlace place =
        camera_at(settings, state_.live->snapshot.time, scene.frames / scene.fps);
    const PictureSize framed = size_of(*bench_.document().scene(), view);
    const double narrower = (static_cast<double>(framed.width) / framed.height) /
                            (static_cast<double>(state_.viewport.width) / state_.viewport.height);
    state_.orbit =
        Orbit(place.eye, place.target, settings.up, widened(place.fov, std::max(1.0, narrower)));
  }
  const bool is_moving = seconds_of_wall(Clock::now() - moved_at_) < still_after;
  double scale = 1;
  if (is_moving && full_seconds_ > quick_enough)
    scale = std::clamp(std::sqrt(quick_enough / full_seconds_), smallest_scale, 1.0);
  const std::string key = picture_key();
  if (key == painted_key_ && scale <= scale_) return;
  if (!has_all(state_.live->snapshot, shown_view())) return;
  const auto start = Clock::now();
  const PictureSize size{
      std::max(16, static_cast<int>(std::lround(scale * state_.viewport.width))),
      std::max(16, static_cast<int>(std::lround(scale * state_.viewport.height)))};
  render::Frame frame = picture_frame(size);
  frame.font_size = std::max(8, static_cast<int>(std::lround(scale * font_size_of(front_.size()))));
  renderer_.paint(frame);
  keep_points(std::move(frame.points));
  bench_.session().taken(state_.live->number);
  if (scale >= 1) full_seconds_ = seconds_of_wall(Clock::now() - start);
  scale_ = scale;
  painted_number_ = state_.live->number;
  painted_key_ = key;
  if (state_.is_recording) record_frame();
}

/// The current view; inside a step its arrows are what the stage has just worked out.
View Viewer::shown_view() const {
  View view = current_view(state_);
  const std::vector<View>& asked = state_.live->scene->views;
  if (state_.live->stage && !asked.empty() && asked.front().name == view.name) {
    view.slice.field = asked.front().slice.field;
    // Forces differ by orders of magnitude from step to step: the longest arrow is the largest.
    const std::string name =
        view.slice.field == VectorField::velocity ? "v_old" : name_of(view.slice.field);
    view.slice.range = asked.front().slice.range;
    for (const QuantitySummary& quantity : state_.live->stage->quantities)
      if (quantity.name == name && quantity.max > 0)
        view.slice.range = Range{0, round_up(quantity.max)};
  }
  return view;
}

void Viewer::keep_points(render::Points points) {
  points_ = std::move(points);
  points_key_ = state_key();
}

render::Frame Viewer::picture_frame(const PictureSize& size) {
  const LiveFrame& live = *state_.live;
  Scene scene = bench_.display_scene(live);
  View view = shown_view();
  view.size = size;
  view.background = Background::gradient;
  view.camera = state_.orbit.settings();
  scene.views = {view};
  const FrameBuilder builder(scene, live.spacing, Quality::preview, bench_.overrides(),
                             bench_.document().coarsening(), live.body_end);
  std::optional<render::Points> points;
  if (points_key_ == state_key()) points = std::move(points_);
  points_key_.clear();
  if (live.divergence && live.diagnosis && state_.shows_incident)
    return builder.build_incident(view, live.snapshot, *live.divergence, *live.diagnosis,
                                  std::move(points));
  return builder.build(view, live.snapshot, std::move(points));
}

void Viewer::lay_out() {
  const ScreenSize size = front_.size();
  const auto unit = static_cast<float>(font_size_of(size));
  const int bar = static_cast<int>(2.6f * unit), line = static_cast<int>(2.6f * unit);
  const bool has_panels = state_.panels.left || state_.panels.right;
  const int left = state_.panels.left ? std::min(size.width / 3, static_cast<int>(23 * unit)) : 0;
  const int right = state_.panels.right ? std::min(size.width / 3, static_cast<int>(24 * unit)) : 0;
  const int top = has_panels ? bar : 0, bottom = has_panels ? line : 0;
  state_.viewport = {left, top, std::max(16, size.width - left - right),
                     std::max(16, size.height - top - bottom)};
}

void Viewer::draw_panels() {
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const render::PicturePlace& p = state_.viewport;
  const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y),
             w = static_cast<float>(p.width), h = static_cast<float>(p.height);
  constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                     ImGuiWindowFlags_NoSavedSettings |
                                     ImGuiWindowFlags_NoBringToFrontOnFocus;
  const auto window = [&](const char* name, ImVec2 at, ImVec2 size, auto draw_inside,
                          ImGuiWindowFlags flags = 0) {
    if (size.x < 1 || size.y < 1) return;
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
    if (ImGui::Begin(name, nullptr, fixed | flags)) draw_inside();
    ImGui::End();
  };
  const auto bar = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  window(
      "transport", ImVec2(0, 0), ImVec2(all.x, y), [&] { draw_transport(state_); }, bar);
  window("left", ImVec2(0, y), ImVec2(x, all.y - y), [&] { draw_left_column(state_); });
  window("right", ImVec2(x + w, y), ImVec2(all.x - x - w, all.y - y),
         [&] { draw_right_column(state_); });
  window(
      "time", ImVec2(x, y + h), ImVec2(w, all.y - y - h), [&] { draw_time_line(state_); }, bar);
  draw_offer(state_);
  draw_help(state_);
  use_viewport(state_);
  use_keys(state_);
}

void Viewer::play(double passed) {
  if (!state_.is_playing) return;
  const LiveFrame& live = *state_.live;
  state_.play_clock += passed * live.scene->fps;
  if (state_.play_clock < 1 || painted_number_ != live.number) return;
  const int wanted = live.frame + static_cast<int>(state_.play_clock);
  state_.play_clock = 0;
  const auto next = std::lower_bound(live.kept.begin(), live.kept.end(), wanted);
  if (next == live.kept.end() || *next >= live.head) {
    bench_.session().show_head();
    state_.is_playing = false;
  } else {
    bench_.session().show_frame(*next);
  }
}

/// Pictures can be made again where they belong to a frame: one that is asked for between two is
/// that of the next.
bool Viewer::has_picture_to_save() {
  const LiveFrame& live = *state_.live;
  if (live.is_frame_end && painted_number_ == live.number && !(goes_on_ && live.is_running))
    return true;
  if (live.divergence) return true;  // there is no next one
  if (!is_going_to_frame_ && !live.is_frame_end) {
    is_going_to_frame_ = true;
    goes_on_ = live.is_running;
    bench_.session().next_frame();
  }
  settle_ = 3;
  return false;
}

/// The current view at its own size, with all that makes it again.
Picture Viewer::picture_to_keep(const std::filesystem::path& file) {
  const LiveFrame& live = *state_.live;
  View view = current_view(state_);
  if (!state_.is_camera_of_scene) view.camera = state_.orbit.settings();
  const PictureSize size = size_of(*bench_.document().scene(), view);
  view.size = size;
  PictureRecord record = bench_.picture_record(live, view);
  record.state_hash = hash_text(live.state_hash);
  painted_key_.clear();  // another picture takes the place of the one on the screen
  return {file, renderer_.draw(picture_frame(size)), to_png_text(record)};
}

void Viewer::save_picture() {
  state_.wants_picture = false;
  if (goes_on_) bench_.session().run();
  is_going_to_frame_ = goes_on_ = false;
  const LiveFrame& live = *state_.live;
  char number[32];
  std::snprintf(number, sizeof number, "%04d_step%zu.png", live.frame, live.steps);
  const std::filesystem::path file = bench_.folder() / (current_view(state_).name + "_" + number);
  try {
    const Picture picture = picture_to_keep(file);
    make_folder(bench_.folder());
    write_file(file, render::encode_png(picture.image, picture.text));
    bench_.say(Message::Kind::note,
               "saved " + file.string() + "; neve render " + file.string() + " makes it again");
  } catch (const std::exception& error) {
    bench_.say(Message::Kind::error, std::string("no picture: ") + error.what());
  }
  state_.go_to_tab = tab::messages;
  settle_ = 3;
}

/// Every frame once.
void Viewer::record_frame() {
  const LiveFrame& live = *state_.live;
  if (!live.is_frame_end || live.frame == recorded_frame_) return;
  recorded_frame_ = live.frame;
  try {
    const std::string& view = current_view(state_).name;
    make_folder(bench_.folder() / view);
    writer_.write(picture_to_keep(frame_path(bench_.folder(), view, live.frame)));
    ++state_.recorded;
  } catch (const std::exception& error) {
    bench_.say(Message::Kind::error, std::string("recording stopped: ") + error.what());
    state_.is_recording = false;
    bench_.session().set_recording(false);
  }
}

}  // namespace neve::app
