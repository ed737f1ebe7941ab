#pragma once
/// The loop of `neve view`: input, panels, pictures.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/output/folder_lock.h"
#include "app/output/picture_writer.h"
#include "app/support/clock.h"
#include "app/view/frontend/frontend.h"
#include "app/view/frontend/imgui_input.h"
#include "app/view/panels/viewer_state.h"
#include "render/renderer.h"
#include "render/screen.h"

namespace neve::app::view {

struct ViewerOptions {
  int max_pictures = 0;             ///< ends after so many; 0: never
  bool is_running = false;          ///< from the start
  bool has_own_clock = false;       ///< panels see 1/60 s pass from picture to picture: scripts
  std::optional<std::string> view;  ///< the first one; without: the scene's first
};

/// Key of the contents of the picture, independent of the camera.
struct StateKey {
  std::shared_ptr<const scene::Scene> scene;  ///< as it is edited
  std::uint64_t number = 0;                   ///< of the LiveFrame
  bool shows_incident = false;
  std::string view;
  bool operator==(const StateKey&) const = default;
};

/// Everything that the picture depends on.
struct PictureKey {
  StateKey state;
  int width = 0, height = 0;
  panels::Orbit camera;
  bool is_camera_of_scene = false;
  bool operator==(const PictureKey&) const = default;
};

/// Everything that a recorded picture depends on.
struct RecordedKey {
  std::uint64_t start = 0, state_hash = 0;
  int frame = 0;
  std::shared_ptr<const scene::Scene> scene;  ///< as it is edited
  std::string view;
  bool shows_incident = false;
  std::optional<panels::Orbit> camera;  ///< of the viewport; none: the scene's own
  bool operator==(const RecordedKey&) const = default;
};

/// The pictures of a recording that are of one run, in a folder of their own.
struct Take {
  std::filesystem::path folder;
  std::map<std::filesystem::path, int> frames{};  ///< by their files, relative to the folder
  session::KeptRun run{};
  bool has_others = false;  ///< the folder has pictures of a run that was left
};

/// s without a move of the camera.
inline constexpr double still_after = 0.25;

class Viewer {
 public:
  Viewer(session::Workbench& bench, frontend::Frontend& front, render::Screen& screen,
         render::Renderer& renderer, const ViewerOptions& options);

  /// Runs until the frontend closes, or Ctrl-C.
  void run();

  panels::ViewerState& state() { return state_; }

 private:
  void take_events(std::vector<frontend::InputEvent> events);
  void take_drop(const std::string& file);
  void take_live_frame();
  void show_news();
  bool is_still() const;
  void draw();
  void paint_picture();
  bool show_sheet();
  void paint_new_picture();
  void follow_camera();
  scene::View shown_view() const;
  render::Frame picture_frame(const scene::View& view);
  void keep_points(render::Points points);
  int font_size() const;    ///< px
  int line_height() const;  ///< px, of the time line
  void lay_out();
  void draw_panels();
  void play(double seconds);
  void follow();
  bool has_picture_to_save();
  output::Picture picture_to_keep(const std::filesystem::path& file);
  void save_picture();
  void download(const std::filesystem::path& file);
  void stop_recording();
  void keep_recording();
  void record_due();
  void follow_run();
  void begin_take();
  void forget_unwritten();
  bool has_what_is_shown() const;
  RecordedKey recorded_key() const;
  void announce_view();
  double seconds_passed();
  StateKey state_key() const;
  PictureKey picture_key() const;

  session::Workbench& bench_;
  frontend::Frontend& front_;
  render::Screen& screen_;
  render::Renderer& renderer_;
  ViewerOptions options_;
  frontend::ImGuiInput input_;
  panels::ViewerState state_;
  std::optional<output::PictureWriter> writer_;  ///< of a recording: what failed ends with it
  std::optional<output::FolderLock> lock_;       ///< while frames are recorded
  bool is_closed_ = false;
  int pictures_ = 0;
  float styled_scale_ = 0;  ///< that the panels' distances are for
  int settle_ = 3;          ///< pictures that ImGui still needs to come to rest
  std::uint64_t painted_number_ = 0;
  std::optional<PictureKey> painted_;  ///< empty: another picture is on the screen
  render::Points
      points_;  ///< of the last picture: the next has the same while only the camera moves
  std::optional<StateKey> points_of_;  ///< the state that they belong to
  std::filesystem::path sheet_file_;
  std::pair<int, int> sheet_room_;  ///< px, that it was made for
  render::Image sheet_;             ///< of the sweep that is shown in the picture's place
  double scale_ = 1;                ///< of the picture last painted
  double full_seconds_ = 0;         ///< that a picture of full size takes
  Clock::time_point moved_at_{};
  Clock::time_point drawn_at_ = Clock::now(), file_looked_at_{};
  bool has_input_ = false;                            ///< since the last picture
  bool is_going_to_frame_ = false, goes_on_ = false;  ///< for a picture that is to be saved
  std::optional<RecordedKey> recorded_;               ///< the last picture of the recording
  bool is_record_due_ = false;                        ///< another one of its frame
  Take take_;
  std::pair<std::shared_ptr<const scene::Scene>, std::string> announced_;  ///< to the session
};

}  // namespace neve::app::view
