#pragma once
/// Words of other programs and of the paper, with the names of the scene language.

#include <string>
#include <vector>

namespace neve::app::scene {

/// The name among these that a word of other programs means; "": none. "dx" is cell_size.
std::string our_name(const std::string& word, const std::vector<std::string>& known);

/// The address among these whose last word is meant: "material.snow.theta_c", or "theta_c" alone,
/// is material.snow.critical_compression. "": none.
std::string our_address(const std::string& address, const std::vector<std::string>& known);

/// Advice for a key that is a flag of the command line: "quality"; "": it is none.
std::string flag_advice(const std::string& key);

/// Advice for a word that is no choice of a parameter, but means something here; "": none.
std::string choice_advice(const std::string& address, const std::string& word);

}  // namespace neve::app::scene
