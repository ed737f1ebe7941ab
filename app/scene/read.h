#pragma once
/// Scene files in, with every complaint located; resolved scenes out.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/override.h"
#include "app/scene/scene.h"
#include "app/scene/toml/error.h"

namespace neve::app::scene {

/// @throws SceneError for the file, UsageError for an override
Scene read_scene_file(const std::string& file, const std::vector<Override>& overrides = {});

/// Finds the common offset of files with coordinates = "world", where a scene has not got it yet.
/// Reads these files. @param name  of the scene in messages @throws SceneError
void place_in_world(Scene& scene, const std::string& name);
/// That offset: the scene's origin in the world of the files, m, in the axes of the scene.
std::optional<sim::Vec3d> world_offset(const Scene& scene);

/// @param name      the file in messages
/// @param base_dir  folder of relative paths of meshes; "" for the current directory
Scene read_scene_text(std::string_view text, const std::string& name,
                      const std::string& base_dir = {},
                      const std::vector<Override>& overrides = {});

/// A scene with overrides, as if its file were read with them.
/// @param name      of the scene in messages
/// @param base_dir  folder of relative paths in the overrides; "" for the current directory
/// @throws UsageError for an override, SceneError for a scene that it spoils
Scene apply(const Scene& scene, const std::vector<Override>& overrides,
            const std::string& name = "the scene", const std::string& base_dir = {});

/// The scene as TOML with every parameter written out; reading it gives the same scene, bit for
/// bit. Mesh files are written as absolute paths, so it reads the same from anywhere.
std::string write_scene(const Scene& scene);

/// The views and mosaics of the scene that its run does not draw, as TOML; empty: none.
std::string write_undrawn(const Scene& scene);
/// The scene of both texts. Overrides find all of its views and mosaics.
Scene read_with_undrawn(std::string_view text, std::string_view undrawn, const std::string& name,
                        const std::vector<Override>& overrides = {});

/// The same before it is text.
toml::Table scene_table(const Scene& scene);

/// Views that every scene has: particles, smoke, slice and snow.
std::vector<View> built_in_views();

/// The one that is drawn of a scene that names no view.
inline constexpr const char* first_view = "snow";

/// The view of this name, or the built-in one.
/// @throws UsageError with the nearest name
View find_view(const Scene& scene, const std::string& name);

}  // namespace neve::app::scene
