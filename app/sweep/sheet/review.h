#pragma once
/// A sweep for review: a timeline that editors and review servers read, and names that these group.

#include <filesystem>
#include <string>
#include <vector>

#include "app/sweep/store/manifest.h"
#include "app/sweep/store/results.h"

namespace neve::app::sweep::sheet {

/// Names of the pictures of a run in DIR/review: "run_0007." of run_0007.1001.png.
std::string review_prefix(const Run& run);

/// An OpenTimelineIO timeline: a clip per run that has pictures, one after the other, with a marker
/// per value at its start, and state, label and metrics as metadata.
/// @param has_links  clips name the pictures in DIR/review instead of those in DIR/runs
/// Source: opentimelineio 0.15, serialized schemas.
std::string otio_timeline(const store::Manifest& manifest,
                          const std::vector<store::RunResult>& results, bool has_links);

/// True if DIR/review has links of an earlier collect: later ones keep them up to date.
bool has_links(const std::filesystem::path& folder);

/// Makes DIR/review anew: links to all pictures, whose names have the number between two points.
/// @throws IoError
void link_pictures(const std::filesystem::path& folder, const store::Manifest& manifest,
                   const std::vector<store::RunResult>& results);

}  // namespace neve::app::sweep::sheet
