#pragma once
/// A scene as the user wrote it, defaults filled in. Data only; see describe.h for every parameter.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/frame/frame.h"
#include "sim/seeding/flow.h"
#include "sim/seeding/seeding.h"
#include "sim/shapes/collider.h"
#include "sim/types/material.h"
#include "sim/types/settings.h"

namespace neve::app::scene {

enum class ColorBy { snow, speed, density, J_E, J_P, pressure, von_mises, p0, yield, id };
/// Fields on the nodes of the grid. All but mass and speed are means of the particles around.
enum class ScalarField { mass, speed, density, J_E, J_P, pressure, von_mises, p0, yield };
/// The names of design and paper: velocity is what is rasterised (v_old).
enum class VectorField { velocity, momentum, force, v_free, v_star, v_new };
enum class Layer {
  ground,
  colliders,
  particles,
  snow,
  arrows,
  heatmap,
  smoke,
  blocks,
  bounds,
  legend,
  caption,
  plots,
  counter,
  slate,
  streamlines,
  scale,
  dust,
  extremes
};

/// Absent range: "auto". Resolving a scene fills it in.
struct Range {
  double min = 0, max = 1;
};

enum class Background { gradient, transparent };
enum class ColliderStyle { solid, wire, ghost, holdout };

/// Collider of the simulation, with its style of drawing.
struct Collider : sim::shapes::Collider {
  ColliderStyle style = ColliderStyle::solid;
};

struct ParticleStyle {
  ColorBy color_by = ColorBy::snow;
  render::ColorMap colormap = render::ColorMap::viridis;
  std::optional<Range> range;
};

/// The mass on the grid as smoke, white or coloured by a field.
struct SmokeStyle {
  ScalarField field = ScalarField::mass;  ///< mass: white
  double density_scale = 1;
  render::ColorMap colormap = render::ColorMap::viridis;
  std::optional<Range> range;
};

/// Ends of automatic ranges: constants of the scene, or the values of the frame that is drawn.
enum class RangeFrom { scene, frame };

/// A plane through the grid: arrows of a vector field and a heat map of a scalar field on it.
struct SliceStyle {
  VectorField field = VectorField::velocity;  ///< of the arrows
  ScalarField scalar = ScalarField::speed;    ///< of the heat map
  sim::Vec3d normal{0, 0, 1};
  std::optional<sim::Vec3d> point;  ///< m; automatic when absent; from the followed body if any
  std::string follow;               ///< body or collider whose centre of mass the plane moves with
  sim::Vec3d motion{0, 0, 0};       ///< m/s, of the plane
  int every = 0;                    ///< nodes from arrow to arrow; 0: automatic
  std::optional<sim::Vec3d> dense_near;  ///< m; nodes near it have an arrow each
  double arrow_scale = 1;                ///< factor of all lengths
  int isolines = 0;                      ///< steps of the heat map's range with lines between them
  render::ColorMap colormap = render::ColorMap::viridis;       ///< of the arrows
  std::optional<Range> range;                                  ///< of their magnitude
  render::ColorMap scalar_colormap = render::ColorMap::magma;  ///< of the heat map
  std::optional<Range> scalar_range;
  RangeFrom range_from = RangeFrom::scene;  ///< of both ranges
};

/// Absent values are inherited from the camera.
struct CameraKeyframe {
  double time = 0;  ///< s
  std::optional<sim::Vec3d> eye, target;
  std::optional<double> fov;  ///< vertical, degrees
};

/// The values of a camera that neve found: eye and target, or, for a view without its own, all.
enum class FoundCamera { nothing, place, camera };

struct CameraSettings {
  std::optional<sim::Vec3d> eye, target;  ///< both or neither; automatic when absent
  sim::Vec3d up{0, 1, 0};
  double fov = 30;                  ///< vertical, degrees
  std::optional<double> orbit;      ///< degrees over the whole scene; not with turntable
  std::optional<double> turntable;  ///< s of a full turn
  bool push_in = false;             ///< comes nearer to the settled snow; only where automatic
  std::string follow;               ///< body or collider that moves eye and target along; "": none
  std::vector<CameraKeyframe> keyframes;     ///< times increase
  FoundCamera found = FoundCamera::nothing;  ///< only in records, see setup::reopen
};

struct LightSettings {
  sim::Vec3d direction{-0.62, 0.62, 0.42};  ///< towards the light
  double intensity = 1;
  double ambient = 1;
};

/// Pixels of a picture's shorter side.
constexpr int min_side = 16;

struct PictureSize {
  int width = 1280, height = 720;
};

/// Axes of the plots; resolving a scene fills in absent ones.
struct PlotRanges {
  std::optional<Range> energy;         ///< J
  std::optional<Range> speed;          ///< m/s
  std::optional<Range> force;          ///< N
  std::optional<Range> dt;             ///< s
  std::optional<Range> body_height{};  ///< m
  std::optional<Range> body_speed{};   ///< m/s
};

/// Particles on the side that the normal points to are not drawn.
struct ClipPlane {
  sim::Vec3d normal{0, 0, 1};
  std::optional<sim::Vec3d> point;  ///< m; absent: the middle of the snow in each frame
};

struct View {
  std::string name = "particles";
  std::vector<Layer> layers{Layer::ground, Layer::colliders, Layer::particles, Layer::legend,
                            Layer::caption};
  ParticleStyle particles;
  SmokeStyle smoke;
  SliceStyle slice;
  PlotRanges plots;
  std::optional<ClipPlane> clip;
  std::optional<CameraSettings> camera;  ///< the scene's when absent
  std::optional<PictureSize> size;       ///< the output's when absent
  std::optional<Background> background;  ///< the output's when absent
};

inline bool has_layer(const View& view, Layer layer) {
  return std::find(view.layers.begin(), view.layers.end(), layer) != view.layers.end();
}

/// True if the particles are seen, as spheres or as a surface.
inline bool shows_particles(const View& view) {
  return has_layer(view, Layer::particles) || has_layer(view, Layer::snow);
}

/// True if a plane through the grid is seen.
inline bool shows_slice(const View& view) {
  return has_layer(view, Layer::arrows) || has_layer(view, Layer::heatmap) ||
         has_layer(view, Layer::streamlines);
}

/// Several views in one picture, under one caption.
struct Mosaic {
  std::string name;
  std::vector<std::string> views;  ///< names, row by row
  int columns = 0;                 ///< 0: few gaps, about the output's shape
  std::optional<int> width;        ///< px; the output's when absent
};

enum class ExportFormat { ply, vtp, vti, vdb, bgeo, usda, npz, csv, obj };
enum class ExportAttribute {
  id,
  x,
  v,
  m,
  V0,
  density,
  J_E,
  J_P,
  F_E,
  stress,
  kirchhoff,
  C,
  stiffness,
  threshold,
  material,
  body,
  radius,
  age
};
enum class UpAxis { y, z };

/// Geometry of every n-th frame in files for other programs.
struct Export {
  std::string name;
  ExportFormat format = ExportFormat::ply;
  int every = 1;  ///< frames from one file to the next
  /// x is always written.
  std::vector<ExportAttribute> attributes{
      ExportAttribute::id, ExportAttribute::x,   ExportAttribute::v,       ExportAttribute::m,
      ExportAttribute::V0, ExportAttribute::J_P, ExportAttribute::density, ExportAttribute::radius};
  std::vector<std::string> carried;  ///< columns of point files, by name
  std::vector<std::string> bodies;   ///< bodies and emitters by name; empty: all
  UpAxis up = UpAxis::y;
  double scale = 1;              ///< units of the file per metre, of lengths and velocities
  bool dust = false;             ///< the dust instead of the snow
  bool surface = false;          ///< a closed mesh around the particles instead of them
  double surface_cell = 0.5;     ///< particle spacings
  double surface_smoothing = 1;  ///< particle spacings
  int smallest_piece = 8;        ///< particles
};

/// The names of a shot in its production, for the slate and the words over its pictures.
struct Shot {
  std::string show, name, version, artist;
  bool slate = false;     ///< a picture of words before the first one
  std::string time_code;  ///< of first_frame; empty: what its number says
};

/// Words over all pictures, with values in braces, see burn_in.h.
struct BurnIn {
  std::string top_left, top, top_right, bottom_left, bottom, bottom_right;
};

struct Limits {
  std::uint64_t memory = 0;  ///< bytes; 0: 80 % of the available memory
  std::uint64_t particles = 20'000'000;
  std::uint64_t pixels = 64'000'000;
};

/// The way from one keyframe to the next: a monotone cubic that is at rest at the first and the
/// last one, a straight line, or the value of the earlier one.
enum class Interpolation { smooth, linear, step };

/// A number or a vector, as the parameter has.
struct CurveKeyframe {
  double time = 0;  ///< s
  std::optional<double> value;
  std::optional<sim::Vec3d> vector;
};

/// Keyframes of a parameter of the simulation that may change while it runs.
struct Curve {
  std::string name;
  std::string parameter;  ///< its address
  Interpolation interpolation = Interpolation::smooth;
  std::vector<CurveKeyframe> keyframes;  ///< times increase
};

struct Scene {
  std::string title;
  int frames = 48;      ///< of the shot, after its first one
  int first_frame = 0;  ///< its number in names and pictures
  int handles = 0;      ///< frames more before the first one and after the last one
  double fps = 24;
  std::uint64_t seed = 1;
  sim::SolverSettings solver;
  Limits limits;
  std::vector<sim::Material> materials;  ///< "snow" is always there
  std::vector<sim::seeding::Body> bodies;
  std::vector<sim::seeding::Emitter> emitters;
  std::vector<sim::seeding::Sink> sinks;
  std::vector<Collider> colliders;
  std::vector<Curve> curves;
  std::optional<CameraSettings> camera;  ///< automatic when absent
  LightSettings light;
  std::vector<View> views;
  std::vector<Mosaic> mosaics;
  /// Views and mosaics that a run leaves undrawn: known by name, and written by write_undrawn
  /// alone.
  std::vector<View> undrawn_views;
  std::vector<Mosaic> undrawn_mosaics;
  std::vector<Export> exports;
  PictureSize size;
  Background background = Background::gradient;
  Shot shot;
  BurnIn burn_in;
};

/// Frames are counted from 0, the initial state, to this one.
inline int last_frame(const Scene& scene) {
  return scene.frames + 2 * scene.handles;
}

/// s, from the first frame to the last.
inline double duration(const Scene& scene) {
  return last_frame(scene) / scene.fps;
}

/// The number that the names of files, records, pictures and flags give a frame.
inline int number_of(const Scene& scene, int frame) {
  return frame + scene.first_frame - scene.handles;
}
inline int frame_of(const Scene& scene, int number) {
  return number - number_of(scene, 0);
}

inline Background background_of(const Scene& scene, const View& view) {
  return view.background.value_or(scene.background);
}

/// True for an attribute of an export that dust has too.
bool is_of_dust(ExportAttribute attribute);

/// The folder of an export, in the folder of all: its name, or the format where it has none but
/// its number.
std::string folder_of(const Export& e);

/// Names of the bodies, then of the emitters.
std::vector<std::string> snow_sources(const Scene& scene);

/// The scene's colliders without their looks.
inline std::vector<sim::shapes::Collider> sim_colliders(const Scene& scene) {
  return {scene.colliders.begin(), scene.colliders.end()};
}

/// True if a collider moves by itself.
inline bool has_moving_bodies(const Scene& scene) {
  return std::any_of(scene.colliders.begin(), scene.colliders.end(),
                     [](const Collider& collider) { return collider.body.moves(); });
}

/// Returns those of a list that have other names than these.
template <class Named>
std::vector<Named> others_than(const std::vector<Named>& these, std::vector<Named> list) {
  std::erase_if(list, [&](const Named& one) {
    return std::ranges::find(these, one.name, &Named::name) != these.end();
  });
  return list;
}

/// Makes `chosen` what is drawn, and keeps the others by name.
template <class Named>
void draw_only(std::vector<Named> chosen, std::vector<Named>& drawn, std::vector<Named>& undrawn) {
  undrawn.insert(undrawn.end(), drawn.begin(), drawn.end());
  undrawn = others_than(chosen, std::move(undrawn));
  drawn = std::move(chosen);
}

}  // namespace neve::app::scene
