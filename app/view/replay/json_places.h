#pragma once
/// Positions of the objects of a JSON list and their keys in the text, which the JSON library does
/// not give.

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace neve::app::view::replay {

struct TextPlace {
  int line = 1, column = 1;  ///< from 1; the column counts code points
};

struct JsonObjectPlaces {
  TextPlace start;
  std::map<std::string, TextPlace> keys;  ///< as written, escapes included
  std::string repeated_key;               ///< one that is there twice, or empty
};

/// Line and column of a byte.
TextPlace place_of(std::string_view text, std::size_t byte);

/// @param text valid JSON, a list
/// @return one for each of its elements; without keys where it is no object
std::vector<JsonObjectPlaces> places_in_list(std::string_view text);

}  // namespace neve::app::view::replay
