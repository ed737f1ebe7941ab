#pragma once
/// Advice on formats that neve does not write: those that the program behind them reads.

#include <string>
#include <string_view>

namespace neve::app::scene {

/// "Blender reads ply and usda, and vdb for volumes" of "blend"; "" where the word is not known.
std::string export_format_advice(std::string_view word);

}  // namespace neve::app::scene
