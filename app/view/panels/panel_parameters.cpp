/// The left column: every parameter, the changes, bodies and colliders.

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "app/picture/attributes.h"
#include "app/picture/snapshot.h"
#include "app/scene/coarsen.h"
#include "app/support/round_number.h"
#include "app/support/text.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/tip.h"
#include "app/view/panels/viewer_state.h"
#include "app/view/panels/widgets.h"
#include "app/view/panels/words.h"

namespace neve::app::view::panels {

namespace {

std::vector<std::string> changed_addresses(const session::Document& document) {
  std::vector<std::string> addresses;
  for (const scene::Override& edit : document.edits()) addresses.push_back(edit.address);
  return addresses;
}

void take_edits(ViewerState& state, const KnobPanel& panel) {
  for (const session::Edit& edit : panel.edits()) {
    if (edit.kind == session::Edit::Kind::copy_address)
      state.copy(edit.address);
    else
      state.bench.edit(edit);
  }
}

/// The scene with the numbers that its file has and --set takes: under --coarsen those that the
/// simulation uses are others. A copy: visitors take members that they could change.
scene::Scene settings_of(const ViewerState& state) {
  scene::Scene scene = *state.bench.document().scene();
  scene::refine_settings(scene, state.bench.document().coarsening());
  return scene;
}

bool is_removed(const ViewerState& state, const std::string& address) {
  const std::vector<scene::Override>& edits = state.bench.document().edits();
  return scene::is_object_address(address) &&
         std::any_of(edits.begin(), edits.end(), [&](const scene::Override& edit) {
           return edit.address == address && edit.value == "none";
         });
}

/// The edits that wait for Reset, below the list, where they move nothing about to be clicked.
class WaitingBox {
 public:
  explicit WaitingBox(ViewerState& state)
      : state_(state), waiting_(state.bench.waiting_for_reset()) {}

  /// Returns the size of the list above the box: it takes what is left.
  ImVec2 size_of_list() const {
    const float below = ImGui::GetStyle().ItemSpacing.y + height();
    return {0, waiting_.empty() ? 0 : -below};
  }

  void draw() {
    if (waiting_.empty()) return;
    ImGui::PushStyleColor(ImGuiCol_ChildBg, ImVec4(0.30f, 0.20f, 0.05f, 0.9f));
    ImGui::BeginChild("waiting", ImVec2(0, height()), true);
    std::string list;
    for (const std::string& address : waiting_)
      list +=
          (list.empty() ? "" : ", ") + address + (is_removed(state_, address) ? " (removed)" : "");
    wrapped_text("waits for Reset: " + list);
    if (ImGui::SmallButton("Reset now")) state_.bench.reset();
    note_label("Reset now");
    ImGui::EndChild();
    ImGui::PopStyleColor();
  }

 private:
  static float height() { return 4.3f * em(); }

  ViewerState& state_;
  std::vector<std::string> waiting_;
};

/// The range of colours that the selected body, or all snow, fills now.
void fit_range(ViewerState& state, const scene::View& view) {
  const session::LiveFrame& live = *state.live;
  if (!picture::has_all(live.snapshot, view)) {
    state.bench.say(session::Message::Kind::note,
                    "no range yet: what view " + view.name +
                        " shows is computed at the next moment of the run that is shown; try "
                        "again then");
    return;
  }
  const std::vector<double> values =
      picture::attribute_values(*live.scene, view.particles.color_by, live.snapshot);
  std::size_t first = 0, end = values.size();
  const setup::SeededScene& seeded = *live.seeded;
  for (std::size_t b = 0; b < seeded.body_end.size(); ++b)
    if (state.selected == "body." + live.scene->bodies[b].name) {
      const sim::ParticleArrays& p = live.snapshot.particles;
      first = p.first_from(seeded.body_begin(b));
      end = std::min(end, p.first_from(seeded.body_end[b]));
    }
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t p = first; p < end; ++p) {
    if (!std::isfinite(values[p])) continue;
    low = std::min(low, values[p]);
    high = std::max(high, values[p]);
  }
  if (!(low < high)) {
    state.bench.say(session::Message::Kind::note, "no range: all values are the same");
    return;
  }
  const double scale = high - low;
  state.bench.set("view." + view.name + ".particles.range",
                  "[" + scene::toml::number_text(round_to(low, scale, 2)) + ", " +
                      scene::toml::number_text(round_to(high, scale, 2)) + "]");
}

constexpr std::size_t max_view_buttons = 8;
/// Half of the extent of an added object, of the distance from which it is seen.
constexpr double new_object_share = 0.035;

void note_view(const scene::View& view, std::size_t index) {
  note_label(("view " + view.name).c_str());
  if (index < 9) tip(("key " + std::to_string(index + 1)).c_str());
}

/// Draws the buttons of views in as many rows as their names need.
void draw_view_buttons(ViewerState& state, const std::vector<scene::View>& views) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  for (std::size_t k = 0; k < views.size(); ++k) {
    const std::string& name = views[k].name;
    const float width =
        ImGui::GetFrameHeight() + style.ItemInnerSpacing.x + ImGui::CalcTextSize(name.c_str()).x;
    if (k > 0 && ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= end) ImGui::SameLine();
    if (ImGui::RadioButton(name.c_str(), name == state.view)) state.view = name;
    note_view(views[k], k);
  }
}

void draw_view_list(ViewerState& state, const std::vector<scene::View>& views) {
  ImGui::SetNextItemWidth(-FLT_MIN);
  if (ImGui::BeginCombo("##views", current_view(state).name.c_str(), ImGuiComboFlags_HeightLarge)) {
    std::string chosen;
    for (std::size_t k = 0; k < views.size(); ++k) {
      if (ImGui::Selectable(views[k].name.c_str(), views[k].name == state.view))
        chosen = views[k].name;
      note_view(views[k], k);
    }
    ImGui::EndCombo();
    if (!chosen.empty()) state.view = chosen;
  }
  note_label("views");
}

}  // namespace

void draw_parameters(ViewerState& state) {
  ImGui::SetNextItemWidth(-FLT_MIN);
  ImGui::InputTextWithHint("##filter", "find a parameter", &state.filter);
  note_label("find a parameter");
  WaitingBox waiting(state);
  ImGui::BeginChild("list", waiting.size_of_list());
  scene::Scene scene = settings_of(state);
  KnobPanel panel(state.filter, changed_addresses(state.bench.document()));
  Knobs knobs(panel, "");
  scene::describe(knobs, scene);
  if (!panel.has_shown()) {
    dim_text("No parameter here is called \"" + state.filter + "\" or has it in its description.");
  }
  ImGui::EndChild();
  waiting.draw();
  take_edits(state, panel);
}

void draw_changes(ViewerState& state) {
  const std::vector<session::ChangedValue> changes = state.bench.document().changes();
  if (changes.empty()) {
    const session::Document& document = state.bench.document();
    dim_text("Nothing differs from " +
             (document.has_file() ? document.file() : "the scene as it was opened") + ".");
    return;
  }
  if (labelled_button("Restore all")) state.bench.forget("");
  ImGui::SameLine();
  if (labelled_button("Copy the command")) copy_command(state);
  ImGui::BeginChild("changes");
  for (const session::ChangedValue& change : changes) {
    ImGui::PushID(change.address.c_str());
    if (ImGui::SmallButton("x")) state.bench.forget(change.address);
    tip("restore the value in the file");
    ImGui::SameLine();
    ImGui::TextUnformatted(change.address.c_str());
    ImGui::Indent(1.6f * em());
    ImGui::TextColored(ImVec4(1.0f, 0.72f, 0.35f, 1), "%s", change.value.c_str());
    ImGui::SameLine();
    ImGui::TextDisabled(
        "%s", change.in_file.empty() ? "(not in the file)" : ("was " + change.in_file).c_str());
    ImGui::Unindent(1.6f * em());
    ImGui::PopID();
  }
  ImGui::EndChild();
}

namespace {

void draw_add_menu(ViewerState& state) {
  if (labelled_button("Add ...")) ImGui::OpenPopup("add");
  tip("add a body, a collider, an emitter or a sink where the camera looks");
  if (!ImGui::BeginPopup("add")) return;
  using enum session::NewObject;
  for (const session::NewObject object :
       {snow_ball, snow_block, emitter, sink, sphere, box, floor}) {
    const char* title = session::title_of(object);
    if (ImGui::MenuItem(title)) {
      const std::string added = state.bench.add_object(object, state.orbit.target(),
                                                       new_object_share * state.orbit.distance());
      if (!added.empty()) state.selected = added;
    }
    note_label(title);
  }
  ImGui::EndPopup();
}

/// Buttons that add, copy and remove.
void draw_object_buttons(ViewerState& state) {
  draw_add_menu(state);
  if (state.selected.empty()) return;
  ImGui::SameLine();
  if (labelled_button("Copy")) {
    const std::string copied = state.bench.copy_object(state.selected);
    if (!copied.empty()) state.selected = copied;
  }
  tip("add a copy of the selected object, with its changes, beside it");
  ImGui::SameLine();
  if (labelled_button("Remove")) state.bench.set(state.selected, "none");
  tip("remove the selected object; ctrl+Z brings it back");
}

/// Nothing is selected any more where another edit, or an undo, has removed the object.
void forget_removed_selection(ViewerState& state, const scene::Scene& scene) {
  const auto has = [&](const char* list, const auto& items) {
    return std::any_of(items.begin(), items.end(),
                       [&](const auto& item) { return state.selected == list + item.name; });
  };
  if (!has("body.", scene.bodies) && !has("emitter.", scene.emitters) &&
      !has("sink.", scene.sinks) && !has("collider.", scene.colliders))
    state.selected.clear();
}

}  // namespace

void draw_objects(ViewerState& state) {
  WaitingBox waiting(state);
  forget_removed_selection(state, *state.bench.document().scene());
  draw_object_buttons(state);
  draw_throwing(state);
  scene::Scene scene = settings_of(state);
  const auto entry = [&](const std::string& address, const sim::shapes::Shape& shape) {
    const bool is_selected = state.selected == address;
    if (ImGui::Selectable(address.c_str(), is_selected))
      state.selected = is_selected ? "" : address;
    note_label(address.c_str());
    if (wants_tip()) {
      const sim::Vec3d place = sim::shapes::center(shape);
      show_tip({{"at " + rough_text(place.x()) + ", " + rough_text(place.y()) + ", " +
                 rough_text(place.z()) + " m; drag its arrows in the picture"}});
    }
  };
  for (const sim::seeding::Body& body : scene.bodies) entry("body." + body.name, body.shape);
  for (const sim::seeding::Emitter& emitter : scene.emitters)
    entry("emitter." + emitter.name, emitter.shape);
  for (const sim::seeding::Sink& sink : scene.sinks) entry("sink." + sink.name, sink.shape);
  for (const scene::Collider& collider : scene.colliders)
    entry("collider." + collider.name, collider.shape);
  ImGui::Separator();
  ImGui::BeginChild("object", waiting.size_of_list());
  KnobPanel panel("", changed_addresses(state.bench.document()));
  const auto knobs_of = [&](const char* list, auto& items) {
    for (auto& item : items)
      if (state.selected == list + item.name) {
        Knobs knobs(panel, state.selected);
        scene::describe(knobs, item);
      }
  };
  knobs_of("body.", scene.bodies);
  knobs_of("emitter.", scene.emitters);
  knobs_of("sink.", scene.sinks);
  knobs_of("collider.", scene.colliders);
  if (state.selected.empty()) ImGui::TextDisabled("Select an object to move or change it.");
  ImGui::EndChild();
  waiting.draw();
  take_edits(state, panel);
}

void draw_view_panel(ViewerState& state) {
  const scene::Scene& scene = *state.bench.document().scene();
  if (scene.views.size() <= max_view_buttons)
    draw_view_buttons(state, scene.views);
  else
    draw_view_list(state, scene.views);
  if (labelled_button("Frame all")) frame_all(state);
  ImGui::SameLine();
  if (labelled_button("Scene's camera")) state.is_camera_of_scene = true;
  if (current_view(state).particles.color_by != scene::ColorBy::snow &&
      scene::shows_particles(current_view(state))) {
    ImGui::SameLine();
    if (labelled_button("Fit the range")) fit_range(state, current_view(state));
    tip("colours from the smallest to the largest value of the selected body,\nor of all snow, at "
        "this moment");
  }
  ImGui::Separator();
  ImGui::BeginChild("view");
  scene::View view = current_view(state);
  KnobPanel panel("", changed_addresses(state.bench.document()));
  bool is_cut = view.clip.has_value();
  if (ImGui::Checkbox("cut by a plane", &is_cut)) {
    const std::string clip = "view." + view.name + ".clip";
    const bool is_cut_in_file = state.bench.document().in_file(clip + ".normal").has_value();
    // A plane of the file is switched off by a word, any other by taking the edit back.
    if (is_cut_in_file)
      panel.note({is_cut ? session::Edit::Kind::as_in_file : session::Edit::Kind::set, clip,
                  is_cut ? "" : "none", 0});
    else if (is_cut)
      panel.note({session::Edit::Kind::set, clip + ".normal", "[0, 0, 1]", 0});
    else
      panel.note({session::Edit::Kind::as_in_file, clip + ".", "", 0});
  }
  note_label("cut by a plane");
  ImGui::SetNextItemOpen(true, ImGuiCond_Once);
  Knobs knobs(panel, "view." + view.name);
  scene::describe(knobs, view);
  scene::Scene lit = scene;
  if (ImGui::TreeNode("light")) {
    Knobs light(panel, "light");
    scene::describe(light, lit.light);
    ImGui::TreePop();
  }
  ImGui::EndChild();
  take_edits(state, panel);
}

}  // namespace neve::app::view::panels
