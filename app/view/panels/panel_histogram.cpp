/// The spread of a field: bars, the range that is expected below them, the probed value as a line.

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/support/text.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/tip.h"
#include "app/view/panels/viewer_state.h"
#include "app/view/panels/words.h"

namespace neve::app::view::panels {

namespace {

constexpr ImU32 bar_color = IM_COL32(110, 190, 255, 255), bad_color = IM_COL32(255, 107, 82, 255),
                expected_color = IM_COL32(120, 200, 130, 255),
                probe_color = IM_COL32(255, 175, 80, 255), back_color = IM_COL32(255, 255, 255, 14);

std::string title(const session::FieldName& field) {
  return field.name + (field.is_of_nodes ? " of nodes" : " of particles");
}

/// A place of the widget, and the histogram that is drawn there.
class Bars {
 public:
  Bars(const dump::Histogram& histogram, ImVec2 at, ImVec2 size)
      : h_(histogram), at_(at), size_(size) {}

  void draw() const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at_, ImVec2(at_.x + size_.x, at_.y + size_.y), back_color);
    const std::size_t most = *std::ranges::max_element(h_.counts);
    for (std::size_t bin = 0; bin < h_.counts.size(); ++bin) {
      if (h_.counts[bin] == 0) continue;
      // The root lets a few bad ones be seen beside thousands; a bin with any has two pixels.
      const double share =
          std::sqrt(static_cast<double>(h_.counts[bin]) / static_cast<double>(most));
      const float height = std::max(2.0f, static_cast<float>(share) * (size_.y - 2));
      list.AddRectFilled(ImVec2(x_of(bin) + 0.5f, at_.y + size_.y - height),
                         ImVec2(x_of(bin + 1) - 0.5f, at_.y + size_.y),
                         h_.is_outside_expected(bin) ? bad_color : bar_color);
    }
  }

  void draw_expected() const {
    if (!h_.expected || !std::isfinite(h_.expected->max) || !(h_.high > h_.low)) return;
    const float from = place_of(h_.expected->min), to = place_of(h_.expected->max);
    if (from >= to) return;
    const float y = at_.y + size_.y + 2;
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(from, y), ImVec2(to, y + 3), expected_color);
  }

  void draw_value(double value) const {
    const float x = place_of(value);
    ImGui::GetWindowDrawList()->AddLine(ImVec2(x, at_.y), ImVec2(x, at_.y + size_.y), probe_color,
                                        2);
  }

  /// The bin below the mouse, in words.
  std::string words_at(float x) const {
    const auto bins = static_cast<float>(h_.counts.size());
    const auto bin =
        static_cast<std::size_t>(std::clamp((x - at_.x) / size_.x * bins, 0.0f, bins - 1));
    return rough_text(h_.edge(bin)) + " to " + rough_text(h_.edge(bin + 1)) + " " + h_.unit + ": " +
           std::to_string(h_.counts[bin]);
  }

 private:
  float x_of(std::size_t bin) const {
    return at_.x + size_.x * static_cast<float>(bin) / static_cast<float>(h_.counts.size());
  }
  /// Values beyond an end are at it.
  float place_of(double value) const {
    if (!(h_.high > h_.low)) return at_.x + 0.5f * size_.x;
    return at_.x + static_cast<float>(h_.share_of(value)) * size_.x;
  }

  const dump::Histogram& h_;
  ImVec2 at_, size_;
};

void draw_choice(ViewerState& state, const std::vector<session::FieldName>& fields) {
  ImGui::SetNextItemWidth(-FLT_MIN);
  const bool is_open = ImGui::BeginCombo("##histogram", title(state.histogram).c_str());
  note_label("field of the histogram");
  if (!is_open) return;
  for (const session::FieldName& field : fields) {
    if (ImGui::Selectable(title(field).c_str(), field == state.histogram)) state.histogram = field;
    note_label(title(field).c_str());
  }
  ImGui::EndCombo();
}

/// The probe is of the same kind, and has this value.
std::optional<double> probed_value(const session::LiveFrame& live,
                                   const session::FieldName& field) {
  if (!live.probe || live.probe->is_node != field.is_of_nodes) return std::nullopt;
  for (const session::ProbeRow& row : live.probe->rows)
    if (row.name == field.name) return row.magnitude;
  return std::nullopt;
}

void draw_bars(const session::LiveFrame& live, const session::HistogramReading& reading) {
  const dump::Histogram& h = *reading.histogram;
  if (!h.counts.empty()) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, 6 * em());
    ImGui::InvisibleButton("##bars", size);
    note_label("histogram");
    const Bars bars(h, at, size);
    bars.draw();
    bars.draw_expected();
    if (const auto value = probed_value(live, reading.field)) bars.draw_value(*value);
    if (ImGui::IsItemHovered())
      show_tip({{bars.words_at(ImGui::GetIO().MousePos.x)},
                {"heights are roots of counts; green: expected; red: outside; orange: the probe",
                 true}});
    ImGui::Dummy(ImVec2(0, 0.1f * em()));
    const std::string right = rough_text(h.high) + (h.unit.empty() ? "" : " " + h.unit);
    ImGui::TextDisabled("%s", rough_text(h.low).c_str());
    ImGui::SameLine(
        std::max(0.0f, ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(right.c_str()).x));
    ImGui::TextDisabled("%s", right.c_str());
  }
  wrapped_text(h.name + " of " + std::to_string(h.rows + h.zeros) +
               (h.is_of_nodes ? " nodes" : " particles") +
               (reading.after.empty() ? "" : ", after " + reading.after) +
               (h.is_logarithmic ? ", in bins of equal ratio: " : ": ") + dump::spread_text(h));
}

}  // namespace

void draw_histogram(ViewerState& state) {
  if (state.wants_histogram) ImGui::SetNextItemOpen(true);
  state.wants_histogram = false;
  const bool is_open = ImGui::CollapsingHeader("Histogram");
  note_label("Histogram");
  const session::FieldName before = state.histogram;
  const auto& reading = state.live->histogram;
  if (is_open) {
    draw_choice(state, reading ? reading->fields : std::vector<session::FieldName>{});
    if (!reading || reading->field != state.histogram)
      ImGui::TextDisabled("reading ...");
    else if (!reading->histogram)
      wrapped_text("There is no " + title(state.histogram) +
                   " at this moment: choose another field, or the stage that makes it.");
    else
      draw_bars(*state.live, *reading);
  }
  // The session reads the field that is looked at, and none while the list is closed.
  const bool is_asked = reading && reading->field == state.histogram && before == state.histogram;
  if (is_open != state.is_histogram_open || (is_open && !is_asked)) {
    state.is_histogram_open = is_open;
    state.bench.session().set_histogram(is_open ? std::optional(state.histogram) : std::nullopt);
  }
}

}  // namespace neve::app::view::panels
