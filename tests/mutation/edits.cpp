#include "tests/mutation/edits.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace neve::test {

namespace {

namespace fs = std::filesystem;

/// A text without spaces, and where each letter that is left was.
struct Squeezed {
  std::string letters;
  std::vector<std::size_t> positions;
};

Squeezed squeezed(const std::string& text) {
  Squeezed result;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == ' ' || text[k] == '\n') continue;
    result.letters += text[k];
    result.positions.push_back(k);
  }
  return result;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string line_number(const std::string& text, std::size_t position) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(position);
  return std::to_string(std::count(text.begin(), end, '\n') + 1);
}

/// File and line of the mistake: "tests/mutation/mistakes_grid.cpp:120".
std::string definition(const Mistake& mistake) {
  for (const auto& entry : fs::directory_iterator(fs::path(NEVE_SOURCE_DIR) / "tests/mutation")) {
    if (!entry.is_regular_file()) continue;
    const std::string text = text_of(entry.path());
    const std::size_t at = text.find("{\"" + mistake.name + "\"");
    if (at != std::string::npos)
      return "tests/mutation/" + entry.path().filename().string() + ":" + line_number(text, at);
  }
  return "tests/mutation/mistakes_*.cpp";
}

/// Another source of the simulation that has the text.
std::string other_file(const Edit& edit) {
  const fs::path root = NEVE_SOURCE_DIR;
  for (const auto& entry : fs::recursive_directory_iterator(root / "sim"))
    if (entry.is_regular_file() && !places_of(edit.old_text, text_of(entry.path())).empty())
      return entry.path().lexically_relative(root).generic_string();
  return {};
}

/// The longest beginning of the replaced text that the file still has.
std::string nearest_place(const Edit& edit, const std::string& text) {
  const Squeezed part = squeezed(edit.old_text), whole = squeezed(text);
  std::size_t most = 0, at = 0;
  for (std::size_t k = 0; k < whole.letters.size(); ++k) {
    std::size_t same = 0;
    while (same < part.letters.size() && k + same < whole.letters.size() &&
           part.letters[same] == whole.letters[k + same])
      ++same;
    if (same > most) most = same, at = k;
  }
  if (most < 8) return "Nothing in the file begins like it.";
  const std::size_t end = part.positions[most - 1] + 1;
  return edit.file + ":" + line_number(text, whole.positions[at]) + " has the beginning, up to \"" +
         edit.old_text.substr(0, end) + "\"; there the next letters are other ones.";
}

}  // namespace

std::vector<Span> places_of(const std::string& part, const std::string& text) {
  const Squeezed wanted = squeezed(part), whole = squeezed(text);
  std::vector<Span> places;
  if (wanted.letters.empty()) return places;
  for (std::size_t at = whole.letters.find(wanted.letters); at != std::string::npos;
       at = whole.letters.find(wanted.letters, at + 1)) {
    const std::size_t begin = whole.positions[at];
    const std::size_t last = whole.positions[at + wanted.letters.size() - 1];
    places.push_back({begin, last + 1 - begin});
  }
  return places;
}

std::string edited(std::string text, const Edit& edit) {
  const std::vector<Span> places = places_of(edit.old_text, text);
  if (places.size() != 1)
    throw std::runtime_error(std::to_string(places.size()) + " places for the edit");
  return text.replace(places[0].begin, places[0].size, edit.new_text);
}

std::string lost_place(const Mistake& mistake, const Edit& edit) {
  const fs::path file = fs::path(NEVE_SOURCE_DIR) / edit.file;
  const std::string text = text_of(file);
  const std::size_t count = places_of(edit.old_text, text).size();
  if (count == 1) return {};
  std::string message = definition(mistake) + ": the mistake " + mistake.name + " replaces\n" +
                        edit.old_text + "\nin " + edit.file + ", where it occurs " +
                        std::to_string(count) + " times; expected once.\n";
  const std::string other = count == 0 ? other_file(edit) : "";
  if (count > 1)
    message += "Give the edit more of the text around the place.";
  else if (!other.empty())
    message += "The text is in " + other + " now: change the edit's file.";
  else
    message += (fs::exists(file) ? nearest_place(edit, text) : "The file does not exist.") +
               "\nMake the same mistake in the new code.";
  return message;
}

}  // namespace neve::test
