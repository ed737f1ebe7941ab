#include "app/compare/pair_options.h"

#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::compare {

const char* name(Mode mode) {
  switch (mode) {
    case Mode::beside:
      return "beside";
    case Mode::wipe:
      return "wipe";
    case Mode::displacement:
      return "displacement";
    case Mode::mass:
      return "mass";
    case Mode::metrics:
      return "metrics";
  }
  return "";
}

const std::vector<Mode>& all_modes() {
  static const std::vector<Mode> modes{Mode::beside, Mode::wipe, Mode::displacement, Mode::mass,
                                       Mode::metrics};
  return modes;
}

Mode mode_named(const std::string& text) {
  std::vector<std::string> names;
  for (const Mode mode : all_modes()) {
    if (text == name(mode)) return mode;
    names.emplace_back(name(mode));
  }
  throw UsageError("--mode", "there is no \"" + text + "\"", names_advice(text, names));
}

}  // namespace neve::app::compare
