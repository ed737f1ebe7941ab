#pragma once
/// Values that only scripts have, read into the members of a step.

#include "app/scene/leaf.h"
#include "app/view/replay/replay_script.h"

namespace neve::app::view::replay {

// Each refers to the members of a step that it fills in.
struct OnePlace {
  std::vector<ReplayPlace>& places;
};
struct MouseButton {
  int& index;  ///< of button_names
};
struct Notches {
  float &right, &up;
};
struct KeyCode {
  int& code;
};
struct SomeText {
  std::string& text;
};
struct WaitGoal {
  std::string& text;
};
struct PictureFile {
  std::string& name;
};
struct Crop {
  std::string& label;
  std::optional<std::array<int, 4>>& box;
};
struct Resolution {
  frontend::ScreenSize& size;
};
struct MustBeTrue {};

void read_leaf(const scene::Leaf& leaf, OnePlace& member);
void read_leaf(const scene::Leaf& leaf, std::vector<ReplayPlace>& member);
void read_leaf(const scene::Leaf& leaf, MouseButton& member);
void read_leaf(const scene::Leaf& leaf, Notches& member);
void read_leaf(const scene::Leaf& leaf, KeyCode& member);
void read_leaf(const scene::Leaf& leaf, SomeText& member);
void read_leaf(const scene::Leaf& leaf, WaitGoal& member);
void read_leaf(const scene::Leaf& leaf, PictureFile& member);
void read_leaf(const scene::Leaf& leaf, Crop& member);
void read_leaf(const scene::Leaf& leaf, Resolution& member);
void read_leaf(const scene::Leaf& leaf, MustBeTrue& member);

}  // namespace neve::app::view::replay
