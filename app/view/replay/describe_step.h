#pragma once
/// Every key that a step of a script may have, once; see app/scene/describe.h for what a visitor
/// has. The action of a step decides which keys there are.

#include "app/scene/describe.h"
#include "app/view/replay/step_leaf.h"

namespace neve::app::view::replay {

template <class V>
void describe_held(V& visit, frontend::Modifiers& held) {
  using enum scene::Change;
  using scene::anything, scene::unit::none;
  visit("ctrl", held.ctrl, none, anything, restart, "Holds Ctrl during the step.");
  visit("shift", held.shift, none, anything, restart, "Holds Shift during the step.");
  visit("alt", held.alt, none, anything, restart, "Holds Alt during the step.");
  visit("super", held.super, none, anything, restart, "Holds Super during the step.");
}

template <class V>
void describe_mouse(V& visit, ReplayStep& s) {
  using enum scene::Change;
  using enum ReplayStep::Kind;
  using scene::anything, scene::between, scene::unit::none;
  const char* const action = name(s.kind);
  OnePlace place{s.places};
  MouseButton button{s.button};
  Notches notches{s.wheel_x, s.wheel_y};
  if (s.kind == click || s.kind == move)
    visit(action, place, none, anything, restart, "Place that the mouse moves to.");
  if (s.kind == drag)
    visit(action, s.places, none, anything, restart,
          "Places that the mouse moves through with a button down.");
  if (s.kind == wheel) {
    visit(action, notches, none, between(-100, 100), restart, "Notches up, or right and up.");
    visit("at", place, none, anything, restart, "Place that the mouse moves to first.");
  }
  if (s.kind == click || s.kind == drag)
    visit("button", button, none, anything, restart, "The button that is pressed.");
  if (s.kind == click)
    visit("times", s.times, none, between(1, 9), restart, "Clicks one after the other.");
  if (s.kind == drag)
    visit("steps", s.steps, none, between(1, 10'000), restart, "Frames from place to place.");
  if (s.kind != move) describe_held(visit, s.held);
}

template <class V>
void describe_others(V& visit, ReplayStep& s) {
  using enum scene::Change;
  using enum ReplayStep::Kind;
  using scene::anything, scene::between, scene::unit::none, scene::unit::second;
  const char* const action = name(s.kind);
  KeyCode code{s.key};
  SomeText words{s.text};
  WaitGoal goal{s.text};
  PictureFile picture{s.text};
  Crop crop{s.crop_label, s.crop};
  Resolution size{s.size};
  MustBeTrue must{};
  if (s.kind == key) {
    visit(action, code, none, anything, restart, "The key that is pressed.");
    visit("hold", s.frames, none, between(1, 100'000), restart,
          "Frames until the key is released.");
    describe_held(visit, s.held);
  }
  if (s.kind == type || s.kind == paste || s.kind == drop)
    visit(action, words, none, anything, restart, "The text, or the file that is dropped.");
  if (s.kind == wait)
    visit(action, s.frames, none, between(1, 1'000'000), restart, "Frames that pass.");
  if (s.kind == wait_for) {
    visit(action, goal, none, anything, restart, "The event that the script waits for.");
    visit("within", s.seconds, second, between(0.001, 86'400), restart,
          "Real time until waiting is given up.");
  }
  if (s.kind == screenshot) {
    visit(action, picture, none, anything, restart, "The file, within the folder of --out.");
    visit("crop", crop, none, anything, restart, "The part that is kept.");
  }
  if (s.kind == resize)
    visit(action, size, none, anything, restart, "Size and scale of the screen.");
  if (s.kind == quit) visit(action, must, none, anything, restart, "Ends the program.");
}

template <class V>
void describe(V& visit, ReplayStep& s) {
  describe_mouse(visit, s);
  describe_others(visit, s);
  visit("at_frame", s.at_frame, scene::unit::none, scene::between(0, 10'000'000),
        scene::Change::restart, "Frame of the panels before which the step does not start.");
}

}  // namespace neve::app::view::replay
