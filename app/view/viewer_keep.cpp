/// Pictures that stay: of a moment, and a recording of every frame.

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/output/temporary.h"
#include "app/record/run_json.h"
#include "app/support/errors.h"
#include "app/view/viewer.h"

namespace neve::app::view {

namespace {

/// True for a file named as a frame is, or its data for compositing.
bool is_frame(const std::filesystem::path& file) {
  const std::string name = file.stem().string(), suffix = file.extension().string();
  const std::string digits = name.starts_with('-') ? name.substr(1) : name;
  return (suffix == ".png" || suffix == ".exr") && !digits.empty() &&
         digits.find_first_not_of("0123456789") == std::string::npos;
}

/// Frames that an earlier session, or anything else, left in the folder of a view.
bool has_frames(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (is_frame(entry.path())) return true;
  return false;
}

/// Its pictures would be replaced by those of another run.
void require_no_run(const std::filesystem::path& folder) {
  std::error_code error;
  if (std::filesystem::exists(output::run_json_path(folder), error))
    throw UsageError(folder.string(), folder.string() + " is the folder of a run",
                     "record into another: neve view --out DIR");
}

}  // namespace

/// Pictures can be made again where they belong to a frame: one that is asked for between two is
/// that of the next.
bool Viewer::has_picture_to_save() {
  const session::LiveFrame& live = *state_.live;
  if (live.stage && live.is_frame_end) {
    bench_.session().leave_stage();
    settle_ = 3;
    return false;
  }
  if (live.is_frame_end && painted_number_ == live.number && has_what_is_shown() &&
      !(goes_on_ && live.is_running))
    return true;
  if (live.divergence) return true;  // there is no next one
  // The user has paused it on its way there: the next frame that they ask for is the picture's, and
  // no more than that.
  if (is_going_to_frame_ && !live.is_frame_end && !live.is_running) goes_on_ = false;
  if (!is_going_to_frame_ && !live.is_frame_end) {
    is_going_to_frame_ = true;
    goes_on_ = live.is_running;
    bench_.session().next_frame();
  }
  settle_ = 3;
  return false;
}

/// The current view at its own size, with all that makes it again.
output::Picture Viewer::picture_to_keep(const std::filesystem::path& file) {
  const session::LiveFrame& live = *state_.live;
  scene::View view = panels::view_to_keep(state_);
  view.size = setup::size_of(*bench_.document().scene(), view);
  record::PictureRecord record = bench_.picture_record(live, view);
  if (live.is_frame_end) record.state_hash = record::hash_text(live.state_hash);
  painted_.reset();  // another picture takes the place of the one on the screen
  render::Image image = renderer_.draw(picture_frame(view));
  screen_.select_panels();  // the picture's words have another context: keys would go there
  return {file, std::move(image), record::to_png_text(record)};
}

void Viewer::save_picture() {
  state_.wants_picture = false;
  const session::LiveFrame& live = *state_.live;
  const bool was_between = is_going_to_frame_ && live.is_frame_end;
  if (goes_on_) bench_.session().run();
  is_going_to_frame_ = goes_on_ = false;
  char number[32];
  std::snprintf(number, sizeof number, "%04d_step%zu", scene::number_of(*live.scene, live.frame),
                live.steps);
  const std::filesystem::path file =
      output::free_path(bench_.folder(), panels::current_view(state_).name + "_" + number, ".png");
  try {
    const output::Picture picture = picture_to_keep(file);
    output::make_folder(bench_.folder());
    output::remove_abandoned(bench_.folder());
    output::write_file(file, render::encode_png(picture.image, picture.text));
    bench_.say_saved_picture(file, live, was_between);
    if (state_.is_picture_downloaded) download(file);
  } catch (const std::exception& error) {
    bench_.say_not_saved(std::string("no picture: ") + error.what());
  }
  state_.is_picture_downloaded = false;
  state_.go_to_tab = panels::tab::messages;
  settle_ = 3;
}

void Viewer::download(const std::filesystem::path& file) {
  try {
    front_.offer(bench_.folder(), file);
    bench_.say(session::Message::Kind::note, "downloading " + file.filename().string());
  } catch (const std::exception& error) {
    bench_.say(session::Message::Kind::error, error.what());
  }
}

RecordedKey Viewer::recorded_key() const {
  const session::LiveFrame& live = *state_.live;
  RecordedKey key{live.start,  live.state_hash,       live.frame,  bench_.document().scene(),
                  state_.view, state_.shows_incident, std::nullopt};
  if (!state_.is_camera_of_scene) key.camera = state_.orbit;
  return key;
}

/// Writes what waits, or says that it is missing: the next recording has failures of its own only.
void Viewer::stop_recording() {
  record_due();
  recorded_.reset();
  if (!lock_) return;
  try {
    if (writer_) writer_->finish();
  } catch (const std::exception& error) {
    bench_.say_not_saved(std::string("recorded pictures are missing: ") + error.what());
  }
  forget_unwritten();
  writer_.reset();
  lock_.reset();
}

/// A picture that could not be written is in no take.
void Viewer::forget_unwritten() {
  std::erase_if(take_.frames, [&](const auto& file) {
    return !std::filesystem::exists(take_.folder / file.first);
  });
  state_.recorded = static_cast<int>(take_.frames.size());
}

/// Records every frame once, and again where something else of it is shown before the next.
void Viewer::keep_recording() {
  if (!state_.is_recording) return stop_recording();
  const session::LiveFrame& live = *state_.live;
  const bool is_painted = painted_ && painted_number_ == live.number && has_what_is_shown();
  // An older frame is looked at, not recorded anew with the camera of now.
  if (!is_painted || !live.is_frame_end || live.is_older || live.stage) return;
  const RecordedKey key = recorded_key();
  is_record_due_ = recorded_ != key;
  if (!is_record_due_) return;
  const bool is_same_frame = recorded_ && recorded_->start == key.start &&
                             recorded_->frame == key.frame && recorded_->view == key.view;
  // The last picture of a drag is enough.
  if (is_same_frame && seconds_since(moved_at_) < still_after)
    settle_ = 3;
  else
    record_due();
}

/// A run that began again, or was continued from an older frame, is another one: it would replace
/// some pictures of the one before, and mix with the rest.
void Viewer::follow_run() {
  const session::LiveFrame& live = *state_.live;
  const auto time_of = [&](const auto& file) { return file.second / live.scene->fps; };
  if (take_.run.follow(live, take_.frames, time_of) > 0) take_.has_others = true;
}

/// Begins another folder, with the frames that both runs have.
void Viewer::begin_take() {
  const std::filesystem::path before = take_.folder;
  writer_->finish();
  forget_unwritten();
  const std::filesystem::path folder = output::free_path(bench_.folder(), "take", "");
  for (const auto& [file, frame] : take_.frames) {
    output::make_folder((folder / file).parent_path());
    output::write_file(folder / file, output::read_file(before / file));
  }
  take_.folder = folder;
  take_.has_others = false;
  bench_.say(session::Message::Kind::note, "the recording continues in " + take_.folder.string() +
                                               ", because " + before.string() +
                                               " has frames of another run");
}

/// Records the frame that is due, before what is shown is another one.
void Viewer::record_due() {
  if (!std::exchange(is_record_due_, false)) return;
  const session::LiveFrame& live = *state_.live;
  recorded_ = recorded_key();
  try {
    const std::string& view = panels::current_view(state_).name;
    // Frames have the names that neve render gives them.
    if (!lock_) {
      require_no_run(bench_.folder());
      lock_.emplace(bench_.folder(), "neve view");
    }
    if (!writer_) writer_.emplace();
    const bool is_new_view =
        std::none_of(take_.frames.begin(), take_.frames.end(),
                     [&](const auto& file) { return file.first.parent_path() == view; });
    if (is_new_view && has_frames(take_.folder / view)) take_.has_others = true;
    if (take_.has_others) begin_take();
    output::make_folder(take_.folder / view);
    if (take_.frames.empty()) output::remove_abandoned(take_.folder / view);
    const std::filesystem::path file =
        output::frame_path(take_.folder, view, scene::number_of(*live.scene, live.frame));
    writer_->write(picture_to_keep(file));
    take_.frames[file.lexically_relative(take_.folder)] = live.frame;
    state_.recorded = static_cast<int>(take_.frames.size());
  } catch (const std::exception& error) {
    bench_.say_not_saved(std::string("recording stopped: ") + error.what());
    writer_.reset();
    state_.is_recording = false;
    bench_.session().set_recording(false);
  }
}

}  // namespace neve::app::view
