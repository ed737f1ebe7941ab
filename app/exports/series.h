#pragma once
/// Files that put the moments of an export in a row, for programs that do not count files.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/exports/columns.h"
#include "app/exports/state.h"
#include "app/setup/framing.h"

namespace neve::app::exports {

/// A file of an export, or a frame between two files, and where the colliders were.
struct Sample {
  int number = 0;   ///< of the file, or of the frame
  double time = 0;  ///< s
  std::vector<PlacedShape> colliders;

  /// Null where there was no such collider.
  const PlacedShape* find(const std::string& collider) const;
  /// Null also where it had another shape.
  const PlacedShape* find(const std::string& collider, std::size_t shape) const;
  bool is_elsewhere = false;  ///< the scene alone does not say where colliders are
  std::map<std::string, sim::Vec3d> followed{};  ///< m, what cameras follow has moved by, by name
  std::optional<setup::Box> snow{};              ///< m, around the snow; of files of a stage
  std::uint64_t hash = 0;                        ///< of the state; of files
};

/// A time in frames, with the numbers that files have. The end of a frame is a whole number: of a
/// stage whose clip begins a rounding error later, USD shows the clip before.
double time_in_frames(const scene::Scene& scene, double time);

/// "0024.ply"
std::string file_name(const scene::Export& spec, int number);

/// "vtp.pvd" or "usda.usda", beside the folder; "" for formats without.
std::string series_name(const scene::Export& spec);

/// A ParaView collection: every file with its time.
std::string encode_pvd(const scene::Export& spec, const std::vector<Sample>& samples);

/// A camera of a stage, and the pixels whose shape its film has.
struct StageCamera {
  std::string name;  ///< of its prim
  scene::CameraSettings settings;
  scene::PictureSize size;
};

/// "camera" is that of the scene, or of its first view where only views have cameras. The others
/// that the scene gives to views have the names of these. Cameras without a place are left out.
std::vector<StageCamera> stage_cameras(const scene::Scene& scene);

/// A USD stage: the particles, or their surface, as value clips of the layers, colliders as meshes
/// that move or deform, the cameras of the scene and its views, and its light. Source: OpenUSD,
/// UsdClipsAPI.
/// Places of colliders and cameras are those of every frame from the first file to the last one.
/// @param between  frames without a file, where the scene alone does not say where things are
/// @param colliders  that there were at any sample; one that came or went is seen while it existed.
/// One that has changed its shape is there once for each, in the order of PlacedShape::shape
std::string encode_stage(const scene::Scene& scene, const std::vector<scene::Collider>& colliders,
                         const scene::Export& spec, const Table& columns,
                         const std::vector<Sample>& files, const std::vector<Sample>& between);

/// The layer that tells the stage the names and types of the properties in the clips.
std::string encode_manifest(const scene::Scene& scene, const scene::Export& spec,
                            const Table& columns);

}  // namespace neve::app::exports
