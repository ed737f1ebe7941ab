#pragma once
/// Colours of the screen.

#include <imgui.h>

namespace neve::app::view::picker::colour {

inline constexpr ImU32 ground = IM_COL32(22, 24, 31, 255);
inline constexpr ImU32 text = IM_COL32(232, 234, 240, 255);
inline constexpr ImU32 dim = IM_COL32(150, 156, 168, 255);
inline constexpr ImU32 veil = IM_COL32(12, 14, 18, 170);    ///< over a picture of before
inline constexpr ImU32 shadow = IM_COL32(12, 14, 18, 205);  ///< behind words on a picture
inline constexpr ImU32 accent = IM_COL32(110, 175, 255, 255);
inline constexpr ImU32 liked = IM_COL32(250, 214, 120, 255);
inline constexpr ImU32 wrong = IM_COL32(255, 130, 104, 255);
inline constexpr ImU32 line = IM_COL32(62, 68, 82, 255);

}  // namespace neve::app::view::picker::colour
