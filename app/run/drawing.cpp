#include "app/run/drawing.h"

#include <algorithm>
#include <utility>

#include "app/health/incident.h"
#include "app/output/file_hash.h"
#include "app/output/read_picture.h"
#include "app/output/sequence.h"
#include "app/picture/mosaic.h"
#include "app/picture/shutter.h"
#include "app/support/text.h"
#include "app/timeline/timeline.h"
#include "render/image/mean_image.h"

namespace neve::app::run {

Drawing::Drawing(const RenderJob& job, const setup::SeededScene& seeded, render::Renderer& renderer,
                 record::PictureRecord record)
    : job_(job),
      seeded_(seeded),
      renderer_(renderer),
      record_(std::move(record)),
      scene_(job.scene),
      builder_(scene_, seeded, {job.quality, job.overrides, job.coarsening, job.prediction_lines}) {
  if (!job.lut.empty()) lut_ = read_lut(job.lut);
  if (!job.passes.empty()) passes_.emplace(scene_, seeded, pass_list(job.passes));
}

std::vector<std::string> Drawing::views() const {
  std::vector<std::string> names;
  for (const scene::View& view : job_.scene.views)
    if (job_.draws_alone(view)) names.push_back(view.name);
  return names;
}

picture::Snapshot Drawing::take(const timeline::Timeline& timeline,
                                const std::vector<scene::View>& views, int frame,
                                std::uint64_t state_hash) {
  scene_ = timeline.scene();
  picture::Snapshot snapshot = timeline::take_snapshot(timeline, scene_, views, frame);
  history_ = timeline.here().history;
  snapshot.history = history_;
  record_.frame = scene::number_of(scene_, frame);
  record_.state_hash = record::hash_text(state_hash);
  record_.changes = job_.changes;
  scene::forget_changes_after(record_.changes, timeline.simulation().steps());
  return snapshot;
}

/// Stress is read only where a view shows it.
picture::Snapshot Drawing::read(const timeline::Timeline& timeline, std::uint64_t state_hash) {
  std::vector<scene::View> views = timeline.here().scene->views;
  if (passes_)
    for (scene::View& view : views_for(passes_->list())) views.push_back(std::move(view));
  picture::Snapshot snapshot = take(timeline, views, timeline.here().frame, state_hash);
  if (passes_) pass_numbers_ = passes_->read(snapshot, timeline.simulation());
  return snapshot;
}

Drawing::Files Drawing::draw(const picture::Snapshot& snapshot) {
  Files files;
  // A GPU draws one view while the next is put together.
  std::vector<std::string> waiting;
  const auto fetch_down_to = [&](std::size_t left) {
    for (; waiting.size() > left; waiting.erase(waiting.begin()))
      files.pictures.push_back(picture_of(waiting.front(), renderer_.fetch()));
  };
  for (const scene::View& view : scene_.views) {
    if (!job_.draws_alone(view)) continue;
    render::Frame drawn = builder_.build(view, snapshot);
    if (!job_.plate.empty()) drawn.is_transparent = true;
    const render::Moments moments = shutter_frames(view, drawn, snapshot);
    if (moments.count == 0 && job_.plate.empty()) {
      renderer_.submit(drawn);
      waiting.push_back(view.name);
    } else {
      fetch_down_to(0);
      std::optional<render::Image> plate;
      if (!job_.plate.empty())
        plate = read_plate(job_, record_.frame, view.name, {drawn.width, drawn.height});
      files.pictures.push_back(picture_of(view.name, draw_mean(drawn, moments, plate)));
    }
    if (passes_)
      files.channels.push_back(draw_channels({scene_, view, seeded_, snapshot}, drawn, moments));
    fetch_down_to(1);
  }
  fetch_down_to(0);
  // A tile of a mosaic has motion blur, and is never drawn on a plate.
  const auto draw_tile = [&](const scene::View& view, const render::Frame& tile) {
    return draw_mean(tile, shutter_frames(view, tile, snapshot), std::nullopt);
  };
  const auto build = [&](const scene::View& view) { return builder_.build(view, snapshot); };
  const std::vector<std::string> caption =
      job_.options.has_caption ? builder_.caption(snapshot) : std::vector<std::string>{};
  for (const scene::Mosaic& mosaic : scene_.mosaics)
    files.pictures.push_back(
        picture_of(mosaic.name, picture::draw_mosaic(scene_, mosaic, build, caption,
                                                     job_.caption_lines(), renderer_, draw_tile)));
  return files;
}

render::Moments Drawing::shutter_frames(const scene::View& view, const render::Frame& frame,
                                        const picture::Snapshot& snapshot) const {
  if (!(job_.shutter > 0)) return {};
  return picture::shutter_moments({scene_, view, seeded_, snapshot}, frame, job_.shutter);
}

render::Image Drawing::draw_mean(const render::Frame& frame, const render::Moments& moments,
                                 const std::optional<render::Image>& plate) {
  const auto draw = [&](const render::Frame& moment) {
    return plate ? renderer_.draw_on_plate(moment, *plate) : renderer_.draw(moment);
  };
  if (moments.count == 0) return draw(frame);
  render::MeanImage mean;
  const render::Moments shared = picture::with_shared_samples(moments);
  for (int k = 0; k < shared.count; ++k) mean.add(draw(shared.at(k)));
  return mean.mean();
}

output::WriteTask Drawing::draw_channels(const picture::MotionSource& source,
                                         const render::Frame& frame,
                                         const render::Moments& moments) {
  render::channels::Request request = passes_->request(source, frame, pass_numbers_);
  request.moments = moments;
  auto picture =
      std::make_shared<const render::ExrPicture>(renderer_.draw_channels(frame, request));
  return
      [file = output::channels_path(job_.folder, source.view.name, record_.frame),
       header = passes_->header(record_of(source.view.name), frame), picture = std::move(picture)] {
        return std::vector{output::write_hashed(file, render::encode_exr(*picture, header))};
      };
}

std::vector<output::Picture> Drawing::draw_incident(const timeline::Timeline& timeline,
                                                    const sim::Divergence& divergence,
                                                    const health::Diagnosis& diagnosis) {
  const scene::Scene scene = timeline.scene();
  std::vector<scene::View> views = scene.views;
  if (const auto slice =
          health::culprit_slice(scene, divergence, timeline.simulation().particles()))
    views.push_back(*slice);
  picture::Snapshot snapshot =
      take(timeline, views, static_cast<int>(divergence.time * job_.scene.fps),
           timeline.simulation().state_hash());
  snapshot.time = divergence.time;
  const auto build = [&](const scene::View& view) {
    return builder_.build_incident(view, snapshot, divergence, diagnosis);
  };
  std::vector<output::Picture> pictures;
  const auto add = [&](const std::string& name, render::Image image) {
    if (lut_) render::apply(*lut_, image);
    pictures.push_back({output::diverged_path(job_.folder, name), std::move(image),
                        sheet_text("a picture of a divergence", name,
                                   {{"step", std::to_string(divergence.step)},
                                    {"time", rough_text(divergence.time) + " s"},
                                    {"state", record_.state_hash}},
                                   "neve render draws it where the run breaks again")});
  };
  for (const scene::View& view : views) add(view.name, renderer_.draw(build(view)));
  std::vector<std::string> caption;
  if (job_.options.has_caption) {
    caption = builder_.caption(snapshot);
    for (std::string& line : picture::FrameBuilder::incident_lines(divergence, diagnosis))
      caption.push_back(std::move(line));
  }
  for (const scene::Mosaic& mosaic : scene_.mosaics)
    add(mosaic.name,
        picture::draw_mosaic(scene_, mosaic, build, caption, job_.caption_lines(), renderer_));
  return pictures;
}

std::vector<output::Picture> Drawing::draw_slates(const record::RunRecord& record) {
  std::vector<output::Picture> slates;
  for (const std::string& view : record.views) {
    const record::ViewFrames frames = record::frames_of(record, view);
    if (frames.count() <= 0) continue;  // it was interrupted before its first picture
    const int first = frames.first;
    const render::Image like = output::read_picture(output::frame_path(job_.folder, view, first));
    render::Image slate =
        draw_slate(job_.scene, {first - 1, view, builder_.slate()}, like, renderer_);
    if (lut_) render::apply(*lut_, slate);
    slates.push_back({output::frame_path(job_.folder, view, first - 1), std::move(slate),
                      sheet_text("a slate", view, {{"number", std::to_string(first - 1)}},
                                 "neve render draws it before the first picture of the view")});
  }
  return slates;
}

render::PngText Drawing::sheet_text(const std::string& what, const std::string& view,
                                    const std::vector<std::pair<std::string, std::string>>& lines,
                                    const std::string& again) const {
  record::SheetRecord sheet;
  sheet.what = what;
  sheet.version = record_.version;
  sheet.add("build", record_.build);
  sheet.add("view", view);
  for (const auto& [name, text] : lines) sheet.add(name, text);
  sheet.add("quality", record_.quality);
  for (const std::string& change : record_.overrides) sheet.add("override", change);
  for (const scene::LiveChange& change : record_.changes)
    sheet.add("changed", scene::text_of(change));
  sheet.scenes = {{"scene", record_.scene}};
  sheet.again = again;
  return record::to_png_text(sheet);
}

record::PictureRecord Drawing::record_of(const std::string& view) const {
  record::PictureRecord record = record_;
  record.view = view;
  record.has_caption = job_.options.has_caption || !find_mosaic(job_.scene, view);
  if (!job_.plate.empty()) {
    const std::filesystem::path plate = plate_path(job_.plate, record.frame);
    record.files[plate.string()] = record::hash_text(output::hash_file(plate));
  }
  if (!job_.lut.empty()) record.files[job_.lut] = record::hash_text(output::hash_file(job_.lut));
  return record;
}

output::Picture Drawing::picture_of(const std::string& view, render::Image image) const {
  if (lut_) render::apply(*lut_, image);
  return {output::frame_path(job_.folder, view, record_.frame), std::move(image),
          record::to_png_text(record_of(view))};
}

}  // namespace neve::app::run
