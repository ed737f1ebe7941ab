/// The list of written files, from which a page downloads.

#include <imgui.h>

#include "app/support/text.h"
#include "app/view/panels/beside.h"
#include "app/view/panels/labels.h"
#include "app/view/panels/viewer_state.h"
#include "app/view/panels/words.h"

namespace neve::app::view::panels {

void open_file_list(ViewerState& state) {
  state.files = session::written_files(state.bench.folder());
  state.is_file_list_open = true;
}

void draw_files(ViewerState& state) {
  if (!state.is_file_list_open) return;
  const PanelPlace place = column_beside(state);
  ImGui::SetNextWindowPos(place.at);
  ImGui::SetNextWindowSize(place.size);
  if (ImGui::Begin("Files", &state.is_file_list_open,
                   ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    dim_text(state.files.empty() ? "Nothing has been written yet: save a picture or the scene."
                                 : "Click a file to download it.");
    ImGui::BeginChild("list of files");
    for (const session::WrittenFile& file : state.files) {
      if (ImGui::Selectable((file.name + "  (" + bytes_text(file.bytes) + ")").c_str()))
        state.download(file.path);
      note_label(("download " + file.name).c_str());
    }
    ImGui::EndChild();
  }
  ImGui::End();
}

}  // namespace neve::app::view::panels
