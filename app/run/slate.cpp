#include "app/run/drawing.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/scene/burn_in.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"
#include "render/frame/compose.h"

namespace neve::app::run {

namespace {

using Row = std::pair<std::string, std::string>;

constexpr std::array<std::uint8_t, 3> board{26, 29, 34};
constexpr std::array<std::uint8_t, 3> label_color{140, 150, 165};
constexpr std::array<std::uint8_t, 3> value_color{240, 244, 250};

std::string frames_text(const scene::Scene& scene) {
  std::string text = scene::range_text(scene);
  if (scene.handles > 0) text += fmt::format(", handles of {}", scene.handles);
  return text + fmt::format(", {} a second", plain_rate(scene.fps));
}

/// A label and its value each; those that nobody gave are left out.
std::vector<Row> rows_of(const scene::Scene& scene, const SlateWords& words) {
  const scene::Shot& shot = scene.shot;
  std::vector<Row> rows;
  for (Row row : {Row{"show", shot.show}, Row{"shot", shot.name}, Row{"version", shot.version},
                  Row{"artist", shot.artist}, Row{"title", scene.title}, Row{"view", words.view},
                  Row{"frames", frames_text(scene)},
                  Row{"time code", scene::time_code_of(scene, words.number + 1, scene.fps)}})
    if (!row.second.empty()) rows.push_back(std::move(row));
  const char* label = "parameters";
  for (const std::string& line : words.parameters) {
    if (line == scene.title) continue;
    rows.emplace_back(label, line);
    label = "";
  }
  return rows;
}

render::Image with_channels(render::Image image, int channels) {
  if (image.channels == channels || channels != 4) return image;
  render::Image out{image.width, image.height, 4, {}};
  out.pixels.reserve(image.pixels.size() / 3 * 4);
  for (std::size_t k = 0; k + 2 < image.pixels.size(); k += 3) {
    out.pixels.insert(out.pixels.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(k),
                      image.pixels.begin() + static_cast<std::ptrdiff_t>(k) + 3);
    out.pixels.push_back(255);
  }
  return out;
}

}  // namespace

render::Image draw_slate(const scene::Scene& scene, const SlateWords& words,
                         const render::Image& like, render::Renderer& renderer) {
  const std::vector<Row> rows = rows_of(scene, words);
  render::Frame frame;
  frame.width = like.width;
  frame.height = like.height;
  // The letters are as large as fits: a line is 1.5 times as high, and half of the width holds 40.
  const double by_height = like.height / (1.5 * (static_cast<double>(rows.size()) + 2));
  const double by_width = like.width / 44.0;
  frame.font_size =
      std::clamp(static_cast<int>(std::lround(std::min(by_height, by_width))), 8, 160);
  const auto size = static_cast<float>(frame.font_size), width = static_cast<float>(like.width);
  const float left = 0.2f * width, gap = 0.8f * size;
  float y =
      0.5f * (static_cast<float>(like.height) - 1.5f * size * static_cast<float>(rows.size()));
  for (const auto& [label, value] : rows) {
    frame.notes.push_back(
        {left, y, label, render::Note::Anchor::right, left - gap, false, label_color});
    frame.notes.push_back({left + gap, y, value, render::Note::Anchor::left, width - left - 2 * gap,
                           false, value_color});
    y += 1.5f * size;
  }
  return with_channels(
      renderer.draw_over(render::compose(like.width, like.height, board, {}), frame),
      like.channels);
}

}  // namespace neve::app::run
