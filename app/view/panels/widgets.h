#pragma once
/// Parameters as ImGui widgets: the visitor of describe.h for the panels.

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "app/scene/describe.h"
#include "app/scene/leaf.h"
#include "app/scene/search.h"
#include "app/scene/toml/value.h"
#include "app/view/panels/tip.h"
#include "app/view/session/edit.h"

namespace neve::app::view::panels {

/// One leaf on its way to a widget.
struct Knob {
  std::string address, label;
  const char* unit;
  const scene::Valid& valid;
  const char* help;
  bool is_live;
  mutable std::string refusal{};  ///< why the widget did not take the typed text; empty: it did
};

/// @return whether the value was changed; it is valid then
bool edit_value(const Knob& knob, bool& value);
bool edit_value(const Knob& knob, double& value);
bool edit_value(const Knob& knob, int& value);
bool edit_value(const Knob& knob, std::uint64_t& value);
bool edit_value(const Knob& knob, std::string& value);
bool edit_value(const Knob& knob, sim::Vec3d& value);
bool edit_value(const Knob& knob, std::vector<std::string>& value);
bool edit_value(const Knob& knob, scene::PictureSize& value);
bool edit_value(const Knob& knob, scene::Range& value);
/// @param index -1: no item
bool edit_choice(const Knob& knob, const std::vector<std::string>& choices, int& index);
bool edit_choices(const Knob& knob, const std::vector<std::string>& choices,
                  std::vector<bool>& chosen);

inline bool edit_value(const Knob& knob, sim::laws::OneOf& value) {
  int index = static_cast<int>(value.place);
  if (!edit_choice(knob, scene::choices(value), index)) return false;
  value.place = static_cast<std::size_t>(index);
  return true;
}

template <scene::Choice E>
bool edit_value(const Knob& knob, E& value) {
  const auto all = scene::names(E{});
  int index = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].value == value) index = static_cast<int>(k);
  if (!edit_choice(knob, scene::choices<E>(), index)) return false;
  value = all[static_cast<std::size_t>(index)].value;
  return true;
}

template <scene::Choice E>
bool edit_value(const Knob& knob, std::vector<E>& value) {
  const auto all = scene::names(E{});
  std::vector<bool> chosen(all.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    chosen[k] = std::find(value.begin(), value.end(), all[k].value) != value.end();
  if (!edit_choices(knob, scene::choices<E>(), chosen)) return false;
  value.clear();
  for (std::size_t k = 0; k < all.size(); ++k)
    if (chosen[k]) value.push_back(all[k].value);
  return true;
}

/// The number of a drag, for changes that are taken back together: another one for each press of
/// the mouse. @param held  what the mouse holds; 0: nothing, each change is taken back alone
std::uint64_t gesture_of(std::uint64_t held);

/// Context of the widgets of one panel.
class KnobPanel {
 public:
  /// @param filter only knobs that these words mean; "": all
  /// @param is_changed, what the document knows of an address
  KnobPanel(const std::string& filter, std::vector<std::string> changed)
      : search_(filter), changed_(std::move(changed)) {}

  bool shows(const std::string& address, const char* help) const;
  bool is_filtered() const { return !search_.is_empty(); }
  /// A title that is drawn with the first knob below it, or never.
  void open_title(const std::string& title);
  void close_title();
  bool has_shown() const { return has_shown_; }  ///< a knob
  bool is_changed(const std::string& address) const;
  /// True if a value below this address differs from the file.
  bool has_changes_below(const std::string& prefix) const;
  /// These calls come before and after a widget: id, label, tooltip, menu.
  void begin(const Knob& knob);
  void end(const Knob& knob, const std::string& value);
  void note(session::Edit edit) { edits_.push_back(std::move(edit)); }
  std::uint64_t gesture() const;

  const std::vector<session::Edit>& edits() const { return edits_; }

 private:
  scene::Search search_;
  std::vector<std::string> changed_;
  std::vector<session::Edit> edits_;
  std::vector<std::string> titles_;  ///< that wait for a knob
  bool has_shown_ = false;
};

/// Knows nothing of what is behind the addresses: a scene, or a part of one.
class Knobs {
 public:
  /// @param address of the table, "" for the scene
  Knobs(KnobPanel& panel, std::string address) : panel_(panel), address_(std::move(address)) {}

  template <class T>
  void operator()(const char* key, T& member, const char* unit, const scene::Valid& valid,
                  scene::Change change, const char* help) {
    if (valid.text == scene::Valid::Text::name && std::string(key) == "name") return;
    const Knob knob{at(key), key, unit, valid, help, change == scene::Change::live};
    if (!panel_.shows(knob.address, help)) return;
    panel_.begin(knob);
    edit(knob, member);
  }

  template <class Describe>
  void section(const char* key, const char* help, Describe describe_members) {
    group(key, help, describe_members);
  }

  template <class T>
  void optional(const char* key, std::optional<T>& member, const char* help) {
    if (member) group(key, help, [&](auto& v) { scene::describe(v, *member); });
  }

  template <class T>
  void named(const char* key, std::vector<T>& items, const char* help) {
    list(key, items, help);
  }

  template <class T>
  void list(const char* key, std::vector<T>& items, const char* help) {
    for (T& item : items) {
      const std::string title = std::string(key) + " " + item.name;
      group(std::string(key) + "." + item.name, title, help,
            [&](auto& v) { scene::describe(v, item); });
    }
  }

  /// Keyframes have no addresses: the file is where they are changed.
  template <class T>
  void sequence(const char*, std::vector<T>&, const char*) {}
  void addresses(const char*, scene::toml::Table&, const char*) {}
  void address_lists(const char*, std::vector<scene::toml::Table>&, const char*) {}

  template <class Describe>
  void shape(const char* key, sim::shapes::Shape& shape, const char*, Describe describe_forms) {
    Knobs inner(panel_, at(key));
    describe_forms(inner, shape);
  }

  template <class Form>
  void form(const char* key, sim::shapes::Shape& shape, scene::Change change, const char*) {
    Form* form = std::get_if<Form>(&shape.form);
    if (!form) return;
    Knobs inner(panel_, at(key));
    scene::describe(inner, *form, change);
    scene::describe_rotation(inner, shape, change);
  }

  template <scene::Choice E, class Use>
  void shorthand(const char* key, const std::optional<E>& now, Use, const char* help) {
    // The parameters that it sets show themselves if they wait for Reset.
    const Knob knob{at(key), key, scene::unit::none, scene::anything, help, true};
    if (!panel_.shows(knob.address, help)) return;
    panel_.begin(knob);
    const std::vector<std::string> all = scene::choices<E>();
    int index =
        now ? static_cast<int>(std::find(all.begin(), all.end(), scene::name(*now)) - all.begin())
            : -1;
    const bool is_set = edit_choice(knob, all, index);
    const std::string value =
        index < 0 ? "" : scene::toml::toml_string(all[static_cast<std::size_t>(index)]);
    panel_.end(knob, value);
    if (is_set) panel_.note({session::Edit::Kind::set, knob.address, value, panel_.gesture()});
  }

 private:
  std::string at(const std::string& key) const {
    return address_.empty() ? key : address_ + "." + key;
  }

  template <class Describe>
  void group(const std::string& key, const char* help, Describe describe_members) {
    group(key, key, help, describe_members);
  }

  template <class Describe>
  void group(const std::string& key, const std::string& title, const char* help,
             Describe describe_members) {
    if (!open(at(key), title, help)) return;
    Knobs inner(panel_, at(key));
    describe_members(inner);
    close();
  }
  bool open(const std::string& address, const std::string& title, const char* help);
  void close();

  template <class T>
  void edit(const Knob& knob, const T& member) {
    T value = member;
    const bool is_set = edit_value(knob, value);
    panel_.end(knob, scene::toml::toml_literal(scene::to_value(value)));
    if (is_set)
      panel_.note({session::Edit::Kind::set, knob.address,
                   scene::toml::toml_literal(scene::to_value(value)), panel_.gesture()});
  }

  /// "auto" is a box that is ticked.
  template <class T>
  void edit(const Knob& knob, const std::optional<T>& member) {
    bool is_given = member.has_value();
    T value = member.value_or(T{});
    ImGui::Checkbox("##given", &is_given);
    tip(is_given ? "given; untick to restore the value in the file" : "automatic");
    ImGui::SameLine();
    bool is_set = false;
    if (is_given)
      is_set = edit_value(knob, value);
    else
      ImGui::TextDisabled("automatic");
    panel_.end(knob, scene::toml::toml_literal(scene::to_value(value)));
    if (is_given != member.has_value() || is_set) {
      if (is_given)
        panel_.note({session::Edit::Kind::set, knob.address,
                     scene::toml::toml_literal(scene::to_value(value)), panel_.gesture()});
      else
        panel_.note({session::Edit::Kind::as_in_file, knob.address, "", 0});
    }
  }

  KnobPanel& panel_;
  std::string address_;
};

}  // namespace neve::app::view::panels
