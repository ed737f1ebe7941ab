#include "app/pick/clicks.h"

#include <fmt/core.h>

#include <sstream>

#include "app/output/atomic_file.h"
#include "app/pick/search/rounds.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::pick {

std::optional<Click> click_of(const std::string& text) {
  std::istringstream words(text);
  Click click;
  bool is_none = false;
  for (std::string word; words >> word;) {
    if (word.size() != 1 || word[0] < '0' || word[0] > '0' + search::tiles_in_round)
      return std::nullopt;
    const int tile = word[0] - '1';
    if (is_none || (tile < 0 && !click.empty()) || click.size() == 2 ||
        (click.size() == 1 && click[0] == tile))
      return std::nullopt;
    is_none = tile < 0;
    if (!is_none) click.push_back(tile);
  }
  if (click.empty() && !is_none) return std::nullopt;
  return click;
}

std::string click_text(const Click& click) {
  std::string text;
  for (const int tile : click) text += (text.empty() ? "" : " ") + std::to_string(tile + 1);
  return text.empty() ? "0" : text;
}

std::string text_of_file(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = output::read_file(file);
  return {bytes.begin(), bytes.end()};
}

std::vector<Click> parse_clicks(const std::string& text, const std::string& file) {
  std::vector<Click> clicks;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const std::optional<Click> click = click_of(line);
    if (!click)
      throw UsageError(fmt::format("{}:{}", file, number),
                       "\"" + line.substr(0, 40) + "\" is not a choice",
                       "expected a tile from 1 to 9, two of them as in 2 7, or 0 for none");
    clicks.push_back(*click);
  }
  return clicks;
}

std::string clicks_text(const std::vector<Click>& clicks, const std::vector<std::string>& comment) {
  std::string text;
  for (const std::string& line : comment) text += "# " + line_text(line) + "\n";
  for (const Click& click : clicks) text += click_text(click) + "\n";
  return text;
}

}  // namespace neve::app::pick
