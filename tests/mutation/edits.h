#pragma once
/// Finds the places of mistakes in the sources, whatever clang-format made of their lines.

#include <cstddef>
#include <string>
#include <vector>

#include "tests/mutation/mistakes.h"

namespace neve::test {

struct Span {
  std::size_t begin = 0, size = 0;
};

/// Places of a text in another; spaces and new lines are ignored in both.
std::vector<Span> places_of(const std::string& part, const std::string& text);

/// Makes the edit in the text of its file. @throws std::runtime_error unless it has one place
std::string edited(std::string text, const Edit& edit);

/// Why the edit cannot be made: the mistake, the file, what changed there and which line to update;
/// "" where its old text occurs exactly once in its file.
std::string lost_place(const Mistake& mistake, const Edit& edit);

}  // namespace neve::test
