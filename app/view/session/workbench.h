#pragma once
/// Operations on a running scene, independent of the input device: mouse, keys or a script.

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/record/picture_record.h"
#include "app/scene/flat.h"
#include "app/view/session/document.h"
#include "app/view/session/edit.h"
#include "app/view/session/objects.h"
#include "app/view/session/session.h"
#include "app/view/session/view_sweep.h"

namespace neve::app::view::session {

struct WorkbenchOptions {
  SessionOptions session;
  std::vector<std::string> overrides;  ///< of the command line, as they were given
  setup::Quality quality = setup::Quality::preview;
  std::filesystem::path folder;     ///< for pictures, sequences, scenes and sweeps
  std::string backend = "auto";     ///< that sweeps draw with
  std::filesystem::path program{};  ///< whose `sweep` makes sweeps; empty: this one
  /// Edits come from elsewhere: no file is read that the scene does not name, none is written
  /// outside of the folder, and limits stay.
  bool is_remote = false;
};

struct Message {
  enum class Kind { note, warning, error };
  Kind kind = Kind::note;
  std::string text;
};

class Workbench {
 public:
  /// @param wake called from other threads when there is something new to see
  Workbench(Document document, WorkbenchOptions options, std::function<void()> wake);

  const Document& document() const { return document_; }
  Session& session() { return *session_; }
  const std::filesystem::path& folder() const { return options_.folder; }
  setup::Quality quality() const { return options_.quality; }
  /// Returns the overrides that the run of a frame started with: of the command line and the
  /// document. Captions list them.
  std::vector<std::string> overrides(const LiveFrame& live) const;

  /// Does it at once if that is possible; a change that needs a restart waits for reset(), but at
  /// the very beginning of a run, where nothing is lost. Errors become messages.
  void edit(const Edit& edit);
  void set(const std::string& address, const std::string& value, std::uint64_t gesture = 0);
  /// Adds an object near a place. @return its address; "" after an error
  std::string add_object(NewObject object, const sim::Vec3d& near, double size);
  /// The same for a copy of an object of the scene.
  std::string copy_object(const std::string& address);
  /// The same for a ball that is thrown from now on.
  std::string throw_ball(const Throw& ball);
  void undo();
  void redo();
  void forget(const std::string& address);
  /// Addresses of changed values that take effect only at Reset.
  std::vector<std::string> waiting_for_reset() const;
  void reset();
  /// Continues the run from the older frame shown, with the current parameters.
  void continue_from_here();

  /// Continues a run that broke a rule past it: a change like any other, solver.on_divergence.
  void continue_anyway();

  /// The scene as a picture shows it: the one that runs, with all of the document that concerns
  /// pictures alone.
  scene::Scene display_scene(const LiveFrame& live) const;

  /// True if the scene has a file, and that on disk differs from the one read or saved last.
  bool has_file_changed() const;
  /// Reads the file again and starts again. If it is not a scene, everything stays, and the file
  /// still counts as changed.
  void reload();
  /// Tells why the last reload failed; empty if it did not, or if the file has changed since.
  std::string reload_error() const;
  /// The change on disk is nothing to us.
  void keep_file();

  // Exports. Each leaves a message with the file it wrote or the error, and says false after one.
  bool save_scene(const std::filesystem::path& file);
  /// Saves into the folder, in the place of no file but an earlier copy of this session, or of one
  /// with the same text. @return its name; "" after an error
  std::filesystem::path save_copy();
  bool may_save_over_file() const { return !options_.is_remote && document_.has_own_file(); }
  std::filesystem::path sweep_around(const std::string& address);
  /// Values around that of a parameter, as -p takes them; "" if none can be chosen.
  static std::string values_around(const scene::FlatParam& param);
  /// Starts a sweep whose runs begin at the shown frame. @param view  of its tiles
  /// @return why it did not start; "" if it did
  std::string vary_from_here(const SweepRequest& request, const scene::View& view);
  ViewSweep& sweep() { return sweep_; }
  /// Returns the command that renders the scene as it is now, for the clipboard. If the scene has
  /// no file, one is written into the folder. @return "" after an error
  std::string command();
  /// Record that a picture of this moment needs to be made again.
  record::PictureRecord picture_record(const LiveFrame& live, const scene::View& view) const;
  /// Says that one was saved, and what makes it again.
  /// @param was_between  it was asked for between two frames, and shows the next
  void say_saved_picture(const std::filesystem::path& file, const LiveFrame& live,
                         bool was_between);

  void say(Message::Kind kind, std::string text);
  /// Says the error. A script of clicks ends with it.
  void say_not_saved(std::string text);
  /// The first file that was to be saved and was not; "" while there is none.
  const std::string& not_saved() const { return not_saved_; }
  const std::deque<Message>& messages() const { return messages_; }
  /// Errors that were said so far, repeated ones too: a higher number is one to be seen.
  std::uint64_t errors_said() const { return errors_said_; }

 private:
  /// The document and the edits that a run began with, and the edits that it has learned since.
  struct Start {
    std::uint64_t number;  ///< as frames name it
    Document document;     ///< its text: another one may have been read since
    /// The edits that the simulation knows: at its start, and with the live ones since.
    std::vector<scene::Override> at_start, running;
  };

  SessionOptions session_options() const;
  const Start& start_of(const LiveFrame& live) const;
  std::shared_ptr<const scene::Scene> pictured(const LiveFrame& live) const;
  const Start& newest_start() const;
  Start& newest_start() { return const_cast<Start&>(std::as_const(*this).newest_start()); }
  bool is_file_of_scene(const std::filesystem::path& file) const;
  std::string saved_text(const std::filesystem::path& file) const;
  /// A text for the file that it will be in: it names other files as seen from there.
  using TextIn = std::function<std::string(const std::filesystem::path&)>;
  std::filesystem::path free_name(const std::string& stem, const TextIn& text_in) const;
  std::string file_of_scene() const;
  void require_allowed(const std::string& address, const std::string& value) const;
  void take_over(const std::vector<scene::Override>& before);
  std::vector<std::string> changed_while_running() const;
  std::string changes_too_early(const std::string& what) const;
  void take_waiting();
  void apply_running();
  bool waits_with_its_object(const std::string& address) const;
  bool lacks_its_object(const std::vector<scene::Override>& edits,
                        const std::string& address) const;
  template <class Act>
  bool attempt(Act act);

  Document document_;
  WorkbenchOptions options_;
  std::vector<Start> starts_;  ///< with those that failed since the run that is shown
  std::deque<Message> messages_;
  std::uint64_t errors_said_ = 0;
  std::string not_saved_;
  std::filesystem::path copy_;  ///< of the scene, see save_copy()
  bool is_copy_new_ = true;     ///< it is not written yet
  std::filesystem::file_time_type file_time_{};
  std::filesystem::file_time_type failed_time_{};  ///< of the file that reload_error_ is about
  std::string reload_error_;
  ViewSweep sweep_;
  std::unique_ptr<Session> session_;  ///< last: its thread calls back
};

/// The contents that `neve view` starts with.
struct Opened {
  Document document;                   ///< of a run, with its changes as edits
  std::vector<std::string> overrides;  ///< as they were given, now or to the run
  std::optional<Past> past{};          ///< of a run
};

/// @param file       a scene, a picture or the folder of a run; empty: the default scene
/// @param agreement  to what a picture that came alone costs and reads
/// @throws SceneError, UsageError, IoError, Error
Opened open_document(const std::string& file, const std::vector<std::string>& overrides,
                     double coarsening,
                     timeline::Agreement agreement = timeline::Agreement::refused);

}  // namespace neve::app::view::session
