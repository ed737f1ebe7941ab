/// One picture of the screen.

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/view/panels/style.h"
#include "app/view/panels/tip.h"
#include "app/view/picker/colours.h"
#include "app/view/picker/picker.h"

namespace neve::app::view::picker {

namespace {

constexpr ImGuiWindowFlags fixed_window = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                          ImGuiWindowFlags_NoSavedSettings |
                                          ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr ImGuiWindowFlags still_window =
    fixed_window | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

template <class Draw>
void draw_window(const char* name, const Box& box, ImGuiWindowFlags flags, Draw draw_inside) {
  if (box.width < 1 || box.height < 1) return;
  ImGui::SetNextWindowPos(ImVec2(box.x, box.y));
  ImGui::SetNextWindowSize(ImVec2(box.width, box.height));
  if (ImGui::Begin(name, nullptr, flags)) draw_inside();
  ImGui::End();
}

/// A finger moves the words of the current window; a mouse has a wheel too.
void scroll_by_hand(bool& is_scrolling) {
  const bool is_free = ImGui::IsWindowHovered() && !ImGui::IsAnyItemHovered();
  if (ImGui::IsMouseClicked(0)) is_scrolling = is_free;
  if (!ImGui::IsMouseDown(0)) is_scrolling = false;
  if (is_scrolling) ImGui::SetScrollY(ImGui::GetScrollY() - ImGui::GetIO().MouseDelta.y);
}

}  // namespace

/// Pictures since the beginning; the last ones stay for half a second.
int Picker::moment() const {
  const int length = std::max(1, movies_.length());
  const int all = length + static_cast<int>(std::ceil(state_.runs.manifest.fps / 2));
  return std::min(static_cast<int>(clock_ * state_.runs.manifest.fps) % all, length - 1);
}

double Picker::seconds_passed() {
  const double passed = options_.has_own_clock ? 1.0 / 60 : seconds_since(drawn_at_);
  drawn_at_ = Clock::now();
  return std::clamp(passed, 1e-4, 0.25);
}

/// True if another picture would show something else.
bool Picker::is_due(bool is_more) {
  const double passed = options_.has_own_clock ? 1.0 / 60 : seconds_since(drawn_at_);
  const double later = (clock_ + passed) * state_.runs.manifest.fps;
  const bool moves =
      movies_.length() > 1 && std::floor(later) > std::floor(clock_ * state_.runs.manifest.fps);
  if (is_more) settle_ = 3;
  return moves || settle_ > 0 || options_.has_own_clock || panels::is_tip_coming() ||
         front_.is_picture_wanted();
}

render::Image Picker::picture(render::PicturePlace& place) {
  const Grid& grid = state_.layout.grid;
  place = {grid.x, grid.y, grid.width(), grid.height()};
  if (movies_.length() == 0) return {};
  if (state_.closer) return movies_.large(*state_.closer, moment());
  return movies_.grid(grid, moment());
}

void Picker::draw(double passed) {
  const frontend::ScreenSize size = front_.size();
  if (size.scale != styled_scale_) {
    screen_.select_panels();
    panels::style_panels(size.scale);
    styled_scale_ = size.scale;
  }
  clock_ += passed;
  settle_ = std::max(0, settle_ - 1);
  const int font = panels::font_size(size.scale);
  state_.layout = lay_out(size.width, size.height, static_cast<float>(font),
                          static_cast<int>(game_.axes().size()), state_.runs.manifest.tile_width,
                          state_.runs.manifest.tile_height);
  screen_.begin(size.width, size.height, font, static_cast<float>(passed));
  draw_panels();
  render::PicturePlace place;
  const render::Image shown = picture(place);
  screen_.end(shown, place);
  front_.set_progress(game_.answered() + 1, state_.phase == Phase::making);
  front_.set_typing(false);
  front_.show(screen_);
}

void Picker::draw_panels() {
  const Layout& layout = state_.layout;
  const Grid& g = layout.grid;
  const bool is_over = state_.phase == Phase::over;
  draw_window("bar", layout.bar, still_window, [&] { draw_bar(state_); });
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  // A border of a pixel keeps the frames of the outer tiles whole.
  const Box tiles{static_cast<float>(g.x - 1), static_cast<float>(g.y - 1),
                  static_cast<float>(g.width() + 2), static_cast<float>(g.height() + 2)};
  draw_window("tiles", tiles, still_window | ImGuiWindowFlags_NoBackground,
              [&] { draw_tiles(state_); });
  ImGui::PopStyleVar();
  draw_window("buttons", layout.buttons, still_window, [&] { draw_buttons(state_); });
  draw_window("axes", layout.axes, fixed_window, [&] { draw_axes(state_); });
  draw_window("words", layout.words, fixed_window, [&] {
    scroll_by_hand(state_.is_scrolling);
    is_over ? draw_result(state_) : draw_words(state_);
  });
  use_keys(state_);
}

}  // namespace neve::app::view::picker
