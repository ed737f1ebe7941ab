#pragma once
/// Places of named widgets on the picture, so that scripts, tests and documentation click "Run" and
/// not (212, 48), and survive a new layout.

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace neve::app::view::panels {

/// The part of a widget that can be seen, px of the picture from its upper left corner.
struct LabelPlace {
  float x = 0, y = 0, width = 0, height = 0;
  /// False if scrolled out of sight: the place is then that of the whole widget.
  bool is_visible = true;
};

/// The labelled widgets of the last frame. There is one, as there is one current ImGui context;
/// only the thread that draws the panels uses it.
class Labels {
 public:
  static Labels& of_panels();

  /// Clears the labels at the first label of another frame.
  /// @param name text on the widget; a second one in the frame becomes "Run#2"
  /// @return true if it should be scrolled into sight
  bool note(const std::string& name, const LabelPlace& place, int frame);

  std::optional<LabelPlace> find(const std::string& name) const;
  /// Returns the names in the order in which they were drawn.
  const std::vector<std::string>& names() const { return names_; }
  /// The smallest visible widget around a place, or empty.
  std::string name_at(float x, float y) const;

  /// Lets a panel scroll to this widget when it is drawn next and out of sight.
  void scroll_to(const std::string& name) { wanted_ = name; }

  void clear();

 private:
  std::map<std::string, LabelPlace> places_;
  std::vector<std::string> names_;
  std::string wanted_;
  int frame_ = -1;
};

/// Notes the widget that ImGui drew last; text after "##" in a name is left out, as on the
/// widget.
void note_label(const char* name);
/// A button with its label. @param name  where it is another than the words @return whether it is
/// pressed
bool labelled_button(const char* words, const char* name = nullptr);
/// Notes any rectangle, such as that of the 3D picture.
void note_label(const char* name, const LabelPlace& place);

}  // namespace neve::app::view::panels
