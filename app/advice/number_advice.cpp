#include "app/advice/suggest.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

#include "app/support/text.h"

namespace neve::app::advice {

namespace {

std::string advice_on_unit(double value, std::string_view written, std::string_view unit) {
  const std::string no_unit = "numbers have no unit";
  for (const Entry& known : entries_of("unit"))
    if (known.has(written) && known.names[0] == unit)
      return no_unit + ": in " + known.names[0] + " it is " +
             rough_text(value * number_of(known.names[1]).value());
  return unit.empty() ? no_unit : no_unit + "; this one is in " + std::string(unit);
}

/// "2.5%", "2M", "1.4*10^5", "140 000", "0,04": numbers as they are written elsewhere.
/// @param written what follows the number, without blanks before it
std::string advice_on_spelling(double value, std::string_view text, std::string_view written) {
  if (written == "%") return "as a share of 1 it is " + rough_text(0.01 * value);
  if (written == "k" || written == "K") return "write it out: " + rough_text(1e3 * value);
  if (written == "M") return "write it out: " + rough_text(1e6 * value);
  if (written.starts_with('/'))
    if (const auto divisor = number_of(written.substr(1)); divisor && *divisor != 0)
      return "nothing is computed in a value: write " + rough_text(value / *divisor);
  std::string spelt(text);
  const std::size_t power = spelt.find("10^");
  if (power != std::string::npos && spelt.find_first_of("*x") != std::string::npos)
    spelt = spelt.substr(0, spelt.find_first_of(" *x")) + "e" + spelt.substr(power + 3);
  std::erase(spelt, ' ');
  if (const std::size_t comma = spelt.find(','); comma != std::string::npos) spelt[comma] = '.';
  if (spelt == text || !number_of(spelt)) return {};
  if (text.find(',') != std::string_view::npos) return "decimals have a point, as in " + spelt;
  return "write " + spelt;
}

}  // namespace

std::string number_advice(std::string_view text, std::string_view unit) {
  if (number_of(text)) return "numbers have no quotes";
  if (text.empty()) return "a value is missing";
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{}) return {};
  std::string_view written(rest, static_cast<std::size_t>(end - rest));
  while (written.starts_with(' ')) written.remove_prefix(1);
  if (std::string spelling = advice_on_spelling(value, text, written); !spelling.empty())
    return spelling;
  const bool is_word = written.find_first_of("0123456789.,:") != 0 && written.size() <= 8;
  return is_word && !written.empty() ? advice_on_unit(value, written, unit) : std::string();
}

std::string vector_advice(const scene::toml::Value& value, const std::string& address) {
  std::vector<double> numbers;
  if (const auto* text = std::get_if<std::string>(&value.data)) {
    std::string rest = *text;
    for (char& c : rest)
      if (c == '(' || c == ')' || c == ',' || c == ';') c = ' ';
    std::istringstream words(rest);
    for (std::string word; words >> word;)
      if (const auto number = number_of(word)) numbers.push_back(*number);
  } else if (const auto* whole = std::get_if<std::int64_t>(&value.data)) {
    numbers.push_back(static_cast<double>(*whole));
  } else if (const auto* number = std::get_if<double>(&value.data)) {
    numbers.push_back(*number);
  }
  // [0, 0,12, 0]
  const auto* items = std::get_if<scene::toml::Array>(&value.data);
  if (items && items->size() == 4 && address.ends_with("rotation"))
    return "three angles in degrees, about x, y and z: quaternions are not read";
  if (items && items->size() > 3 && items->size() <= 6)
    return "decimals have a point, as in 0.12, and commas are between the numbers";
  // One number of a gravity or a velocity is meant along y, and gravity down.
  const bool is_gravity = address == "solver.gravity";
  if (numbers.size() == 1 && (is_gravity || address.ends_with("velocity")))
    numbers = {0, is_gravity ? -std::abs(numbers[0]) : numbers[0], 0};
  if (numbers.size() == 1 && address.ends_with(".size")) numbers.resize(3, numbers[0]);
  if (numbers.size() != 3) return {};
  return "write [" + scene::toml::number_text(numbers[0]) + ", " +
         scene::toml::number_text(numbers[1]) + ", " + scene::toml::number_text(numbers[2]) + "]";
}

}  // namespace neve::app::advice
