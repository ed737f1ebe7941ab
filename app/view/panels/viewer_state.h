#pragma once
/// State that the panels of `neve view` show and change.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/view/panels/orbit.h"
#include "app/view/session/live_frame.h"
#include "app/view/session/workbench.h"
#include "app/view/session/written_files.h"
#include "render/frame/frame.h"
#include "render/screen.h"

namespace neve::app::view::panels {

/// A quantity of the probed point over simulated time.
struct ProbeTrace {
  std::string quantity;             ///< empty: the first one
  std::map<double, double> points;  ///< s, magnitude
  std::optional<dump::Probe> target;
  session::KeptRun run{};

  /// Adds the moment. Points of another run are forgotten, later ones of this run stay while an
  /// earlier moment is shown.
  void take(const session::LiveFrame& live);
};

/// Columns beside the picture.
struct PanelSwitches {
  bool left = true, right = true;
  bool is_narrow = false;      ///< there is room for one
  bool is_stacked = false;     ///< it is below the picture, not beside it
  bool prefers_right = false;  ///< of both this one

  bool is_one_of_two() const { return is_narrow && left && right; }
  bool shows_left() const { return left && !(is_one_of_two() && prefers_right); }
  bool shows_right() const { return right && !(is_one_of_two() && !prefers_right); }
};

/// A few words at a place of the picture, for a moment.
struct Hint {
  std::string text;
  float x = 0, y = 0;  ///< px
  double seconds = 0;  ///< that it stays
};

/// Input of the dialog "Vary from here".
struct SweepForm {
  bool is_open = false;
  std::string filter;  ///< of the parameters
  std::vector<session::SweepAxis> axes;
  int last_frame = 0;
  bool has_longer_steps = false;
  bool waits_for_sheet = false;  ///< of runs that were started
  bool shows_sheet = false;      ///< in the place of the picture
  std::string error;
};

/// The tool that throws balls.
struct Throwing {
  bool is_on = false;
  double radius = 0;     ///< m; 0: not chosen yet
  double density = 900;  ///< kg/m3, of ice
  double speed = 0;      ///< m/s
};

struct ViewerState {
  session::Workbench& bench;
  std::shared_ptr<const session::LiveFrame> live{};

  Orbit orbit{};
  bool is_camera_of_scene = true;  ///< the user has not moved the camera: it follows the scene
  std::string view = "particles";
  render::PicturePlace viewport{};  ///< px
  PanelSwitches panels{};
  bool is_help_open = false;
  bool is_sign_taken = false;  ///< that the key which is held has typed
  int tour_step = -1;          ///< of the guided tour; -1: it is over
  int bar_rows = 1;            ///< of buttons at the top, in the last picture

  std::string filter{};    ///< of the parameters
  std::string selected{};  ///< "body.ball", "collider.floor" or ""
  std::optional<dump::Probe> probe{};
  bool follows_probe = false;
  ProbeTrace trace{};
  std::optional<sim::Vec3d> last_followed{};
  session::FieldName histogram{false, "J_P"};  ///< the field whose spread is shown
  bool is_histogram_open = false;
  bool wants_histogram = false;  ///< its list is opened in the next picture

  bool asks_to_continue = false;  ///< from an older frame, which drops later ones
  bool is_playing = false;        ///< kept frames, one after the other
  double play_clock = 0;          ///< s since the last one
  bool is_recording = false;
  int recorded = 0;  ///< pictures of it so far
  bool wants_picture = false;
  std::size_t tab = 0;                     ///< of the right column
  std::optional<std::size_t> go_to_tab{};  ///< opens this one
  bool go_to_parameters = false;           ///< opens that tab of the left column
  std::uint64_t errors_seen = 0;           ///< of the session
  std::uint64_t errors_told = 0;           ///< of the messages: their tab was opened for these
  bool is_divergence_told = false;
  bool is_reload_offered = false;            ///< the scene file was changed by another program
  std::optional<session::Opened> dropped{};  ///< to be shown instead
  Hint hint{};
  bool shows_incident = false;  ///< rings around the culprits

  double frames_per_second = 0;  ///< of the pictures
  double picture_ms = 0;
  std::function<void(const std::string&)> copy{};
  /// Sends a written file to the user's machine; empty where it is this one.
  std::function<void(const std::filesystem::path&)> download{};
  bool is_picture_downloaded = false;  ///< the one that is saved next
  bool is_file_list_open = false;
  std::vector<session::WrittenFile> files{};
  SweepForm sweep{};
  Throwing throwing{};
};

/// The tabs of the right column.
namespace tab {
inline constexpr std::size_t view = 0, inspect = 1, plots = 2, messages = 3;
}

const scene::View& current_view(const ViewerState& state);
/// The same with the camera of the scene until that is moved: for pictures that stay.
scene::View view_to_keep(const ViewerState& state);
void set_probe(ViewerState& state, std::optional<dump::Probe> probe);

void toggle_run(ViewerState& state);
/// True if nothing of the run is newer than the end of this frame: it may be between two.
bool is_newest(const session::LiveFrame& live, int frame);
/// Shows a kept frame, or where the run is.
void show_frame(ViewerState& state, int frame);
/// Frames all snow, colliders, emitters and sinks, but those that are far larger than the snow.
void frame_all(ViewerState& state);
/// Frames the probed or selected object; everything if there is none.
void frame_selection(ViewerState& state);
/// Copies the command that renders the scene as it is now.
void copy_command(ViewerState& state);
/// Brings the culprits of the broken rule into the picture.
void show_incident(ViewerState& state);

/// Panels; each draws into the current ImGui window.
void draw_transport(ViewerState& state);
void draw_parameters(ViewerState& state);
void draw_objects(ViewerState& state);
/// The switch and the numbers of the tool that throws balls.
void draw_throwing(ViewerState& state);
void switch_throwing(ViewerState& state);
void draw_changes(ViewerState& state);
void draw_view_panel(ViewerState& state);
void draw_inspector(ViewerState& state);
/// The spread of a field over all nodes or particles.
void draw_histogram(ViewerState& state);
void draw_plots_panel(ViewerState& state);
/// Curves over the time of the scene, with the moment that is shown; title and legend are words
/// above, which wrap.
/// @param has_zero  the axis reaches to 0
void draw_over_time(const ViewerState& state, const char* label, const std::string& title,
                    std::vector<render::PlotSeries> list, bool has_zero);
void draw_messages(ViewerState& state);
void draw_time_line(ViewerState& state);
void draw_help(ViewerState& state);
/// The list of written files, while it is open.
void draw_files(ViewerState& state);
void open_file_list(ViewerState& state);
/// The dialog that varies parameters from the shown frame on, while it is open.
void draw_sweep(ViewerState& state);
void open_sweep(ViewerState& state);
void start_tour(ViewerState& state);
void draw_tour(ViewerState& state);
/// Draws a pending question: a file that changed.
void draw_offer(ViewerState& state);
/// Draws the button that brings hidden panels back, where there may be no key for it.
void draw_panel_switch(ViewerState& state);
void draw_left_column(ViewerState& state);
void draw_right_column(ViewerState& state);

/// Follows the mouse over the picture, and draws over it: handles, the probed place.
void use_viewport(ViewerState& state);
/// Keys that are not for a text field.
void use_keys(ViewerState& state);

/// The snow, and colliders, emitters and sinks of its order of size; planes have no end.
sim::shapes::Bounds bounds_of_all(const session::LiveFrame& live);

/// The current ImGui text size.
float em();

}  // namespace neve::app::view::panels
