#pragma once
/// What to draw: plain arrays, filled by the application. Metres, y up, right-handed; colours are
/// linear light unless said otherwise. Knows no snow.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/base/vec.h"

namespace neve::render {

struct Camera {
  Vec3f eye{2, 1, 2}, target{0, 0, 0}, up{0, 1, 0};
  float fov = 30;  ///< vertical, degrees
};

enum class ColorMap { viridis, magma, turbo, coolwarm };

/// Spheres. `value` is empty for snow shade, otherwise one number per point, coloured by the map.
struct Points {
  std::vector<Vec3f> position;
  std::vector<std::uint32_t> id;  ///< breaks ties and seeds the small variation of shade
  std::vector<float> value;
  float radius = 0.005f;  ///< m, as drawn
  float spacing = 0.01f;  ///< m, mean distance of packed points: scale of the light volume
  ColorMap colormap = ColorMap::viridis;
  float range_min = 0, range_max = 1;
};

/// A solid triangle mesh, flat or smooth by its normals.
struct TriangleMesh {
  std::vector<Vec3f> position, normal;
  std::vector<std::uint32_t> index;
  Vec3f color{0.35f, 0.35f, 0.36f};
};

/// An infinite plane with grid lines that fades into the background.
struct GroundPlane {
  Vec3f point{0, 0, 0}, normal{0, 1, 0};
  float line_spacing = 0.125f;  ///< m
  Vec3f color{0.20f, 0.215f, 0.24f};
};

struct Light {
  Vec3f direction{-0.62f, 0.62f, 0.42f};  ///< towards the light
  float intensity = 1;
  float ambient = 1;
};

/// A colour bar: title with unit, range and ticks.
struct Legend {
  std::string title;  ///< "speed"
  std::string unit;   ///< "m/s", may be empty
  ColorMap colormap = ColorMap::viridis;
  float min = 0, max = 1;
};

struct Frame {
  int width = 1280, height = 720;  ///< pixels of the finished picture
  int supersampling = 1;           ///< 1 or 2: samples per pixel and axis
  Camera camera;
  Light light;
  Points points;
  std::vector<TriangleMesh> meshes;
  std::vector<GroundPlane> grounds;
  std::vector<Legend> legends;
  std::vector<std::string> caption;  ///< lines, UTF-8; the first one is the title
  std::vector<Vec3f> marks;          ///< centres of rings that point out particles, for incidents
};

}  // namespace neve::render
