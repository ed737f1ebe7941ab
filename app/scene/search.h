#pragma once
/// Search for parameters by parts of their address, words of their sentence, and everyday names.

#include <string>
#include <string_view>
#include <vector>

namespace neve::app::scene {

/// Lower-case words of a text: "Longest time_step." has longest, time and step.
std::vector<std::string> words_in(std::string_view text);

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

/// The attribute of a name that other programs use: v for velocity; "" where there is none.
std::string our_attribute(const std::string& name, const std::vector<std::string>& known);

/// Advice on the name of an attribute that other programs use otherwise, or that is misspelt:
/// "did you mean v? expected ...".
std::string attribute_advice(const std::string& name, const std::vector<std::string>& known);

/// True if both mean the same parameter: NAME stands for any name, [N] for any number.
bool same_parameter(std::string_view pattern, std::string_view address);

}  // namespace neve::app::scene
