#include "app/view/panels/words.h"

#include <algorithm>

namespace neve::app::view::panels {

namespace {

/// One paragraph, without line feeds.
std::string paragraph_in_lines(const std::string& text, float width) {
  std::string all, line;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, end - from);
    const std::string longer = from == 0 ? word : line + " " + word;
    if (from == 0 || ImGui::CalcTextSize(longer.c_str()).x <= width) {
      line = longer;
    } else {
      all += line + "\n";
      line = word;
    }
    from = end + 1;
  }
  return all + line;
}

}  // namespace

std::string in_lines(const std::string& text, float width) {
  std::string all;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    all += (from == 0 ? "" : "\n") + paragraph_in_lines(text.substr(from, end - from), width);
    from = end + 1;
  }
  return all;
}

void wrapped_text(const std::string& text) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(in_lines(text, ImGui::GetContentRegionAvail().x).c_str());
  ImGui::PopTextWrapPos();
}

void wrapped_text(const std::string& text, const ImVec4& color) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  wrapped_text(text);
  ImGui::PopStyleColor();
}

void dim_text(const std::string& text) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", text.c_str());
  ImGui::PopTextWrapPos();
}

}  // namespace neve::app::view::panels
