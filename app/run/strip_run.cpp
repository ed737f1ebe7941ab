#include "app/run/strip_run.h"

#include <algorithm>
#include <cmath>

#include "app/output/atomic_file.h"
#include "app/picture/frame_builder.h"
#include "app/picture/legends.h"
#include "app/record/picture_record.h"
#include "app/scene/burn_in.h"
#include "app/scene/read.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/film_rate.h"
#include "app/support/text.h"
#include "app/timeline/timeline.h"
#include "app/timeline/times.h"
#include "render/frame/compose.h"
#include "render/gl/context.h"
#include "render/renderer.h"

namespace neve::app::run {

namespace {

constexpr std::array<std::uint8_t, 3> behind_tiles{38, 42, 49};
constexpr double screen_aspect = 16.0 / 9;

/// Frames spread evenly from the first to the last, each once.
std::vector<double> spread_times(const setup::FrameRange& frames, double fps, int tiles) {
  std::vector<double> times;
  const int count = std::min(tiles, frames.last - frames.first + 1);
  for (int k = 0; k < count; ++k) {
    const double part = count > 1 ? static_cast<double>(k) / (count - 1) : 1;
    times.push_back(std::round(frames.first + part * (frames.last - frames.first)) / fps);
  }
  return times;
}

int usual_columns(int tiles, const scene::PictureSize& tile) {
  const double aspect = static_cast<double>(tile.width) / tile.height;
  const auto badness = [&](int columns) {
    const int rows = (tiles + columns - 1) / columns;
    const double gaps = static_cast<double>(rows * columns) / tiles;
    return std::abs(std::log(columns * aspect / rows / screen_aspect)) + std::log(gaps);
  };
  int best = 1;
  for (int columns = 2; columns <= tiles; ++columns)
    if (badness(columns) < badness(best)) best = columns;
  return best;
}

/// Places of the tiles below a strip of words, and beside the legends.
struct Layout {
  int columns, rows, tile_width, tile_height, gap, font_size, top, right;

  Layout(const StripJob& job, const scene::PictureSize& shape, std::size_t lines, bool has_legend)
      : columns(job.columns),
        rows((static_cast<int>(job.times.size()) + columns - 1) / columns),
        gap(std::max(2, job.width / 400)),
        font_size(std::clamp(static_cast<int>(std::lround(job.width / 90.0)), 10, 160)),
        top(static_cast<int>(std::lround(font_size * (1.6 + 1.3 * static_cast<double>(lines))))),
        right(has_legend ? 9 * font_size : 0) {
    tile_width = std::max(16, (job.width - right - (columns - 1) * gap) / columns);
    tile_height =
        std::max(16, static_cast<int>(std::lround(1.0 * tile_width * shape.height / shape.width)));
  }
  int x(std::size_t tile) const { return static_cast<int>(tile) % columns * (tile_width + gap); }
  int y(std::size_t tile) const {
    return top + static_cast<int>(tile) / columns * (tile_height + gap);
  }
  int height() const { return top + rows * (tile_height + gap) - gap; }
};

/// Title, view and changes: those at the start are of all tiles, the others say when they were
/// made.
/// @param footnote  of the first tile
std::vector<std::string> words_of(const StripJob& job,
                                  const std::vector<scene::LiveChange>& changes,
                                  const std::string& footnote) {
  const scene::Scene& scene = job.run.scene;
  std::vector<std::string> lines{scene.title.empty() ? job.run.scene_file : scene.title};
  std::string line = "view " + scene.views.front().name;
  for (const std::string& change : scene::change_lines(job.run.overrides, changes))
    line += "   \u00b7   " + change;
  if (job.run.coarsening > 1)
    line += "   \u00b7   coarsened " + rough_text(job.run.coarsening) + "x";
  if (!footnote.empty()) line += "   \u00b7   " + footnote;
  lines.push_back(line);
  return lines;
}

class Strip {
 public:
  /// @throws LimitError for one that is too large to be drawn, whatever its columns
  Strip(const StripJob& job, const scene::Scene& scene, render::Renderer& renderer)
      : job_(job),
        renderer_(renderer),
        legends_(scene::has_layer(scene.views.front(), scene::Layer::legend)
                     ? picture::legends_of(scene, with_one_scale(scene.views.front()))
                     : std::vector<render::Legend>{}),
        layout_(layout_with(scene)) {
    // One that is too high is wrapped.
    const int largest = renderer.max_size(), tiles = static_cast<int>(job.times.size());
    while (layout_.height() > largest && job_.columns < tiles) {
      ++job_.columns;
      layout_ = layout_with(scene);
    }
    setup::check_picture("the strip", {job_.width, layout_.height()}, largest, "--width",
                         "make it narrower with --width, or give fewer --tiles");
    setup::check_picture("a tile of the strip", {layout_.tile_width, layout_.tile_height}, largest,
                         "--width", "make it narrower with --width");
  }

  int columns() const { return job_.columns; }

  void add(const timeline::Timeline& timeline, const scene::Scene& resolved) {
    // The changes of the run count, the look is that of the job.
    scene::Scene scene = timeline.scene();
    scene.camera = resolved.camera;
    scene.views = {tile_view(resolved.views.front())};
    const double fps = scene.fps, time = timeline.simulation().time();
    const picture::Snapshot snapshot = timeline::take_snapshot(
        timeline, scene, scene.views, static_cast<int>(std::lround(time * fps)));
    const picture::PictureOptions options{job_.run.quality, job_.run.overrides,
                                          job_.run.coarsening};
    render::Frame frame = picture::FrameBuilder(scene, timeline.seeded(), options)
                              .build(scene.views.front(), snapshot);
    changes_ = snapshot.changes;
    frame.caption = {"t = " + time_text(time, fps)};
    if (tiles_.empty())
      footnote_ = frame.footnote;
    else if (frame.footnote != footnote_)
      frame.caption.push_back(frame.footnote);
    frame.footnote.clear();
    if (!tiles_.empty()) frame.scale_bar.reset();  // all tiles have one scale
    tell_values_beyond(picture::legends_of(scene, scene.views.front(), frame));
    const std::size_t at = tiles_.size();
    tiles_.push_back({layout_.x(at), layout_.y(at), renderer_.draw(frame)});
    state_hash_ = timeline.simulation().state_hash();
  }

  render::Image finish() const {
    render::Frame words;
    words.width = job_.width;
    words.height = layout_.height();
    words.caption = words_of(job_, changes_, footnote_);
    words.caption_height = layout_.top;
    words.font_size = layout_.font_size;
    words.legends = legends_;
    words.legend_width = static_cast<float>(layout_.right - 2 * layout_.font_size);
    return renderer_.draw_over(render::compose(words.width, words.height, behind_tiles, tiles_),
                               words);
  }

  std::size_t count() const { return tiles_.size(); }

  /// @param scene  resolved, TOML
  record::PictureRecord record(const std::string& scene, const std::string& simd) const {
    record::PictureRecord record = picture_record(job_.run, scene, simd);
    const std::vector<double> drawn(job_.times.begin(),
                                    job_.times.begin() + static_cast<std::ptrdiff_t>(count()));
    record.strip = record::StripRecord{drawn, job_.columns, job_.width};
    record.view = job_.run.scene.views.front().name;
    record.frame = scene::number_of(
        job_.run.scene, static_cast<int>(std::lround(drawn.back() * job_.run.scene.fps)));
    record.state_hash = record::hash_text(state_hash_);
    return record;
  }

 private:
  Layout layout_with(const scene::Scene& scene) const {
    return {job_, setup::size_of(scene, scene.views.front()), words_of(job_, {}, {}).size(),
            !legends_.empty()};
  }

  /// A legend of all tiles says what one of its tiles has.
  void tell_values_beyond(const std::vector<render::Legend>& of_tile) {
    for (std::size_t k = 0; k < std::min(of_tile.size(), legends_.size()); ++k) {
      legends_[k].has_lower_values |= of_tile[k].has_lower_values;
      legends_[k].has_higher_values |= of_tile[k].has_higher_values;
    }
  }

  /// All tiles have the ranges of the scene.
  static scene::View with_one_scale(scene::View view) {
    view.slice.range_from = scene::RangeFrom::scene;
    return view;
  }

  scene::View tile_view(scene::View view) const {
    view = with_one_scale(std::move(view));
    view.size = scene::PictureSize{layout_.tile_width, layout_.tile_height};
    view.background = scene::Background::gradient;
    for (const scene::Layer layer :
         {scene::Layer::legend, scene::Layer::caption, scene::Layer::counter, scene::Layer::slate})
      std::erase(view.layers, layer);
    return view;
  }

  StripJob job_;
  render::Renderer& renderer_;
  std::vector<render::Legend> legends_;
  Layout layout_;
  std::vector<render::Tile> tiles_;
  std::vector<scene::LiveChange> changes_;  ///< of the run up to the last of them
  std::string footnote_;                    ///< of the first
  std::uint64_t state_hash_ = 0;            ///< of the last of them
};

/// Places automatic cameras for the moments of the strip: also those that neve found for a run, so
/// that the strip of a run is that of its scene.
void place_cameras(const StripJob& job, scene::Scene& scene) {
  if (!job.run.run.empty()) setup::reopen_cameras(scene);
  if (!setup::needs_framing(scene)) return;
  const std::vector<setup::CoarseMoment> moments = setup::coarse_run(scene);
  setup::resolve_cameras(scene, setup::moments_near(moments, job.times), setup::Shown::moments);
}

}  // namespace

StripJob make_strip_job(const StripOptions& options) {
  StripJob job;
  RenderOptions run = options.run;
  run.out.clear();
  job.run = make_job(run);
  /// The moments of a picture that neve strip made.
  const std::optional<record::StripRecord> made_again =
      job.run.picture ? job.run.picture->strip : std::nullopt;
  if (!job.run.scene.mosaics.empty() && !run.views.empty() && job.run.scene.views.size() > 1)
    throw UsageError("--view", "a mosaic has no strip", "give one of its views");
  job.run.scene.mosaics.clear();
  job.run.scene.views.resize(1);
  const scene::Scene& scene = job.run.scene;
  const bool is_picture_of_one = job.run.picture && !run.frames && job.run.frames.first > 0;
  const setup::FrameRange frames =
      is_picture_of_one ? setup::FrameRange{0, job.run.frames.last} : job.run.frames;
  if (!options.at.empty()) timeline::require_before_end("--at", options.at.back(), job.run);
  const bool has_moments = !options.at.empty() || options.tiles || options.run.frames;
  if (made_again && !has_moments)
    job.times = made_again->times;
  else if (!options.at.empty())
    job.times = options.at;
  else
    job.times = spread_times(frames, scene.fps, options.tiles.value_or(6));
  job.run.frames = {0, static_cast<int>(std::min(std::ceil(job.times.back() * scene.fps), 1e9))};
  job.width = options.width.value_or(made_again ? made_again->width : 1920);
  const int count = static_cast<int>(job.times.size());
  const int columns =
      options.columns.value_or(made_again && !has_moments ? made_again->columns : 0);
  job.columns = columns > 0 ? std::min(columns, count)
                            : usual_columns(count, setup::size_of(scene, scene.views[0]));
  job.file = options.run.out.empty()
                 ? job.run.folder / ("strip_" + scene.views.front().name + ".png")
                 : std::filesystem::path(options.run.out);
  return job;
}

StripResult run_strip(const StripJob& job, const RenderOptions& options, Progress& progress) {
  const auto context = render::gl::open_context(options.backend);
  ThreadPool pool(options.threads);
  render::Renderer renderer(*context, options.shader_dir, &pool);
  // Too large a one is found before the first step; the ranges of its legend are not known yet.
  const int columns = Strip(job, job.run.scene, renderer).columns();
  if (columns > job.columns)
    progress.warning("the strip has " + std::to_string(columns) +
                     " columns: one below the other, its tiles would be higher than the " +
                     std::to_string(renderer.max_size()) + " pixels that this backend draws");
  timeline::warn_of_late_frame(job.times.back(), job.run, progress);
  timeline::Timeline timeline = timeline::open(job.run, options.threads, progress);
  scene::Scene resolved = job.run.scene;
  place_cameras(job, resolved);
  setup::resolve(resolved, timeline.seeded().planned);
  Strip strip(job, resolved, renderer);
  progress.start(job.run.frames.last, scene::number_of(resolved, 0));
  for (const double time : job.times) {
    if (!timeline.go_to(time)) break;
    strip.add(timeline, resolved);
  }
  progress.clear();
  StripResult result{strip.count(), timeline.simulation().divergence()};
  if (result.tiles > 0) {
    output::make_folder(job.file.parent_path());
    const record::PictureRecord record =
        strip.record(scene::write_scene(resolved), timeline.simulation().simd());
    output::write_among_others(job.file,
                               render::encode_png(strip.finish(), record::to_png_text(record)));
  }
  return result;
}

}  // namespace neve::app::run
