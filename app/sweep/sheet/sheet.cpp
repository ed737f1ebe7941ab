#include "app/sweep/sheet/sheet.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "app/output/read_picture.h"
#include "app/output/sequence.h"
#include "app/setup/plan.h"
#include "app/support/errors.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"
#include "app/sweep/jobs/outcome.h"
#include "app/sweep/sheet/marks.h"
#include "app/sweep/sheet/tile_words.h"
#include "render/frame/compose.h"

namespace neve::app::sweep::sheet {

namespace {

using Rgb = std::array<std::uint8_t, 3>;

constexpr Rgb paper{30, 33, 39}, empty_tile{44, 48, 56};
constexpr Rgb alarm{255, 138, 76};
constexpr double darkness = 0.42;  // of a tile whose run got less far
constexpr std::size_t max_moments = 6;
const char* const dot = "   \u00b7   ";

/// Estimates the width of the longest line, in heights of a line.
float width_of(const std::vector<std::string>& lines) {
  std::size_t longest = 0;
  for (const std::string& line : lines) longest = std::max(longest, line.size());
  return static_cast<float>(letter_width * static_cast<double>(longest));
}

render::Image plain_image(int width, int height, const Rgb& color) {
  return render::compose(width, height, color, {});
}

void darken(render::Image& image) {
  for (std::uint8_t& value : image.pixels)
    value = static_cast<std::uint8_t>(std::lround(darkness * value));
}

/// The newest picture that a run has at a frame or before it.
std::optional<int> newest_frame(const store::RunResult& result, int frame) {
  std::optional<int> newest;
  for (const int other : result.frames)
    if (other <= frame) newest = other;
  return newest;
}

/// True if the run has stopped before this frame, or has not reached it yet; in the newest frame of
/// all runs also if it failed there.
bool is_late(const Run& run, const store::RunResult& result, int frame, int newest) {
  if (frame == newest && frame < run.frames.last && store::has_failed(result.status.state))
    return true;
  const bool has_frame = std::binary_search(result.frames.begin(), result.frames.end(), frame);
  // A run whose plan ends at an earlier frame keeps its last picture.
  const bool is_over = result.status.state == store::RunState::ok && frame > run.frames.last;
  return !has_frame && !is_over;
}

render::Image read_tile(const std::filesystem::path& file, int width, int height,
                        const Rgb& background) {
  try {
    render::Image image = output::read_picture(file);
    if (image.channels == 4)
      image = render::compose(image.width, image.height, background, {{0, 0, std::move(image)}});
    if (image.width == width && image.height == height) return image;
    if (image.width >= width && image.height >= height) return render::shrink(image, width, height);
    return render::compose(width, height, background,
                           {{(width - image.width) / 2, (height - image.height) / 2, image}});
  } catch (const UnreadableError&) {
    throw;
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    // A picture that is missing or being replaced does not prevent the sheet.
    return plain_image(width, height, background);
  }
}

/// The name of a run, or its settings, a line each.
std::string strip_name(const store::Manifest& manifest, const Run& run) {
  constexpr std::size_t max_lines = 5;
  if (!run.label.empty()) return run.label;
  const std::vector<std::string> lines = tile_words(manifest, run, false, {1, max_lines});
  return lines.empty() ? store::run_text(run) : joined(lines, "\n");
}

/// The word in capitals, and the text after it.
std::pair<std::string, std::string> split_state(const std::string& text) {
  std::size_t end = 0;
  for (std::size_t k = 0; k < text.size() && !(text[k] >= 'a' && text[k] <= 'z') &&
                          !(text[k] >= '0' && text[k] <= '9');
       ++k)
    if (text[k] == ' ' || k + 1 == text.size()) end = k + (text[k] == ' ' ? 0 : 1);
  if (end == 0) return {"", text};
  return {text.substr(0, end), end < text.size() ? text.substr(end + 1) : ""};
}

/// "12 runs, 1 failed", "3 points, 12 runs".
std::string run_count_text(const store::Manifest& manifest,
                           const std::vector<store::RunResult>& results,
                           const std::vector<predict::Prediction>& predictions) {
  int ok = 0;
  const std::string others = store::other_ends(results, ok);
  std::string text = std::to_string(results.size()) + (results.size() == 1 ? " run" : " runs");
  if (manifest.seeds > 1)
    text = fmt::format("{} points of {} seeds, {}",
                       results.size() / static_cast<std::size_t>(manifest.seeds), manifest.seeds,
                       text);
  text += others;
  if (!manifest.coarsened.empty()) text += dot + manifest.coarsened;
  const auto full = std::count_if(predictions.begin(), predictions.end(),
                                  [](const predict::Prediction& p) { return p.is_run; });
  if (full > 0)
    text += dot + fmt::format("{} of {} tiles at full resolution", full, predictions.size());
  return text;
}

/// "frame 12   t = 0.500 s"; runs of other lengths or rates have their own moments.
std::string moment_text(const store::Manifest& manifest, int frame) {
  const bool are_shorter =
      std::ranges::any_of(manifest.runs, [&](const Run& run) { return run.frames.last < frame; });
  return "frame " + std::to_string(frame) +
         (manifest.has_one_rate() ? "   t = " + time_text(manifest.time_of(frame), manifest.fps)
                                  : "") +
         (are_shorter ? ", or the last of a shorter run" : "");
}

int last_frame(const store::Manifest& manifest) {
  int last = 0;
  for (const Run& run : manifest.runs) last = std::max(last, run.frames.last);
  return last;
}

}  // namespace

SheetMaker::SheetMaker(std::filesystem::path folder, const store::Manifest& manifest,
                       const std::vector<store::RunResult>& results,
                       const std::vector<predict::Prediction>& predictions,
                       const std::vector<render::Legend>& legends, render::Renderer& renderer)
    : folder_(std::move(folder)),
      manifest_(store::first_draws(manifest)),
      results_(store::first_draws(manifest, results)),
      seals_(seals_of(manifest, results, predictions)),
      counts_(run_count_text(manifest, results, predictions)),
      legends_(legends),
      renderer_(renderer),
      head_(manifest_),
      named_(manifest_),
      pages_(
          layout_pages(manifest_, !legends.empty(), renderer.max_size(),
                       {seals_, moment_text(manifest_, last_frame(manifest_)) + dot + counts_})) {
  head_.runs.clear();
  show_full_runs(manifest);
  for (const store::RunResult& result : results_)
    if (!result.frames.empty()) newest_ = std::max(newest_, result.frames.back());
  if (named_.tile_label == "none") named_.tile_label = "differences";
}

void SheetMaker::show_full_runs(const store::Manifest& manifest) {
  const std::vector<std::optional<store::RunResult>> full = store::full_results(folder_, manifest);
  const auto seeds = static_cast<std::size_t>(manifest.seeds);
  for (const store::Variant& variant : manifest.variants) {
    // A tile shows the first seed.
    if (!variant.is_full() || !full[variant.of] || variant.of % seeds != 0) continue;
    manifest_.runs[variant.of / seeds].folder = variant.run.folder;
    results_[variant.of / seeds] = *full[variant.of];
  }
}

render::Image SheetMaker::tile_picture(const Tile& tile, int width, int height,
                                       bool is_dark) const {
  const std::filesystem::path run = store::runs_folder(folder_) / tile.run->folder;
  std::filesystem::path file;
  std::error_code error;
  const std::optional<int> frame = newest_frame(*tile.result, tile.frame);
  // The picture of the divergence has rings around the culprits.
  const std::filesystem::path incident = output::diverged_path(run, manifest_.view);
  if (is_dark && tile.result->status.state == store::RunState::diverged &&
      std::filesystem::exists(incident, error))
    file = incident;
  else if (frame)
    file = output::frame_path(run, manifest_.view, *frame);
  if (file.empty()) return plain_image(width, height, empty_tile);
  render::Image picture = read_tile(file, width, height, empty_tile);
  if (is_dark) darken(picture);
  return picture;
}

void SheetMaker::add_tile_words(const SheetLayout& layout, const Tile& tile, bool is_dark,
                                render::Frame& words) const {
  const auto size = static_cast<float>(layout.font_size);
  const float left = static_cast<float>(tile.x) + 0.6f * size;
  const float room = static_cast<float>(layout.tile_width) - 1.2f * size;
  float at = static_cast<float>(tile.y - layout.label_height) +
             (layout.label_height > 0 ? 0.25f : 0.45f) * size;
  const auto add = [&](const std::string& line, const std::array<std::uint8_t, 3>& ink) {
    words.notes.push_back({left, at, line, render::Note::Anchor::left, room, false, ink});
    at += 1.25f * size;
  };
  bool is_first = true;
  for (const std::string& line : tile_words(manifest_, *tile.run, layout.has_edges, layout.words)) {
    add(line, is_first && !tile.run->label.empty() ? seal_ink : seal_grey);
    is_first = false;
  }
  if (layout.label_height > 0) at = static_cast<float>(tile.y) + 0.45f * size;
  if (!tile.result->warnings.empty())
    add("! " + store::warning_count_text(tile.result->warnings.size()), seal_caution);
  add_seal(layout, tile, words);
  add_star(layout, tile, words);
  if (tile.result->frames.empty()) return add_missing(layout, tile, words);
  if (!is_dark) return;
  const auto [state, reason] = split_state(jobs::tile_text(tile.result->status));
  const bool is_alarm = store::has_failed(tile.result->status.state);
  const float middle = static_cast<float>(tile.x) + 0.5f * static_cast<float>(layout.tile_width);
  const float height = static_cast<float>(layout.tile_height);
  const float y =
      static_cast<float>(tile.y) + 0.5f * height - (reason.empty() ? 0.6f : 1.2f) * size;
  const std::string first = state.empty() ? reason : state;
  words.notes.push_back({middle, y, first, render::Note::Anchor::middle, room, is_alarm,
                         is_alarm ? alarm : seal_grey});
  if (!state.empty() && !reason.empty())
    words.notes.push_back(
        {middle, y + 1.6f * size, reason, render::Note::Anchor::middle, room, false, seal_ink});
}

/// "no picture", the state of the run, and why it is so, in lines.
void SheetMaker::add_missing(const SheetLayout& layout, const Tile& tile,
                             render::Frame& words) const {
  constexpr std::size_t max_lines = 4;
  const store::RunStatus& status = tile.result->status;
  const auto size = static_cast<float>(layout.font_size);
  const auto width = static_cast<float>(layout.tile_width), room = width - 1.2f * size;
  std::vector<std::string> lines =
      broken_lines(status.reason, static_cast<std::size_t>(room / (letter_width * size)));
  if (lines.size() > max_lines) {
    lines.resize(max_lines);
    lines.back() += " ...";
  }
  const std::string state = jobs::tile_text(status);
  lines.insert(lines.begin(), {"no picture", state});
  const float x = static_cast<float>(tile.x) + 0.5f * width;
  float y = static_cast<float>(tile.y) + 0.5f * (static_cast<float>(layout.tile_height) -
                                                 1.4f * size * static_cast<float>(lines.size()));
  for (std::size_t k = 0; k < lines.size(); ++k, y += 1.4f * size)
    words.notes.push_back({x, y, lines[k], render::Note::Anchor::middle, room, false,
                           k == 1 && store::has_failed(status.state) ? alarm
                           : k == 0                                  ? seal_ink
                                                                     : seal_grey});
}

/// "starred" and the note, in the upper right corner.
void SheetMaker::add_star(const SheetLayout& layout, const Tile& tile, render::Frame& words) const {
  const auto mark = manifest_.marks.find(tile.run->index);
  if (mark == manifest_.marks.end()) return;
  const auto size = static_cast<float>(layout.font_size);
  const bool is_below = !seals_.of_points.empty();  // which may say "full resolution" there
  const std::string text = mark->second.has_star && mark->second.note.empty() ? "starred"
                           : mark->second.has_star ? "starred: " + mark->second.note
                                                   : mark->second.note;
  const float width = std::min(width_of({text}) * size + size,
                               0.7f * static_cast<float>(layout.tile_width)),
              left = static_cast<float>(tile.x + layout.tile_width) - width,
              top = static_cast<float>(tile.y) + (is_below ? 1.7f * size : 0);
  words.patches.push_back({left, top, width, 1.6f * size, {196, 146, 20, 255}});
  words.notes.push_back({left + 0.5f * width, top + 0.25f * size, text,
                         render::Note::Anchor::middle, width - 0.6f * size, false, seal_ink});
}

void SheetMaker::add_seal(const SheetLayout& layout, const Tile& tile, render::Frame& words) const {
  if (seals_.of_points.empty()) return;
  const auto size = static_cast<float>(layout.font_size);
  if (seals_.of_points[manifest_.place_of(*tile.run)].is_run) {
    constexpr const char* words_of_run = "full resolution";
    const float width = width_of({words_of_run}) * size + size,
                right = static_cast<float>(tile.x + layout.tile_width);
    const auto& c = group_colours.front();
    words.patches.push_back(
        {right - width, static_cast<float>(tile.y), width, 1.6f * size, {c[0], c[1], c[2], 255}});
    words.notes.push_back({right - 0.5f * width, static_cast<float>(tile.y) + 0.25f * size,
                           words_of_run, render::Note::Anchor::middle, width, false, seal_ink});
  }
  if (manifest_.tile_label == "none") return;
  draw_seal(seals_.of_points[manifest_.place_of(*tile.run)], seals_,
            {static_cast<float>(tile.x), static_cast<float>(tile.y + layout.tile_height),
             static_cast<float>(layout.tile_width), static_cast<float>(layout.seal_height), size},
            words);
}

render::Frame SheetMaker::frame_of(const SheetLayout& layout, const std::string& line) const {
  setup::check_picture("the sheet", {layout.width, layout.height}, renderer_.max_size(),
                       folder_.string(), "make its pictures smaller");
  render::Frame words;
  words.width = layout.width;
  words.height = layout.height;
  words.font_size = layout.font_size;
  words.legends = legends_;
  words.legend_width = 7.5f * static_cast<float>(layout.font_size);
  words.notes = layout.labels;
  words.patches = layout.brackets;
  const auto size = static_cast<float>(layout.font_size);
  const float room = static_cast<float>(layout.width) - 2 * size;
  words.notes.push_back(
      {size, 0.7f * size, manifest_.title, render::Note::Anchor::left, room, true, seal_ink});
  std::vector<std::string> lines = broken_lines(line, letters_in(layout.width, size));
  if (lines.size() == 1) lines = {line};
  float y = 2.3f * size;
  for (const std::string& part : lines) {
    words.notes.push_back({size, y, part, render::Note::Anchor::left, room, false, seal_grey});
    y += 1.3f * size;
  }
  return words;
}

render::Image SheetMaker::compose(const SheetLayout& layout, const std::vector<Tile>& tiles,
                                  render::Frame& words) const {
  std::vector<render::Tile> pictures;
  for (const Tile& tile : tiles) {
    const bool is_dark = is_late(*tile.run, *tile.result, tile.frame, newest_);
    add_tile_words(layout, tile, is_dark, words);
    pictures.push_back(
        {tile.x, tile.y, tile_picture(tile, layout.tile_width, layout.tile_height, is_dark)});
  }
  return renderer_.draw_over(render::compose(layout.width, layout.height, paper, pictures), words);
}

render::Image SheetMaker::sheet(int frame, std::size_t page) {
  const SheetLayout& layout = pages_[page].layout;
  std::vector<Tile> tiles;
  for (const SheetTile& place : layout.tiles)
    tiles.push_back({&manifest_.runs[place.run], &results_[place.run], frame, place.x, place.y});
  const std::string line = moment_text(manifest_, frame) + dot + counts_ +
                           (pages_.size() > 1 ? dot + ("page " + std::to_string(page + 1)) +
                                                    " of " + std::to_string(pages_.size())
                                              : "");
  render::Frame words = frame_of(layout, line);
  draw_key(layout.key, static_cast<float>(layout.height - layout.key_height),
           static_cast<float>(layout.width), static_cast<float>(layout.font_size), words);
  return compose(layout, tiles, words);
}

std::vector<render::Image> SheetMaker::strips() {
  const SnowInPictures snow(folder_, manifest_, results_);
  const std::vector<int> frames = snow.moments(max_moments);
  const int largest = renderer_.max_size();
  const bool is_part = frames.front() > manifest_.first_frame();
  const std::string heading =
      (manifest_.seeds == 1 ? "moments of every run" : "moments of every point, first seed") +
      std::string(is_part ? ", from the first with snow in a picture on" : "") + dot + counts_;
  const auto layout_of = [&](std::size_t first, std::size_t count) {
    return layout_sheet(strip_grid(frames, first, count), !legends_.empty(), largest,
                        {{}, heading});
  };
  const std::size_t runs = manifest_.runs.size();
  std::size_t count = runs;
  while (count > 1 && !fits(layout_of(0, count), largest)) count = (count + 1) / 2;
  std::vector<render::Image> images;
  for (std::size_t first = 0; first < runs; first += count)
    images.push_back(
        strips_of(frames, snow, first, layout_of(first, std::min(count, runs - first)), heading));
  return images;
}

render::Image SheetMaker::strips_of(const std::vector<int>& frames, const SnowInPictures& snow,
                                    std::size_t first, const SheetLayout& layout,
                                    const std::string& heading) {
  render::Frame words = frame_of(layout, heading);
  std::vector<render::Tile> pictures;
  for (const SheetTile& place : layout.tiles) {
    const std::size_t run = first + place.run / frames.size();
    const Tile tile{&manifest_.runs[run], &results_[run], frames[place.run % frames.size()],
                    place.x, place.y};
    const int last = tile.run->frames.last;
    const bool is_dark = is_late(*tile.run, *tile.result, tile.frame, newest_),
               is_over = !is_dark && last < tile.frame;
    pictures.push_back(
        {tile.x, tile.y,
         tile_picture(tile, layout.tile_width, layout.tile_height, is_dark || is_over)});
    if (tile.result->frames.empty())
      add_missing(layout, tile, words);
    else if (is_dark)
      add_state(layout, tile, words);
    else if (is_over)
      add_middle(layout, tile, "ended at frame " + std::to_string(last), seal_grey, words);
    else if (!snow.has_snow(run, tile.frame))
      add_middle(layout, tile, "no snow in the picture", seal_grey, words);
  }
  return renderer_.draw_over(render::compose(layout.width, layout.height, paper, pictures), words);
}

/// Runs as rows and moments as columns: a sheet of two axes.
store::Manifest SheetMaker::strip_grid(const std::vector<int>& frames, std::size_t first,
                                       std::size_t count) const {
  store::Manifest grid = head_;
  grid.apart = 1;
  grid.variants.clear();
  grid.columns = 1;
  grid.rows = 0;
  grid.tile_width = std::max(160, manifest_.tile_width * 2 / 3);
  grid.tile_height =
      std::max(1, static_cast<int>(std::lround(1.0 * grid.tile_width * manifest_.tile_height /
                                               manifest_.tile_width)));
  const bool are_at_once = manifest_.has_one_rate();
  store::AxisLabels names{"", {}}, times{are_at_once ? "t" : "frame", {}};
  for (const int frame : frames)
    times.values.push_back(are_at_once ? time_text(manifest_.time_of(frame), manifest_.fps)
                                       : std::to_string(frame));
  grid.runs.clear();
  for (std::size_t r = 0; r < count; ++r) {
    names.values.push_back(strip_name(named_, manifest_.runs[first + r]));
    for (std::size_t k = 0; k < frames.size(); ++k)
      grid.runs.emplace_back().coordinates = {static_cast<int>(r), static_cast<int>(k)};
  }
  grid.axes = {names, times};
  return grid;
}

void SheetMaker::add_middle(const SheetLayout& layout, const Tile& tile, const std::string& text,
                            const std::array<std::uint8_t, 3>& color, render::Frame& words) const {
  const auto width = static_cast<float>(layout.tile_width);
  words.notes.push_back({static_cast<float>(tile.x) + 0.5f * width,
                         static_cast<float>(tile.y) +
                             0.5f * static_cast<float>(layout.tile_height - layout.font_size),
                         text, render::Note::Anchor::middle, width, false, color});
}

/// Adds the reason why a run has ended, in few words.
void SheetMaker::add_state(const SheetLayout& layout, const Tile& tile,
                           render::Frame& words) const {
  const auto [state, reason] = split_state(jobs::tile_text(tile.result->status));
  add_middle(layout, tile, state.empty() ? reason : state,
             store::has_failed(tile.result->status.state) ? alarm : seal_grey, words);
}

}  // namespace neve::app::sweep::sheet
