#pragma once
/// The scene being edited: the file, the changes since, and their undo.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/override.h"
#include "app/scene/scene.h"

namespace neve::app::view::session {

/// The time at which a change takes effect.
enum class Effect {
  display,  ///< drawing; the simulation knows nothing of it
  live,     ///< from the next step on
  restart   ///< from frame 0 on
};
Effect effect_of(const std::string& address);

/// A value that is not the file's.
struct ChangedValue {
  std::string address;
  std::string value;    ///< TOML
  std::string in_file;  ///< TOML; empty: the file has none, and a default counts
};

/// The other place that keeps the text of a document.
enum class Source {
  own_file,      ///< in a file of the user
  shipped_file,  ///< in one that came with the program, which nobody named
  no_file        ///< in no scene file: it comes from a run, a picture or standard input
};

class Document {
 public:
  /// Every view that the scene has or could have has a camera and ranges.
  /// @param overrides of the command line @param coarsening  that is done to the text
  /// @param coarsened  that was done to it before: it has the cells of a coarse run
  /// @throws the errors of read_scene_text
  Document(std::string file, std::string text, std::vector<scene::Override> overrides,
           double coarsening, Source source = Source::own_file, double coarsened = 1);

  /// The name of the text: relative paths start from its folder. Only has_file() says that there is
  /// such a file.
  const std::string& file() const { return file_; }
  bool has_file() const { return source_ != Source::no_file; }
  /// True if that file may be written over.
  bool has_own_file() const { return source_ == Source::own_file; }
  const std::string& text() const { return text_; }
  const std::shared_ptr<const scene::Scene>& scene() const { return scene_; }
  double coarsening() const { return coarsening_; }
  /// Returns how coarse its cells are, for captions and records, with what a run or a picture that
  /// was opened had already.
  double whole_coarsening() const { return coarsened_ * coarsening_; }
  /// Returns what --coarsen sets in the scene beside lengths and times, as --set would.
  const std::vector<std::string>& set_by_coarsening() const { return set_by_coarsening_; }
  /// The overrides of the command line, then the edits.
  std::vector<scene::Override> all_overrides() const { return with(edits_); }

  /// A material's preset is remembered as the numbers that it changes. A whole object, "body.ball",
  /// takes the edits inside of it along.
  /// @param value TOML
  /// @param gesture changes with the same number, not 0, are taken back together
  /// @throws SceneError, UsageError; LimitError where the scene would need more than before, and
  /// more than its limits allow; and then nothing has changed
  void set(const std::string& address, const std::string& value, std::uint64_t gesture = 0);
  /// Returns to the value of the file and the command line: of one address, or with a '.' at its
  /// end of all below it, or with "" of all.
  void forget(const std::string& address);

  bool can_undo() const { return !done_.empty(); }
  bool can_redo() const { return !undone_.empty(); }
  /// @return the address that changed, or that of one of several
  std::string undo();
  std::string redo();

  /// Lists the changed values in the order in which they were first changed.
  std::vector<ChangedValue> changes() const;
  bool is_changed(const std::string& address) const;
  const std::vector<scene::Override>& edits() const { return edits_; }

  /// Addresses that differ between two moments of the document.
  static std::vector<std::string> difference(const std::vector<scene::Override>& before,
                                             const std::vector<scene::Override>& after);

  /// The value that an address has without edits, TOML; empty if the file has none.
  std::optional<std::string> in_file(const std::string& address) const;
  std::optional<std::string> default_of(const std::string& address) const;

  /// The scene with other edits than the document's. @throws SceneError, UsageError
  std::shared_ptr<const scene::Scene> scene_with(const std::vector<scene::Override>& edits) const {
    return read(text_, edits);
  }

  /// A run of another document could begin in the place of the present one.
  /// @throws LimitError where it would need more than its limits allow
  void require_room_for(const Document& next) const;

  /// The same edits on another text: the file was changed meanwhile.
  /// @throws SceneError, UsageError when they do not fit, and then nothing has changed
  void reload(std::string text);

 private:
  std::vector<scene::Override> with(const std::vector<scene::Override>& edits) const;
  /// @param set_by_coarsening  takes what --coarsen sets; null: it is not asked for
  std::shared_ptr<const scene::Scene> read(
      const std::string& text, const std::vector<scene::Override>& edits,
      std::vector<std::string>* set_by_coarsening = nullptr) const;
  std::optional<std::string> in_preset(const scene::toml::Table& root,
                                       const std::string& address) const;
  void put_object(std::vector<scene::Override>& edits, const std::string& address,
                  const std::string& value) const;
  void become(std::vector<scene::Override> edits);
  std::string step(std::vector<std::vector<scene::Override>>& from,
                   std::vector<std::vector<scene::Override>>& to);
  void require_within_limits(const scene::Scene& next) const;

  std::string file_, text_;
  std::vector<scene::Override> overrides_;
  double coarsening_, coarsened_;
  Source source_;
  std::vector<std::string> set_by_coarsening_;
  std::vector<scene::Override> edits_;
  std::vector<std::vector<scene::Override>> done_, undone_;
  std::uint64_t gesture_ = 0;
  std::shared_ptr<const scene::Scene> scene_;
  // Found once, by a coarse run: pictures must not jump while a parameter changes.
  std::optional<scene::CameraSettings> camera_;
  std::map<std::string, scene::CameraSettings> view_cameras_;
};

}  // namespace neve::app::view::session
