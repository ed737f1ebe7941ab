#include "app/compare/compare_run.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/compare/pair_pictures.h"
#include "app/compare/target.h"
#include "app/output/read_picture.h"
#include "app/record/picture_record.h"
#include "app/scene/live_change.h"
#include "app/scene/read.h"
#include "app/setup/resolve.h"
#include "app/support/errors.h"
#include "app/support/text.h"
#include "render/gl/context.h"

namespace neve::app::compare {

namespace {

bool is_explicit(const PairOptions& options, Mode mode) {
  return std::find(options.modes.begin(), options.modes.end(), mode) != options.modes.end();
}

/// A mode that these runs cannot have: an error where it was asked for, or is the only one.
void refuse_mode(const PairOptions& options, Mode mode, const std::optional<UsageError>& problem,
                 Target& target, PairResult& result) {
  if (!problem || !target.has(mode)) return;
  if (is_explicit(options, mode) || target.kind() != TargetKind::folder) throw *problem;
  target.leave_out(mode);
  result.warnings.push_back(std::string("no ") + name(mode) + ": " + problem->message);
}

std::optional<UsageError> metrics_problem(const Pair& pair) {
  if (!pair.a.job.picture && !pair.b.job.picture) return std::nullopt;
  return UsageError("--mode metrics", "a picture has no metrics over time",
                    "compare the folders of two runs");
}

void check_costs(const Side& side, const PairOptions& options) {
  const setup::Plan plan =
      setup::make_plan(side.job.scene, side.job.frames, setup::Quality::draft, options.threads);
  setup::check_limits(side.job.scene, plan, side.job.coarsening);
}

/// Frames that get pictures: one picture is of the last.
setup::FrameRange drawn_frames(const Pair& pair, const Target& target) {
  setup::FrameRange frames = pair.frames;
  if (target.kind() == TargetKind::picture && !target.has(Mode::metrics))
    frames.first = frames.last;
  return frames;
}

/// The options of a picture, as they are written.
std::string option_words(const PairOptions& options, Mode mode) {
  if (mode == Mode::metrics) return {};
  std::string words;
  if (!options.view.empty()) words += " --view " + options.view;
  if (options.size)
    words += fmt::format(" --size {}x{}", options.size->width, options.size->height);
  if (mode == Mode::wipe) words += fmt::format(" --wipe {}", options.wipe);
  if (mode == Mode::displacement && options.range)
    words += fmt::format(" --range {}", *options.range);
  return words;
}

/// Says what made the picture of a mode.
render::PngText text_of(const PairOptions& options, Mode mode, std::optional<int> frame,
                        const Pair* pair) {
  record::SheetRecord record;
  record.what =
      std::string("a comparison of two ") + (pair ? "runs" : "pictures") + ", " + name(mode);
  const auto add_side = [&](const char* name, const std::string& path, const Side* side) {
    record.add(name, path + (side && !side->values.empty() ? "   " + side->values : ""));
    if (!side) return;
    for (const scene::LiveChange& change : side->job.changes)
      record.add(std::string("changed ") + name, scene::text_of(change));
    record.scenes.push_back({name, scene::write_scene(side->job.scene)});
  };
  add_side("A", options.a, pair ? &pair->a : nullptr);
  add_side("B", options.b, pair ? &pair->b : nullptr);
  if (frame) record.add("frame", std::to_string(*frame));
  record.again = "neve compare " + shell_path(options.a) + " " + shell_path(options.b) +
                 " --mode " + name(mode) + (frame ? fmt::format(" --frames {0}-{0}", *frame) : "") +
                 option_words(options, mode) + " --out FILE.png";
  return record::to_png_text(record);
}

class PairRun {
 public:
  PairRun(const PairOptions& options, Pair pair, Target& target, PairResult& result,
          Progress& progress)
      : options_(options),
        pair_(std::move(pair)),
        target_(target),
        result_(result),
        progress_(progress) {}

  void run() {
    target_.check_movies(pair_.a.job.scene.fps);
    refuse_mode(options_, Mode::metrics, metrics_problem(pair_), target_, result_);
    refuse_mode(options_, Mode::mass, grid_problem(pair_), target_, result_);
    const bool needs_states = std::any_of(target_.modes().begin(), target_.modes().end(),
                                          [](Mode mode) { return mode != Mode::metrics; });
    const auto context =
        target_.kind() == TargetKind::table ? nullptr : render::gl::open_context(options_.backend);
    ThreadPool pool(options_.threads);
    std::optional<render::Renderer> renderer;
    if (context) renderer.emplace(*context, "", &pool);
    if (needs_states)
      draw_states(*renderer);
    else
      list_moments();
    if (result_.moments.empty()) return;  // interrupted: what was there before stays
    if (target_.has(Mode::metrics)) add_metrics(renderer ? &*renderer : nullptr);
    for (std::string& warning : target_.add_movies(pair_.a.job.scene))
      result_.warnings.push_back(std::move(warning));
    target_.finish(result_.is_whole);
  }

 private:
  PairMoment moment(int frame) const {
    return moment_of(frame, pair_.a.job.scene, pair_.a.job.run_frames, pair_.b.job.run_frames);
  }

  /// Returns frames with the numbers that pictures have.
  setup::FrameRange numbers_of(const setup::FrameRange& frames) const {
    return {scene::number_of(pair_.a.job.scene, frames.first),
            scene::number_of(pair_.a.job.scene, frames.last)};
  }

  void list_moments() {
    target_.begin(numbers_of(pair_.frames));
    for (int frame = pair_.frames.first; frame <= pair_.frames.last; ++frame)
      result_.moments.push_back(moment(frame));
  }

  void draw_states(render::Renderer& renderer) {
    check_costs(pair_.a, options_);
    check_costs(pair_.b, options_);
    const setup::FrameRange frames = drawn_frames(pair_, target_);
    if (options_.size) {
      setup::set_size(*options_.size, pair_.a.job.scene);
      setup::resolve_cameras(pair_.a.job.scene);
    }
    PairPainter painter(options_, pair_, renderer);
    painter.check_sizes(target_.modes());
    timeline::Timeline a = timeline::open(pair_.a.job, options_.threads, progress_);
    timeline::Timeline b = timeline::open(pair_.b.job, options_.threads, progress_);
    refuse_mode(options_, Mode::displacement, id_problem(pair_, a.seeded(), b.seeded()), target_,
                result_);
    progress_.start(frames.last, scene::number_of(pair_.a.job.scene, 0));
    for (int frame = frames.first; frame <= frames.last; ++frame) {
      const bool is_there = advance(a, pair_.a, frame) && advance(b, pair_.b, frame);
      if (is_there && target_.has(Mode::displacement))
        follow_births(birth_problem(pair_, a.simulation(), b.simulation()), frame);
      if (!is_there) {
        result_.is_whole = false;
        return;
      }
      // Nothing of an earlier comparison goes before this one is known to be possible.
      if (frame == frames.first) target_.begin(numbers_of(frames));
      result_.moments.push_back(moment(frame));
      painter.take(a, b, target_.modes(), result_.moments.back());
      for (const Mode mode : target_.modes())
        if (mode != Mode::metrics)
          add_picture(mode, result_.moments.back().frame, painter.draw(mode));
    }
  }

  /// Refuses the mode at the first frame, and ends it later: its pictures so far are right.
  void follow_births(const std::optional<UsageError>& problem, int frame) {
    if (!problem) return;
    if (result_.moments.empty() || target_.kind() != TargetKind::folder)
      return refuse_mode(options_, Mode::displacement, problem, target_, result_);
    target_.leave_out(Mode::displacement);
    result_.warnings.push_back("displacement ends before frame " +
                               std::to_string(scene::number_of(pair_.a.job.scene, frame)) + ": " +
                               problem->message);
  }

  void add_picture(Mode mode, int frame, const render::Image& image) {
    target_.add(mode, frame, image, text_of(options_, mode, frame, &pair_));
  }

  /// @return false where it was interrupted
  bool advance(timeline::Timeline& timeline, const Side& side, int frame) {
    if (!timeline.go_to(frame / side.job.scene.fps)) {
      if (timeline.simulation().divergence())
        throw Error(exit_diverged,
                    side.job.scene_file + ": " + timeline.simulation().divergence()->sentence,
                    side.job.scene_file);
      return false;
    }
    timeline::compare_with_run(side.job, frame, timeline.simulation().state_hash(), progress_);
    return true;
  }

  void add_metrics(render::Renderer* renderer) {
    std::optional<render::Image> picture;
    const auto named = [](const Side& side) {
      return side.values.empty() ? side.job.scene_file : side.job.scene_file + "   " + side.values;
    };
    if (renderer) picture = draw_series(result_.moments, named(pair_.a), named(pair_.b), *renderer);
    target_.add_metrics(series_csv(result_.moments), picture,
                        text_of(options_, Mode::metrics, std::nullopt, &pair_));
  }

  const PairOptions& options_;
  Pair pair_;
  Target& target_;
  PairResult& result_;
  Progress& progress_;
};

render::Image read_plain(const std::string& file) {
  return opaque(output::read_picture(file));
}

}  // namespace

PairResult compare_run(const PairOptions& options, Progress& progress) {
  PairResult result;
  Target target(options);
  Pair pair = read_pair(options);
  result.differing = pair.differing;
  result.warnings = pair.warnings;
  PairRun(options, std::move(pair), target, result, progress).run();
  result.files = target.files();
  return result;
}

PairResult compare_plain_pictures(const PairOptions& options) {
  Target target(options);
  const Mode mode = options.modes.empty() ? Mode::beside : target.modes().front();
  const bool is_of_pixels = mode == Mode::beside || mode == Mode::wipe;
  if (!is_of_pixels || target.modes().size() > 1 || target.kind() != TargetKind::picture)
    throw UsageError(
        "--mode", "these pictures hold no scene of neve, only pixels",
        "give --out x.png with --mode beside or wipe, or pictures that neve render wrote");
  const render::Image a = read_plain(options.a), b = read_plain(options.b);
  if (a.width != b.width || a.height != b.height)
    throw Error(exit_check_failed,
                "the pictures have different sizes: " + std::to_string(a.width) + "x" +
                    std::to_string(a.height) + " and " + std::to_string(b.width) + "x" +
                    std::to_string(b.height),
                options.b, "give pictures of one size");
  const auto context = render::gl::open_context(options.backend);
  render::Renderer renderer(*context);
  const int count = mode == Mode::wipe ? 1 : 2;
  setup::check_picture("the picture of both", size_with_strip({a.width, a.height}, count),
                       renderer.max_size(), options.out, "compare smaller pictures");
  std::vector<render::Image> images{a, b};
  if (mode == Mode::wipe) images = {wiped(a, b, options.wipe)};
  target.begin({0, 0});
  target.add(
      mode, 0,
      with_strip(images, {StripWords{"A   " + options.a, ""}, StripWords{"B   " + options.b, ""}},
                 "", renderer),
      text_of(options, mode, std::nullopt, nullptr));
  PairResult result;
  result.files = target.files();
  return result;
}

}  // namespace neve::app::compare
