#include "app/support/out_folder.h"

namespace neve::app {

namespace {

std::string& chosen_other_place() {
  static std::string advice = usual_other_place;
  return advice;
}

}  // namespace

void set_other_place(const std::string& advice) {
  chosen_other_place() = advice;
}

std::string or_other_place(const std::string& first) {
  const std::string& place = chosen_other_place();
  return first + (first.empty() || place.empty() ? "" : ", or ") + place;
}

}  // namespace neve::app
