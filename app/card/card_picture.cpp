#include "app/card/card_picture.h"

#include <algorithm>

#include "app/card/panel.h"
#include "app/picture/frame_builder.h"
#include "app/setup/plan.h"

namespace neve::app::card {

namespace {

constexpr int panel_columns = 3, head = 74, gap = 10;
constexpr int panel_rows = static_cast<int>(std::size(kinds)) / panel_columns;
constexpr int card_width = panel_columns * panel_width,
              card_height = head + panel_rows * panel_height;

/// "snow: 400 kg/m3, E 1.4e+05 Pa, hardening 10, ..."
std::string numbers_of(const Subject& subject) {
  scene::Scene scene;
  scene.materials = {subject.material};
  scene.materials.front().name = scene::name(subject.material.model);
  return picture::FrameBuilder(scene, {}).slate().back();
}

}  // namespace

render::Image draw_cards(const std::vector<Card>& cards, render::Renderer& renderer) {
  const int count = static_cast<int>(cards.size()), columns = std::min(count, 2);
  const int rows = (count + columns - 1) / columns;
  render::Frame words;
  words.font_size = card_font;
  words.width = columns * card_width + (columns - 1) * gap;
  words.height = rows * card_height + (rows - 1) * gap;
  setup::check_picture("the card", {words.width, words.height}, renderer.max_size(), "--material",
                       "ask for fewer materials");
  std::vector<render::Tile> tiles;
  const std::string behind = count == 1   ? ""
                             : count == 2 ? "   \u00b7   grey: the other card"
                                          : "   \u00b7   grey: the other cards";
  for (int k = 0; k < count; ++k) {
    const int x = k % columns * (card_width + gap), y = k / columns * (card_height + gap);
    const Card& card = cards[static_cast<std::size_t>(k)];
    const auto note = [&](int at_y, const std::string& text, bool is_title, picture::Rgb color) {
      words.notes.push_back({static_cast<float>(x + 12), static_cast<float>(y + at_y), text,
                             render::Note::Anchor::left, card_width - 24.0f, is_title, color});
    };
    note(10, card.subject.title, true, card_bright);
    note(38, numbers_of(card.subject) + behind, false, card_soft);
    for (const Kind kind : kinds) {
      const auto at = static_cast<std::size_t>(kind);
      std::vector<const Experiment*> all, others;
      for (const Card& other : cards) {
        all.push_back(&other.experiments[at]);
        if (&other != &card) others.push_back(all.back());
      }
      const int panel = static_cast<int>(kind);
      add_panel(card.experiments[at], others, axes_of(all), x + panel % panel_columns * panel_width,
                y + head + panel / panel_columns * panel_height, renderer, tiles, words);
    }
  }
  return renderer.draw_over(render::compose(words.width, words.height, card_ground, tiles), words);
}

}  // namespace neve::app::card
