#include "app/sweep/sheet/collect.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <system_error>
#include <thread>

#include "app/output/atomic_file.h"
#include "app/output/folder_lock.h"
#include "app/output/movie.h"
#include "app/output/picture_writer.h"
#include "app/output/sequence.h"
#include "app/picture/legends.h"
#include "app/record/picture_record.h"
#include "app/scene/read.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/text.h"
#include "app/sweep/plan/shared_view.h"
#include "app/sweep/sheet/data_csv.h"
#include "app/sweep/sheet/effects.h"
#include "app/sweep/sheet/metric_plots.h"
#include "app/sweep/sheet/outputs.h"
#include "app/sweep/sheet/report.h"
#include "app/sweep/sheet/review.h"
#include "app/sweep/sheet/sheet.h"
#include "app/sweep/store/points.h"
#include "app/sweep/store/refine.h"
#include "app/sweep/store/stars.h"
#include "render/gl/context.h"

namespace neve::app::sweep::sheet {

namespace fs = std::filesystem;

namespace {

constexpr const char* collect_lock = ".collect.lock";

/// Colour bars of the view, with the ranges that all runs share; none where tiles have their own.
std::vector<render::Legend> shared_legends(const fs::path& folder,
                                           const store::Manifest& manifest) {
  if (manifest.have_tiles_legends) return {};
  std::error_code error;
  const fs::path file = plan::shared_view_path(folder);
  if (!fs::exists(file, error)) return {};
  const scene::Scene shared = scene::read_scene_file(file.string());
  for (const scene::View& view : shared.views)
    if (view.name == manifest.view) return picture::legends_of(shared, view);
  return {};
}

/// One collects at a time. A sweep that ends while someone collects has to collect after that, with
/// the runs that the other one did not see. @return nothing when it was interrupted
std::optional<output::FolderLock> wait_for_turn(const fs::path& folder, Progress& progress) {
  constexpr auto between_looks = std::chrono::milliseconds(50);
  const auto look = [&] {
    return output::FolderLock::try_lock(folder, "neve sweep collect",
                                        output::FolderLock::Kind::alone, collect_lock);
  };
  std::optional<output::FolderLock> lock = look();
  if (!lock) progress.note("waits for " + output::FolderLock::holder_of(folder, collect_lock));
  while (!lock && !is_interrupted()) {
    std::this_thread::sleep_for(between_looks);
    lock = look();
  }
  return lock;
}

bool has_pictures(const std::vector<store::RunResult>& results) {
  for (const store::RunResult& result : results)
    if (!result.frames.empty()) return true;
  return false;
}

/// Refuses flaws. Everything is written by then, with what the runs have.
/// @param of_variants  see store::variant_flaws()
void refuse_flaws(const fs::path& folder, const store::Manifest& manifest,
                  const std::vector<store::RunResult>& results,
                  const std::vector<std::string>& of_variants) {
  std::vector<std::string> flaws;
  for (std::size_t k = 0; k < results.size(); ++k)
    if (!results[k].flaws.empty())
      flaws.push_back(store::run_text(manifest.runs[k]) + ": " + results[k].flaws);
  flaws.insert(flaws.end(), of_variants.begin(), of_variants.end());
  if (flaws.empty()) return;
  const std::size_t more = flaws.size() - 1;
  throw Error(exit_check_failed,
              flaws.front() + (more > 0 ? "; and " + std::to_string(more) + " more runs" : ""),
              folder.string(), "repeat the command of the sweep to make these runs again");
}

/// "sheet", and "sheet_2" of the second page.
std::string page_name(const std::string& name, std::size_t page) {
  return page == 0 ? name : name + "_" + std::to_string(page + 1);
}

void write_sheet_movie(const fs::path& folder, const store::Manifest& manifest,
                       const std::string& name, int last, const output::MovieStyle& style,
                       Outputs& outputs, Progress& progress) {
  if (!style.is_made) return;
  const output::MovieRequest request{folder / name,
                                     output::movie_path(folder, name, style.format),
                                     manifest.first_frame(),
                                     last,
                                     manifest.fps,
                                     false,
                                     0,
                                     style};
  const output::MovieResult movie = output::write_movie(request);
  if (movie.outcome == output::MovieOutcome::written) outputs.add(request.file);
  if (movie.outcome == output::MovieOutcome::no_ffmpeg)
    progress.note("no " + name + output::info_of(style.format).suffix +
                  ": ffmpeg is not installed");
  const std::string failure = "no movie " + request.file.string() + ": " + movie.reason;
  if (movie.outcome == output::MovieOutcome::failed) progress.warning(failure);
  if (movie.outcome == output::MovieOutcome::unwritable)
    throw IoError(failure, request.file.string(),
                  "free disk space, and neve sweep collect makes the movie");
}

/// The last frame of the sweep, or that of its newest picture: after that nothing changes.
int last_drawn(const store::Manifest& manifest, const std::vector<store::RunResult>& results) {
  int newest = manifest.first_frame();
  for (const store::RunResult& result : results)
    if (!result.frames.empty()) newest = std::max(newest, result.frames.back());
  return std::min(newest, manifest.last_frame());
}

/// Origin of a page of sheets or strips: neither folders nor times, so that equal sweeps have equal
/// pictures.
render::PngText origin_of(const store::Manifest& manifest, const std::string& kind, int frame) {
  record::SheetRecord record;
  const auto number = [](std::size_t count) { return std::to_string(count); };
  record.what = "a " + kind + " of " + number(manifest.runs.size()) +
                (manifest.runs.size() == 1 ? " run" : " runs");
  const auto add = [&](const char* name, const std::string& text) { record.add(name, text); };
  const auto file_name = [](const std::string& file) { return fs::path(file).filename().string(); };
  add("title", manifest.title);
  add("scene", file_name(manifest.scene_file));
  add("sweep", file_name(manifest.sweep_file));
  add("view", manifest.view);
  add("frame", std::to_string(frame));
  add("varies", joined(manifest.varied.value_or(std::vector<std::string>{}), ", "));
  for (const scene::Override& fixed : manifest.fixed)
    add("override", fixed.address + "=" + fixed.value);
  record.version = manifest.version;
  return record::to_png_text(record);
}

void write_sheet_page(const fs::path& folder, const store::Manifest& manifest, SheetMaker& maker,
                      std::size_t page, int last, const output::MovieStyle& movie, Outputs& outputs,
                      Progress& progress) {
  const int first = manifest.first_frame();
  const std::string name = page_name("sheet", page);
  output::make_own_folder(folder / name);
  output::PictureWriter writer;
  for (int frame = first; frame <= last && !is_interrupted(); ++frame) {
    render::Image image = maker.sheet(frame, page);
    const render::PngText origin = origin_of(manifest, "contact sheet", frame);
    if (frame == last) writer.write({outputs.add(folder / (name + ".png")), image, origin});
    writer.write({outputs.add(output::frame_path(folder, name, frame)), std::move(image), origin});
    progress.line(name + " " + std::to_string(frame) + "/" + std::to_string(last));
  }
  writer.finish();
  if (!is_interrupted() && last > first)
    write_sheet_movie(folder, manifest, name, last, movie, outputs, progress);
}

void write_sheets(const fs::path& folder, const store::Manifest& manifest, SheetMaker& maker,
                  int last, const output::MovieStyle& movie, Outputs& outputs, Progress& progress) {
  for (std::size_t page = 0; page < maker.pages().size(); ++page)
    write_sheet_page(folder, manifest, maker, page, last, movie, outputs, progress);
}

void write_strips(const fs::path& folder, const store::Manifest& manifest, SheetMaker& maker,
                  int last, Outputs& outputs) {
  output::PictureWriter writer;
  std::size_t page = 0;
  for (render::Image& image : maker.strips())
    writer.write({outputs.add(folder / (page_name("strips", page++) + ".png")), std::move(image),
                  origin_of(manifest, "page of strips", last)});
  writer.finish();
}

/// One of an earlier sweep, with seeds or of a screening, would be taken for that of this one.
void write_or_remove(const fs::path& file, const std::string& text) {
  if (text.empty()) return remove_result(file);
  output::write_file(file, text);
}

/// Writes the strongest parameters of each metric of a screening as files, and says them.
void write_effects(const fs::path& folder, const store::Manifest& manifest,
                   const std::vector<store::RunResult>& results, Progress& progress) {
  write_or_remove(folder / "effects.csv", effects_csv(manifest, results));
  write_or_remove(folder / "effects.svg", effects_svg(manifest, results, true));
  progress.clear();
  for (const std::string& line : effect_lines(manifest, results)) progress.note(line);
}

/// The runs with stars and their results, as a sweep of their own without axes.
std::pair<store::Manifest, std::vector<store::RunResult>> starred(
    const store::Manifest& manifest, const std::vector<store::RunResult>& results) {
  std::pair<store::Manifest, std::vector<store::RunResult>> chosen{manifest, {}};
  store::Manifest& m = chosen.first;
  m.runs.clear();
  m.variants.clear();
  m.axes.clear();
  m.screened.clear();
  m.seeds = m.apart = 1;
  m.wrap = 0;
  m.columns = m.rows = -1;
  m.tile_label = "differences";
  for (std::size_t k = 0; k < manifest.runs.size(); ++k) {
    const auto mark = manifest.marks.find(manifest.runs[k].index);
    if (mark == manifest.marks.end() || !mark->second.has_star) continue;
    m.runs.push_back(manifest.runs[k]);
    m.runs.back().coordinates.clear();
    chosen.second.push_back(results[k]);
  }
  return chosen;
}

/// The last frame of each run that has a star; without any the picture of before is removed.
void write_starred(const fs::path& folder, const store::Manifest& manifest,
                   const std::vector<store::RunResult>& results,
                   const std::vector<render::Legend>& legends, render::Renderer& renderer) {
  const auto [chosen, their_results] = starred(manifest, results);
  std::error_code error;
  if (!has_pictures(their_results)) {
    fs::remove(folder / "starred.png", error);
    return;
  }
  SheetMaker maker(folder, chosen, their_results, {}, legends, renderer);
  const int last = last_drawn(chosen, their_results);
  output::PictureWriter writer;
  writer.write({folder / "starred.png", maker.sheet(last, 0),
                origin_of(chosen, "contact sheet of starred runs", last)});
  writer.finish();
}

}  // namespace

void show_marks(const fs::path& folder, const store::Manifest& manifest, Progress& progress) {
  // Someone who collects would write the page that is read here.
  const std::optional<output::FolderLock> lock = wait_for_turn(folder, progress);
  if (!lock) return;
  const std::vector<store::RunResult> results = store::read_results(folder, manifest);
  std::error_code error;
  if (fs::exists(folder / "data.csv", error))
    output::write_file(folder / "data.csv",
                       data_csv(manifest, results, store::predictions_of(folder, manifest)));
  if (fs::exists(folder / "report.html", error)) {
    const std::vector<std::uint8_t> bytes = output::read_file(folder / "report.html");
    output::write_file(folder / "report.html",
                       report_with_marks({bytes.begin(), bytes.end()}, manifest));
  }
  try {
    const std::vector<render::Legend> legends = shared_legends(folder, manifest);
    const auto context = render::gl::open_context("auto");
    render::Renderer renderer(*context);
    write_starred(folder, manifest, results, legends, renderer);
  } catch (const render::gl::ContextError& no_drawing) {
    progress.warning(std::string("no starred.png: ") + no_drawing.what());
  }
}

void collect_sweep(const fs::path& folder, const output::MovieStyle& movie, bool has_review,
                   const std::string& backend, int threads, Progress& progress) {
  // Reads before it locks: a folder without a sweep gets no file.
  store::Manifest manifest = store::read_manifest(folder);
  const std::optional<output::FolderLock> lock = wait_for_turn(folder, progress);
  if (!lock) return;
  manifest = store::read_manifest(folder);
  const store::KeptMarks kept = store::read_marks(folder, manifest);
  manifest.marks = kept.marks;
  std::vector<store::RunResult> results = store::read_results(folder, manifest);
  for (store::RunResult& result : results)
    if (!result.flaws.empty()) result.warnings.push_back(result.flaws);
  const std::vector<predict::Prediction> predictions = store::predictions_of(folder, manifest);
  output::write_file(folder / "data.csv", data_csv(manifest, results, predictions));
  write_or_remove(folder / "points.csv", points_csv(manifest, results, predictions));
  const bool is_reviewed = has_review || has_links(folder);
  if (is_reviewed) link_pictures(folder, manifest, results);
  output::write_file(folder / "runs.otio", otio_timeline(manifest, results, is_reviewed));
  write_or_remove(folder / "plots.svg", metric_plots_svg(manifest, results));
  write_effects(folder, manifest, results, progress);
  progress.clear();
  for (const std::string& line : store::noise_lines(manifest, results)) progress.note(line);
  for (const std::string& line :
       {store::prediction_line(predictions),
        store::ranking_line(manifest, results, store::full_results(folder, manifest))})
    if (!line.empty()) progress.note(line);

  progress.clear();
  for (const std::string& line : store::lost_lines(kept.lost)) progress.warning(line);
  for (const std::string& line : store::mixture_lines(results)) progress.warning(line);
  for (const std::string& line : store::idle_lines(manifest, results)) progress.warning(line);
  for (const std::string& line : store::warning_lines(manifest, results)) progress.warning(line);
  const std::vector<std::string> of_variants = store::variant_flaws(folder, manifest);
  for (const std::string& line : of_variants) progress.warning(line);

  // An interrupted sweep ends without pictures.
  if (is_interrupted()) return;
  const std::vector<render::Legend> legends = shared_legends(folder, manifest);
  const auto context = render::gl::open_context(backend);
  ThreadPool pool(threads);
  render::Renderer renderer(*context, {}, &pool);
  SheetMaker maker(folder, manifest, results, predictions, legends, renderer);
  write_starred(folder, manifest, results, legends, renderer);
  Outputs outputs(folder);
  write_sheets(folder, manifest, maker, last_drawn(manifest, results), movie, outputs, progress);
  const bool has_moments = manifest.last_frame() > manifest.first_frame();
  if (!is_interrupted() && has_moments && has_pictures(results))
    write_strips(folder, manifest, maker, last_drawn(manifest, results), outputs);
  if (is_interrupted()) return;
  outputs.remove_others();
  const std::vector<std::uint8_t> sheet = output::read_file(folder / "sheet.png");
  output::write_file(folder / "report.html",
                     report_html(folder.string(), manifest, results, maker.pages().front().layout,
                                 sheet, maker.pages().size(), predictions));
  progress.clear();
  refuse_flaws(folder, manifest, results, of_variants);
}

}  // namespace neve::app::sweep::sheet
