#pragma once
/// These texts must be equal for two runs to be one: to resume, or to take states that were kept.

#include <filesystem>
#include <string>
#include <vector>

#include "app/run/render_job.h"
#include "app/scene/flat.h"

namespace neve::app::run {

/// The view with what it takes from its scene as its own: size, camera and background.
scene::View with_settings_of(const scene::Scene& scene, scene::View view);
scene::Mosaic with_settings_of(const scene::Scene& scene, scene::Mosaic mosaic);

/// The parts of a scene that states depend on, as text: all of it but its views, cameras, colours
/// and light, its exports, and its length.
std::string simulation_text(const scene::Scene& scene);

/// Version, sources, and the files that a scene and its changes name.
std::string surroundings_of(const scene::Scene& scene,
                            const std::vector<scene::LiveChange>& changes = {});

/// Names all that bits of states depend on. @param simd  of the simulation
std::string identity_of_states(const RenderJob& job, const std::string& simd);

/// Names all that bits of states and pictures depend on, but the machine.
std::string identity_of(record::PictureRecord picture);

/// "light.intensity was 1 and is 0.2, and 2 more differ". @param list  not empty
std::string difference_text(const std::vector<scene::Difference>& list);

/// First difference between the run of a folder and this one, with both values; values that may
/// differ where run.json cannot tell.
/// @param simd  instructions of this run, to hear only of what states depend on; "": of all
std::string difference_from_run(const std::filesystem::path& folder,
                                const record::PictureRecord& picture, const std::string& simd = {});

/// Names the quality, the speed and the format of a movie of a job.
std::string movie_style_text(const RenderJob& job, const output::MovieStyle& style);
/// True if a text names a style. Earlier versions name no format, and three digits of the rate.
bool has_movie_style(const RenderJob& job, const std::string& text,
                     const output::MovieStyle& style);
/// The style that movie_style_text names. @param movie  its file, which tells the format where the
/// text does not
output::MovieStyle movie_style_of(const RenderJob& job, const std::string& text,
                                  const std::filesystem::path& movie);

/// Bytes of a particle on disk in single precision, about.
inline constexpr double state_bytes_per_particle = 160;

}  // namespace neve::app::run
