#pragma once
/// Search for parameters by parts of their address, words of their sentence, and everyday names.

#include <string>
#include <string_view>
#include <vector>

namespace neve::app::scene {

/// A text that somebody wishes for, prepared once for many parameters.
class Search {
 public:
  explicit Search(const std::string& text);

  bool is_empty() const { return words_.empty(); }
  /// True for a parameter that the text means.
  /// @param address with names or with NAME in their places
  bool finds(const std::string& address, std::string_view help) const;
  /// True if address or everyday names have it, not only a word of the sentence.
  bool names(const std::string& address) const;

 private:
  std::string text_;  ///< lower case
  std::vector<std::string> words_;
  std::vector<std::string> meant_;  ///< addresses that its everyday name means
};

/// The parameter of that address, or those of that name with the shortest addresses: output.size,
/// and no size of a box.
std::vector<std::string> parameters_named(const std::string& word);

/// True if both mean the same parameter: NAME stands for any name, [N] for any number.
bool same_parameter(std::string_view pattern, std::string_view address);

}  // namespace neve::app::scene
