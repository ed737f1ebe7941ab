#pragma once
/// The classic mistakes of a snow solver, each as edits of the real sources. They are made in
/// copies: nothing in the program knows of them.

#include <string>
#include <vector>

namespace neve::test {

/// Replaces a text that must occur exactly once in a file, spaces and new lines ignored. A test
/// (Structure.MistakesHaveTheirPlacesInTheSources) says which edit a refactoring has to update.
struct Edit {
  std::string file;  ///< from the top of the source tree
  std::string old_text, new_text;
};

struct Mistake {
  std::string name;   ///< one word
  std::string title;  ///< for the table
  std::vector<Edit> edits;
  std::vector<std::string> arguments = {};  ///< of the probe
  std::string note = {};  ///< where the edit is not the mistake to the letter: what it is instead
  bool is_in_fast_run = false;  ///< the others are built by ./neve test --all only

  bool is_of_asflip() const { return arguments == std::vector<std::string>{"--asflip"}; }
};

/// All of them, in the order of the table.
std::vector<Mistake> all_mistakes();

// The parts of that list.
std::vector<Mistake> gradient_mistakes();
std::vector<Mistake> stress_mistakes();
std::vector<Mistake> volume_mistakes();
std::vector<Mistake> plasticity_mistakes();
std::vector<Mistake> law_mistakes();
std::vector<Mistake> transfer_mistakes();
std::vector<Mistake> affine_mistakes();
std::vector<Mistake> solve_mistakes();
std::vector<Mistake> contact_mistakes();
std::vector<Mistake> run_mistakes();
std::vector<Mistake> step_mistakes();

}  // namespace neve::test
