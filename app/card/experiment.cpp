#include "app/card/experiment.h"

#include <cmath>

#include "app/support/text.h"

namespace neve::app::card {

const KindInfo& info_of(Kind kind) {
  static constexpr KindInfo infos[] = {
      {"press", "Press", "pressed between plates, sides held", "strain", "stress", "shorter by",
       "%", 100, "stress", "Pa", 1},
      {"tear", "Tear", "pulled apart by plates that hold it", "strain", "stress", "longer by", "%",
       100, "stress", "Pa", 1},
      {"shear", "Shear", "plates moved sideways, 500 Pa at most", "strain", "stress",
       "sideways over height", "%", 100, "shear stress", "Pa", 1},
      {"drop", "Drop", "a ball of 30 cm hits the floor at 4 m/s", "time", "spread", "time", "s", 1,
       "radius around 90 %", "cm", 100},
      {"tilt", "Tilt", "an endless layer of 50 cm on a slope", "angle", "moved", "slope", "\u00b0",
       1, "moved by", "cm", 100},
      {"column", "Column", "80 cm high and wide, let go", "time", "radius", "time", "s", 1,
       "radius around 98 %", "cm", 100}};
  return infos[static_cast<int>(kind)];
}

std::optional<double> Experiment::value(const std::string& name) const {
  for (const Measure& measure : measures)
    if (measure.name == name) return measure.value;
  return std::nullopt;
}

std::string pressure_text(double pressure) {
  const double size = std::abs(pressure);
  if (size >= 1e6) return rough_text(pressure / 1e6) + " MPa";
  if (size >= 1e3) return rough_text(pressure / 1e3) + " kPa";
  return rough_text(pressure) + " Pa";
}

}  // namespace neve::app::card
