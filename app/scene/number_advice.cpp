#include "app/scene/number_advice.h"

#include <charconv>

#include "app/support/text.h"

namespace neve::app::scene {

namespace {

/// A unit that people write behind a number.
struct Unit {
  std::string_view name, base;  ///< the base is one of describe.h
  double size;                  ///< in the base
};

constexpr Unit units[] = {{"Pa", "Pa", 1},
                          {"kPa", "Pa", 1e3},
                          {"MPa", "Pa", 1e6},
                          {"GPa", "Pa", 1e9},
                          {"bar", "Pa", 1e5},
                          {"m", "m", 1},
                          {"km", "m", 1e3},
                          {"dm", "m", 0.1},
                          {"cm", "m", 0.01},
                          {"mm", "m", 1e-3},
                          {"in", "m", 0.0254},
                          {"ft", "m", 0.3048},
                          {"s", "s", 1},
                          {"ms", "s", 1e-3},
                          {"us", "s", 1e-6},
                          {"min", "s", 60},
                          {"m/s", "m/s", 1},
                          {"km/h", "m/s", 1 / 3.6},
                          {"cm/s", "m/s", 0.01},
                          {"kg/m3", "kg/m3", 1},
                          {"kg/m^3", "kg/m3", 1},
                          {"g/cm3", "kg/m3", 1e3},
                          {"g/cm^3", "kg/m3", 1e3},
                          {"kg/l", "kg/m3", 1e3},
                          {"deg", "degrees", 1},
                          {"degrees", "degrees", 1},
                          {"rad", "degrees", 57.29577951308232},
                          {"rad/s", "rad/s", 1},
                          {"deg/s", "rad/s", 0.017453292519943295},
                          {"rpm", "rad/s", 0.10471975511965977}};

std::string advice_on_unit(double value, std::string_view written, std::string_view unit) {
  const std::string no_unit = "numbers have no unit";
  for (const Unit& known : units)
    if (known.name == written && known.base == unit)
      return no_unit + ": in " + std::string(unit) + " it is " + rough_text(value * known.size);
  return unit.empty() ? no_unit : no_unit + "; " + std::string(unit) + " is meant";
}

}  // namespace

std::string number_advice(std::string_view text, std::string_view unit) {
  if (number_of(text)) return "numbers have no quotes";
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{}) return {};
  std::string_view written(rest, static_cast<std::size_t>(end - rest));
  while (written.starts_with(' ')) written.remove_prefix(1);
  const bool is_decimal = written.size() > 1 && written.front() == ',' &&
                          written.find_first_not_of("0123456789", 1) == std::string_view::npos;
  if (is_decimal) return "decimals have a point, as in 0.04";
  const bool is_word = written.find_first_of("0123456789.,:") != 0 && written.size() <= 8;
  return is_word && !written.empty() ? advice_on_unit(value, written, unit) : std::string();
}

}  // namespace neve::app::scene
