#include "app/view/replay/json_places.h"

#include <algorithm>

namespace neve::app::view::replay {

namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// Walks over valid JSON once.
class Walker {
 public:
  explicit Walker(std::string_view text) : text_(text) {}

  std::vector<JsonObjectPlaces> walk() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        start_element();
        take_string();
        continue;
      }
      if (c == ':' && depth_ == 2) note_key();
      if (c == '}' || c == ']') --depth_;
      if (c == ',' && depth_ == 1) is_inside_element_ = false;
      if (!is_space(c) && c != ',' && c != '}' && c != ']') start_element();
      if (c == '{' || c == '[') ++depth_;
      step();
    }
    return std::move(found_);
  }

 private:
  void step() {
    if (text_[at_] == '\n') {
      here_ = {here_.line + 1, 1};
    } else if ((static_cast<unsigned char>(text_[at_]) & 0xc0) != 0x80) {
      ++here_.column;
    }
    ++at_;
  }

  void start_element() {
    if (depth_ != 1 || is_inside_element_) return;
    is_inside_element_ = true;
    found_.push_back({here_, {}, {}});
  }

  void take_string() {
    string_place_ = here_;
    const std::size_t start = at_ + 1;
    step();
    while (at_ < text_.size() && text_[at_] != '"') {
      if (text_[at_] == '\\') step();
      if (at_ < text_.size()) step();
    }
    string_ = text_.substr(start, at_ - start);
    if (at_ < text_.size()) step();
  }

  void note_key() {
    if (found_.empty()) return;
    if (!found_.back().keys.emplace(string_, string_place_).second)
      found_.back().repeated_key = string_;
  }

  std::string_view text_, string_;
  std::size_t at_ = 0;
  TextPlace here_, string_place_;
  int depth_ = 0;
  bool is_inside_element_ = false;
  std::vector<JsonObjectPlaces> found_;
};

}  // namespace

TextPlace place_of(std::string_view text, std::size_t byte) {
  TextPlace place;
  for (std::size_t k = 0; k < std::min(byte, text.size()); ++k) {
    if (text[k] == '\n') {
      place = {place.line + 1, 1};
    } else if ((static_cast<unsigned char>(text[k]) & 0xc0) != 0x80) {
      ++place.column;
    }
  }
  return place;
}

std::vector<JsonObjectPlaces> places_in_list(std::string_view text) {
  return Walker(text).walk();
}

}  // namespace neve::app::view::replay
