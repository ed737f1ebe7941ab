#include "app/view/viewer.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "app/support/clock.h"
#include "app/support/interrupt.h"
#include "app/view/panels/beside.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/style.h"
#include "app/view/panels/tip.h"

namespace neve::app::view {

namespace {

/// More input waits in its device: it is taken as fast as pictures are drawn.
constexpr std::size_t max_waiting_input = 64;
constexpr double idle_wait = 0.5;  // s; between looks at Ctrl-C and at the file
constexpr float narrow = 64;       // text sizes; in less there is room for one column
constexpr auto file_interval = std::chrono::seconds(1);

}  // namespace

Viewer::Viewer(session::Workbench& bench, frontend::Frontend& front, render::Screen& screen,
               render::Renderer& renderer, const ViewerOptions& options)
    : bench_(bench),
      front_(front),
      screen_(screen),
      renderer_(renderer),
      options_(options),
      input_((screen.select_panels(), front)),
      state_{.bench = bench},
      take_{.folder = bench.folder()} {
  state_.view = options.view.value_or(bench.document().scene()->views.front().name);
  state_.copy = [this](const std::string& text) { front_.set_clipboard(text); };
  if (front_.takes_files())
    state_.download = [this](const std::filesystem::path& file) { download(file); };
  announce_view();
  if (options.is_running) bench_.session().run();
}

void Viewer::run() {
  while (!is_closed_ && !is_interrupted()) {
    const bool is_busy = settle_ > 0 || state_.is_playing || !is_still() ||
                         panels::is_tip_coming() || state_.hint.seconds > 0;
    front_.hold_input(input_.waiting() >= max_waiting_input);
    take_events(front_.wait(is_busy ? (options_.has_own_clock ? 0 : 1.0 / 60) : idle_wait));
    if (is_closed_) break;
    // A recording has every frame, seen or not: the simulation waits until each is drawn.
    const bool is_seen = front_.is_ready();
    if (!is_seen && !state_.is_recording) continue;
    const std::uint64_t before = state_.live ? state_.live->number : 0;
    take_live_frame();
    show_news();
    const bool is_new = state_.live->number != before;
    if (!is_seen && !is_new) continue;
    const bool is_more = input_.feed();
    if (!is_busy && !is_new && !has_input_ && !front_.is_picture_wanted()) continue;
    if (has_input_ || is_more) settle_ = 3;
    has_input_ = false;
    draw();
    settle_ = is_more ? 3 : std::max(0, settle_ - 1);
    if (options_.max_pictures > 0 && ++pictures_ >= options_.max_pictures) break;
  }
  if (state_.is_recording) bench_.session().set_recording(false);
  stop_recording();
}

void Viewer::take_events(std::vector<frontend::InputEvent> events) {
  has_input_ = has_input_ || !events.empty();
  for (const frontend::InputEvent& event : events) {
    if (event.kind == frontend::InputEvent::Kind::close) is_closed_ = true;
    if (event.kind == frontend::InputEvent::Kind::drop) take_drop(event.text);
  }
  input_.push(std::move(events));
}

/// The current run continues if the file is not a scene, or one that is too large.
void Viewer::take_drop(const std::string& file) {
  try {
    session::Opened opened = session::open_document(file, {}, bench_.document().coarsening());
    bench_.document().require_room_for(opened.document);
    state_.dropped = std::move(opened);
    is_closed_ = true;
  } catch (const std::exception& error) {
    bench_.say(session::Message::Kind::error, error.what());
  }
}

void Viewer::take_live_frame() {
  const std::shared_ptr<const session::LiveFrame> live = bench_.session().latest();
  if (state_.live && live->number == state_.live->number) return;
  record_due();
  state_.live = live;
  follow_run();
  state_.trace.take(*live);
  follow();
}

/// Turns errors since the last picture into messages, and opens their tab.
void Viewer::show_news() {
  const session::LiveFrame& live = *state_.live;
  if (bench_.sweep().poll()) settle_ = 3;
  if (live.errors != state_.errors_seen) {
    state_.errors_seen = live.errors;
    bench_.say(session::Message::Kind::error, live.error);
  }
  // Nothing moves away below a drag or a text that is being typed.
  if (bench_.errors_said() != state_.errors_told && !ImGui::IsAnyItemActive()) {
    state_.errors_told = bench_.errors_said();
    state_.panels.right = true;
    state_.go_to_tab = panels::tab::messages;
    settle_ = 3;
  }
  if (!live.divergence) {
    state_.is_divergence_told = state_.shows_incident = false;
  } else if (!state_.is_divergence_told) {
    state_.is_divergence_told = true;
    state_.panels.right = true;
    state_.go_to_tab = panels::tab::messages;
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
  const double passed = options_.has_own_clock ? 1.0 / 60 : seconds_since(drawn_at_);
  drawn_at_ = Clock::now();
  return std::clamp(passed, 1e-4, 0.25);
}

void Viewer::draw() {
  const auto start = Clock::now();
  const frontend::ScreenSize size = front_.size();
  const double passed = seconds_passed();
  if (size.scale != styled_scale_) {
    screen_.select_panels();
    panels::style_panels(size.scale);
    styled_scale_ = size.scale;
  }
  play(passed);
  const panels::Orbit camera_before = state_.orbit;
  lay_out();
  // Panels are laid out and used first: their changes are in this picture already.
  screen_.begin(size.width, size.height, font_size(), static_cast<float>(passed));
  draw_panels();
  announce_view();
  if (!(camera_before == state_.orbit)) {
    moved_at_ = Clock::now();
    settle_ = 3;
  }
  if (!show_sheet()) {
    paint_picture();
    screen_.end(renderer_, state_.viewport);
  } else {
    bench_.session().taken(state_.live->number);  // the run continues behind it
  }
  keep_recording();
  if (state_.wants_picture && has_picture_to_save()) save_picture();
  // Scripts name the frames that a user sees.
  const session::LiveFrame& live = *state_.live;
  front_.set_progress(live.scene ? scene::number_of(*live.scene, live.frame) : live.frame,
                      live.is_running);
  front_.set_typing(ImGui::GetIO().WantTextInput);
  front_.set_scrolling(panels::scroll_places());
  if (front_.is_ready())
    front_.show(screen_);
  else
    settle_ = 3;  // as soon as it is seen again
  state_.picture_ms = 1e3 * seconds_since(start);
  state_.frames_per_second = 0.9 * state_.frames_per_second + 0.1 / std::max(passed, 1e-3);
}

int Viewer::font_size() const {
  return panels::font_size(front_.size().scale);
}

/// Tells the session what to compute, whatever changed the view or its settings.
void Viewer::announce_view() {
  if (announced_ == std::pair(bench_.document().scene(), state_.view)) return;
  announced_ = {bench_.document().scene(), state_.view};
  bench_.session().set_views({panels::current_view(state_)});
}

/// Lays out the columns; a narrow window has one column for both.
void Viewer::lay_out() {
  const frontend::ScreenSize size = front_.size();
  const auto unit = static_cast<float>(font_size());
  panels::PanelSwitches& panels = state_.panels;
  panels.is_narrow = static_cast<float>(size.width) < narrow * unit;
  if (state_.go_to_tab) panels.prefers_right = true;
  constexpr float row = 1.75f;  // a button and the gap below it
  const int line = line_height();
  const int bar = line + static_cast<int>(row * unit * static_cast<float>(state_.bar_rows - 1));
  const bool has_panels = panels.left || panels.right;
  const float share = panels.is_narrow ? 0.45f : 1 / 3.0f;
  const auto column = [&](bool is_on, float width) {
    return is_on ? static_cast<int>(std::min(share * static_cast<float>(size.width), width * unit))
                 : 0;
  };
  // On a phone held upright, the lower half is for the panels.
  panels.is_stacked = panels.is_narrow && size.height > size.width;
  const int left = panels.is_stacked ? 0 : column(panels.shows_left(), 23),
            right = panels.is_stacked ? 0 : column(panels.shows_right(), 24);
  const int top = has_panels ? bar : 0, bottom = has_panels ? line : 0;
  const int height = size.height - top - bottom;
  state_.viewport = {left, top, std::max(16, size.width - left - right),
                     std::max(16, panels.is_stacked && has_panels ? height / 2 : height)};
}

int Viewer::line_height() const {
  return static_cast<int>(2.6f * static_cast<float>(font_size()));
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
      "transport", ImVec2(0, 0), ImVec2(all.x, y), [&] { panels::draw_transport(state_); }, bar);
  const panels::PanelSwitches& switches = state_.panels;
  const bool is_stacked = switches.is_stacked && (switches.left || switches.right);
  const float line = is_stacked ? static_cast<float>(line_height()) : all.y - y - h;
  const ImVec2 below(0, y + h + line), rest(all.x, all.y - y - h - line);
  const auto column = [&](const char* name, bool is_on, ImVec2 at, ImVec2 size, auto draw_inside) {
    if (is_on) window(name, is_stacked ? below : at, is_stacked ? rest : size, draw_inside);
  };
  column("left", switches.shows_left(), ImVec2(0, y), ImVec2(x, all.y - y),
         [&] { panels::draw_left_column(state_); });
  column("right", switches.shows_right(), ImVec2(x + w, y), ImVec2(all.x - x - w, all.y - y),
         [&] { panels::draw_right_column(state_); });
  window(
      "time", ImVec2(x, y + h), ImVec2(w, line), [&] { panels::draw_time_line(state_); }, bar);
  panels::draw_panel_switch(state_);
  panels::draw_offer(state_);
  panels::draw_help(state_);
  panels::draw_files(state_);
  panels::draw_sweep(state_);
  panels::use_viewport(state_);
  panels::draw_tour(state_);
  panels::use_keys(state_);
}

void Viewer::play(double passed) {
  if (!state_.is_playing) return;
  const session::LiveFrame& live = *state_.live;
  state_.play_clock += passed * live.scene->fps;
  if (state_.play_clock < 1 || painted_number_ != live.number) return;
  const int wanted = live.frame + static_cast<int>(state_.play_clock);
  state_.play_clock = 0;
  const auto next = std::lower_bound(live.kept.begin(), live.kept.end(), wanted);
  const int frame = next == live.kept.end() ? live.head + 1 : *next;
  panels::show_frame(state_, frame);
  if (panels::is_newest(live, frame)) state_.is_playing = false;
}

}  // namespace neve::app::view
