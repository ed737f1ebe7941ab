#pragma once
/// Experiments on a material for its card, and their results.

#include <optional>
#include <string>
#include <vector>

#include "app/picture/snapshot.h"
#include "app/scene/scene.h"
#include "app/setup/seed_scene.h"

namespace neve::app::card {

/// The experiments, in the order in which they are shown.
enum class Kind { press, tear, shear, drop, tilt, column };
inline constexpr Kind kinds[] = {Kind::press, Kind::tear, Kind::shear,
                                 Kind::drop,  Kind::tilt, Kind::column};

struct KindInfo {
  const char *name, *title;      ///< in JSON, on the picture
  const char* setting;           ///< a sentence about what is done
  const char *x_name, *y_name;   ///< of the curve, in JSON, in SI units
  const char *x_title, *x_unit;  ///< of the plot
  double x_scale;                ///< of its x, per SI unit
  const char *y_title, *y_unit;  ///< Pa may become kPa or MPa
  double y_scale;
};
const KindInfo& info_of(Kind kind);

/// A number that an experiment ends with.
struct Measure {
  const char* name;  ///< in JSON; SI units
  double value = 0;
  std::optional<double> formula = {};  ///< what the law says of it, where that is a closed formula
};

/// A material, and the method that moves it.
struct Subject {
  std::string title;  ///< "wet", or the name of its scene
  sim::Material material;
  sim::SolverSettings solver;  ///< of its scene; experiments choose their own cells and gravity
  std::uint64_t seed = 1;
};

struct Experiment {
  Kind kind = Kind::press;
  std::vector<double> x, y;  ///< the curve, SI units
  std::vector<Measure> measures;
  std::vector<std::string> words;  ///< what it found, for the picture: a line or two
  std::string failure;             ///< why it ended early, a sentence; empty: it did not
  /// The scene of the picture, which has only what is seen, and the state that is shown.
  scene::Scene stage;
  setup::SeededScene seeded;
  picture::Snapshot shown;

  /// Returns the value of a measure; nothing where no measure has this name.
  std::optional<double> value(const std::string& name) const;
};

/// 21500 Pa as "21.5 kPa".
std::string pressure_text(double pressure);

}  // namespace neve::app::card
