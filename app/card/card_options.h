#pragma once
/// Command line options of `neve card`.

#include <string>
#include <vector>

#include "app/options/option.h"
#include "app/scene/presets.h"
#include "app/support/progress.h"

namespace neve::app::card {

struct CardOptions {
  std::vector<std::string> scenes;  ///< scenes, pictures or folders of runs
  std::vector<scene::Preset> presets;
  std::vector<std::string> overrides;
  std::vector<std::string> materials;  ///< by name; empty: all that bodies and emitters have
  std::string out;                     ///< a PNG; empty: out/<title>/card.png
  bool replaces = false;               ///< an earlier card that is another one
  int threads = 0;                     ///< 0: one per core
  std::string backend = "auto";
  bool is_json = false;
  bool is_agreed = false;
  Verbosity verbosity = Verbosity::normal;
};

void describe(options::Command& visit, CardOptions& options);

/// `neve card`. @return an exit code
int run(const CardOptions& options);

}  // namespace neve::app::card
