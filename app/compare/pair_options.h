#pragma once
/// Pictures of two runs against each other: what `neve compare A B --out` takes.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/output/movie_format.h"
#include "app/scene/names.h"
#include "app/setup/caps.h"
#include "app/setup/plan.h"
#include "app/support/progress.h"

namespace neve::app::compare {

enum class Mode {
  beside,        ///< both pictures, left and right
  wipe,          ///< one picture, left of a line from A and right of it from B
  displacement,  ///< particles coloured by their distance to the same particle of the other run
  mass,          ///< snow that only one run has, as red and blue smoke
  metrics        ///< curves over time
};
/// Names of the modes, in the order in which they are listed everywhere.
constexpr auto names(Mode) {
  using enum Mode;
  return std::array{scene::Name{beside, "beside"}, scene::Name{wipe, "wipe"},
                    scene::Name{displacement, "displacement"}, scene::Name{mass, "mass"},
                    scene::Name{metrics, "metrics"}};
}
using scene::name;

struct PairOptions {
  std::string a, b;         ///< folders of runs, or pictures
  std::string out;          ///< a folder, a picture, a movie or a table .csv; empty: none
  std::vector<Mode> modes;  ///< empty: beside for a file, all for a folder
  std::optional<setup::FrameRange> frames;
  std::string view;                        ///< of A; empty: its first
  std::optional<scene::PictureSize> size;  ///< of the picture of one run
  double wipe = 0.5;                       ///< share of the width that is from A
  output::MovieStyle movie;
  std::optional<double> range;  ///< m, displacement that has the last colour
  int threads = 0;              ///< 0: one per core
  setup::CapTexts caps;
  bool replaces = false;   ///< what an earlier comparison left in the folder
  bool is_agreed = false;  ///< to the cost of pictures that came alone
  std::string backend = "auto";
  Verbosity verbosity = Verbosity::normal;
  ProgressOptions progress{};
};

}  // namespace neve::app::compare
