#pragma once
/// A scene as the user wrote it, defaults filled in. Data only; see describe.h for every parameter.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/frame.h"
#include "sim/collider.h"
#include "sim/material.h"
#include "sim/seeding.h"
#include "sim/settings.h"

namespace neve::app {

enum class ColorBy { snow, speed, density, J_E, J_P, pressure, von_mises, id };
/// Fields on the nodes of the grid. All but mass and speed are means of the particles around.
enum class ScalarField { mass, speed, density, J_E, J_P, pressure, von_mises };
/// The names of design and paper: velocity is what is rasterised (v_old).
enum class VectorField { velocity, momentum, force, v_free, v_star, v_new };
enum class Layer {
  ground,
  colliders,
  particles,
  arrows,
  heatmap,
  smoke,
  blocks,
  bounds,
  legend,
  caption
};

/// Absent range: "auto". Resolving a scene fills it in.
struct Range {
  double min = 0, max = 1;
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

/// A plane through the grid: arrows of a vector field and a heat map of a scalar field on it.
struct SliceStyle {
  VectorField field = VectorField::velocity;  ///< of the arrows
  ScalarField scalar = ScalarField::speed;    ///< of the heat map
  sim::Vec3d normal{0, 0, 1};
  std::optional<sim::Vec3d> point;  ///< m; automatic when absent; from the followed body if any
  std::string follow;               ///< body whose centre of mass the plane moves with
  sim::Vec3d motion{0, 0, 0};       ///< m/s, of the plane
  int every = 0;                    ///< nodes from arrow to arrow; 0: automatic
  double arrow_scale = 1;           ///< factor of all lengths
  int isolines = 0;                 ///< steps of the heat map's range with lines between them
  render::ColorMap colormap = render::ColorMap::magma;           ///< of the arrows
  std::optional<Range> range;                                    ///< of their magnitude
  render::ColorMap scalar_colormap = render::ColorMap::viridis;  ///< of the heat map
  std::optional<Range> scalar_range;
};

struct CameraSettings {
  std::optional<sim::Vec3d> eye, target;  ///< both or neither; automatic when absent
  sim::Vec3d up{0, 1, 0};
  double fov = 30;  ///< vertical, degrees
};

struct LightSettings {
  sim::Vec3d direction{-0.62, 0.62, 0.42};  ///< towards the light
  double intensity = 1;
  double ambient = 1;
};

struct PictureSize {
  int width = 1280, height = 720;
};

struct View {
  std::string name = "particles";
  std::vector<Layer> layers{Layer::ground, Layer::colliders, Layer::particles, Layer::legend,
                            Layer::caption};
  ParticleStyle particles;
  SmokeStyle smoke;
  SliceStyle slice;
  std::optional<CameraSettings> camera;  ///< the scene's when absent
  std::optional<PictureSize> size;       ///< the output's when absent
};

inline bool has_layer(const View& view, Layer layer) {
  return std::find(view.layers.begin(), view.layers.end(), layer) != view.layers.end();
}

struct Limits {
  std::uint64_t memory = 0;  ///< bytes; 0: 80 % of what is available
  std::uint64_t particles = 20'000'000;
  std::uint64_t pixels = 64'000'000;
};

struct Scene {
  std::string title;
  int frames = 48;  ///< frames 0 (initial state) to this one
  double fps = 24;
  std::uint64_t seed = 1;
  sim::SolverSettings solver;
  Limits limits;
  std::vector<sim::Material> materials;  ///< "snow" is always there
  std::vector<sim::Body> bodies;
  std::vector<sim::Collider> colliders;
  std::optional<CameraSettings> camera;  ///< automatic when absent
  LightSettings light;
  std::vector<View> views;
  PictureSize size;
};

}  // namespace neve::app
