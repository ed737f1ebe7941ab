#pragma once
/// Interaction with the picture, in parts.

#include <imgui.h>

#include <array>
#include <string>

#include "app/view/panels/viewer_state.h"

namespace neve::app::view::panels {

/// Pixel of a projected place; see Orbit::project.
ImVec2 on_screen(const ViewerState& state, const sim::Vec3d& projected);
/// Place of the mouse: share of the picture's height from its middle, y up.
std::array<double, 2> in_picture(const ViewerState& state, ImVec2 mouse);

/// s, that a hint stays.
inline constexpr double hint_seconds = 1.5;

/// Words in a dark box, which stays inside of the picture.
/// @param at, px: its left end in the middle of its height
void draw_note(const ViewerState& state, ImVec2 at, const std::string& text, ImU32 color);

/// The words beside the probed place: "|v| = 2 m/s", and ", cut away" where a plane removes it.
/// @param quantity that is plotted, or "" for the speed
std::string probe_text(const session::ProbeReading& probe, const std::string& quantity,
                       bool is_cut);

/// The probed place with its quantity, hints, and why there is nothing to see.
void draw_marks(ViewerState& state);

/// Tells why a slice with arrows shows none, or "".
std::string reason_for_no_arrows(const scene::View& view, const picture::FieldSamples& fields);

/// Throws a ball to what is below the mouse, or along the ray where nothing is.
void throw_ball(ViewerState& state, ImVec2 mouse);

/// Arrows at the middle of the selected object. @return whether the mouse is busy with them
bool use_handles(ViewerState& state, bool is_over_picture);

}  // namespace neve::app::view::panels
