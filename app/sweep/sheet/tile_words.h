#pragma once
/// The words on a tile, which tell its run from the others.

#include <string>
#include <vector>

#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::sheet {

/// Room for words, in letters and lines.
struct WordRoom {
  std::size_t letters = 40, lines = 6;
};

/// "hardening = 5, friction = 0.4" in as many lines as it takes, or the name of the run. In a
/// screening: the parameter that changed, with its value and the one before; all of them where a
/// trajectory starts. If not all have room, the last line says how many more there are.
/// @param has_edges  leaves out the values on the sheet's edges
std::vector<std::string> tile_words(const store::Manifest& manifest, const Run& run, bool has_edges,
                                    const WordRoom& room);

/// The axis of a screening that changed since the run before; -1: a trajectory starts, or the sweep
/// is not a screening.
int changed_axis(const store::Manifest& manifest, const Run& run);

}  // namespace neve::app::sweep::sheet
