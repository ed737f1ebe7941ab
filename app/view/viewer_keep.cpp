/// Pictures that stay: of a moment, and a recording of every frame.

#include "app/output/atomic_file.h"
#include "app/output/sequence.h"
#include "app/output/temporary.h"
#include "app/record/run_json.h"
#include "app/view/viewer.h"

namespace neve::app::view {

/// Pictures can be made again where they belong to a frame: one that is asked for between two is
/// that of the next.
bool Viewer::has_picture_to_save() {
  const session::LiveFrame& live = *state_.live;
  if (live.stage && live.is_frame_end) {
    bench_.session().leave_stage();
    settle_ = 3;
    return false;
  }
  if (live.is_frame_end && painted_number_ == live.number && !(goes_on_ && live.is_running))
    return true;
  if (live.divergence) return true;  // there is no next one
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
  record.state_hash = record::hash_text(live.state_hash);
  painted_.reset();  // another picture takes the place of the one on the screen
  return {file, renderer_.draw(picture_frame(std::move(view))), record::to_png_text(record)};
}

void Viewer::save_picture() {
  state_.wants_picture = false;
  const session::LiveFrame& live = *state_.live;
  const bool was_between = is_going_to_frame_ && live.is_frame_end;
  if (goes_on_) bench_.session().run();
  is_going_to_frame_ = goes_on_ = false;
  char number[32];
  std::snprintf(number, sizeof number, "%04d_step%zu.png",
                scene::number_of(*live.scene, live.frame), live.steps);
  const std::filesystem::path file =
      bench_.folder() / (panels::current_view(state_).name + "_" + number);
  try {
    const output::Picture picture = picture_to_keep(file);
    output::make_folder(bench_.folder());
    output::remove_abandoned(bench_.folder());
    output::write_file(file, render::encode_png(picture.image, picture.text));
    bench_.say(session::Message::Kind::note,
               "saved " + file.string() + "; neve render " + file.string() + " makes it again" +
                   (was_between ? "; it shows frame " + std::to_string(live.frame) +
                                      ", the next one: only whole frames can be made again"
                                : ""));
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

/// Every frame once.
void Viewer::record_frame() {
  const session::LiveFrame& live = *state_.live;
  if (!live.is_frame_end || live.frame == recorded_frame_) return;
  recorded_frame_ = live.frame;
  try {
    const std::string& view = panels::current_view(state_).name;
    // Frames have the names that neve render gives them.
    if (!lock_) lock_.emplace(bench_.folder(), "neve view");
    output::make_folder(bench_.folder() / view);
    if (state_.recorded == 0) output::remove_abandoned(bench_.folder() / view);
    writer_.write(picture_to_keep(
        output::frame_path(bench_.folder(), view, scene::number_of(*live.scene, live.frame))));
    ++state_.recorded;
  } catch (const std::exception& error) {
    bench_.say_not_saved(std::string("recording stopped: ") + error.what());
    state_.is_recording = false;
    bench_.session().set_recording(false);
  }
}

}  // namespace neve::app::view
