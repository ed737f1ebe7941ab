#pragma once
/// A scene as the user wrote it, defaults filled in. Data only; see describe.h for every parameter.

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
enum class Layer { ground, colliders, particles, legend, caption };

/// Absent range: "auto". Resolving a scene fills it in.
struct Range {
  double min = 0, max = 1;
};

struct ParticleStyle {
  ColorBy color_by = ColorBy::snow;
  render::ColorMap colormap = render::ColorMap::viridis;
  std::optional<Range> range;
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
  std::optional<CameraSettings> camera;  ///< the scene's when absent
  std::optional<PictureSize> size;       ///< the output's when absent
};

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
