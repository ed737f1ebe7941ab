#pragma once
/// Contents of a picture: plain arrays, filled by the application. Metres, y up, right-handed;
/// colours are linear light unless said otherwise. Knows no snow.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/frame/ticks.h"
#include "render/frame/turn.h"
#include "render/frame/values.h"
#include "sim/base/vec.h"

namespace neve::render {

struct Camera {
  Vec3f eye{2, 1, 2}, target{0, 0, 0}, up{0, 1, 0};
  float fov = 30;  ///< vertical, degrees
};

enum class ColorMap { viridis, magma, turbo, coolwarm };

/// Points beyond a plane that cuts snow open. They are not drawn, but the surface of the snow
/// continues to the plane as if they were drawn, and ends in it.
struct CutAway {
  Vec3f point, normal;       ///< of the plane, unit and towards what is cut away
  Values<Vec3f> position;    ///< those within a few spacings of the plane
  Values<std::uint32_t> id;  ///< these as of Points
  Values<float> value, volume;
  Values<PackedTurn> turn;
  Values<Vec3f> to_solid;
  Values<float> blur{};
  bool operator==(const CutAway&) const = default;
};

/// Spacings of snow from what it rests on, up to which the snow surface needs its mirror image:
/// beyond, its kernel has no weight to speak of.
inline constexpr float mirror_reach = 2.2f;

/// Spheres. `value` is empty for snow shade, otherwise one number per point, coloured by the map.
struct Points {
  Values<Vec3f> position;
  Values<std::uint32_t> id;  ///< breaks ties and seeds the small variation of shade
  Values<float> value;
  Values<float> volume;     ///< m3 as deformed, for the snow surface; empty: that of packed points
  Values<float> blur;       ///< m across the picture while the shutter is open; empty: none moves
  Values<PackedTurn> turn;  ///< turns the grain of the snow surface; empty: none has turned
  Values<Vec3f> to_solid;  ///< m, to a mesh that it rests on, which the snow surface meets; 0: none
                           ///< is near; empty: nowhere. Grounds need none
  float radius = 0.005f;   ///< m, as drawn
  float spacing = 0.01f;   ///< m, mean distance of packed points: scale of the light volume
  ColorMap colormap = ColorMap::viridis;
  float range_min = 0, range_max = 1;
  std::optional<CutAway> cut;  ///< for the snow surface
  bool operator==(const Points&) const = default;
};

/// A cubic lattice of nodes, of which only some blocks of 4x4x4 exist. Node (i, j, k) of block b
/// lies at origin + spacing (4 block[b] + (i, j, k)); its values are at index 64 b + 16 i + 4 j + k
/// of whatever belongs to the lattice.
struct NodeLattice {
  Vec3f origin;              ///< m, where node (0, 0, 0) of block (0, 0, 0) lies
  float spacing = 1;         ///< m
  std::vector<Vec3i> block;  ///< sorted by x, then y, then z; each once
};

/// A field on nodes as light that is scattered and swallowed on its way to the eye. It shows
/// the mass density, or with `value` the density coloured by another field.
struct Smoke {
  std::shared_ptr<const NodeLattice> nodes;  ///< null: no smoke
  Values<float> density;                     ///< kg/m3, 0 and more
  Values<float> value;                       ///< empty: white
  float full_density = 400;                  ///< kg/m3, density of packed snow
  float density_scale = 1;                   ///< opacity, as a factor of that of packed snow
  int samples_per_ray = 0;  ///< 1 to 4, along each axis: 1 is exact, 4 is quick; 0: at least 2, as
                            ///< many as still give every node several rays
  ColorMap colormap = ColorMap::viridis;
  float range_min = 0, range_max = 1;
  bool operator==(const Smoke&) const = default;
};

/// Arrows that start at `position`, or have it in their middle. Their length is that of `vector`
/// times `length_per_value`.
struct Arrows {
  Values<Vec3f> position;
  Values<Vec3f> vector;  ///< in the unit of the field
  bool is_centred = false;
  float length_per_value = 1;  ///< m per unit of the field
  float max_length = 1;        ///< m, longer ones are cut to it
  ColorMap colormap = ColorMap::viridis;
  float range_min = 0, range_max = 1;  ///< of the magnitude
  bool is_white = false;               ///< instead, over points that already have these colours
  bool operator==(const Arrows&) const = default;
};

/// Values on a rectangle in space, sampled row by row; not-a-number where there is nothing to show.
struct HeatMap {
  Vec3f corner, across, up;  ///< m: the first sample's corner, and the edges of the rectangle
  int columns = 0, rows = 0;
  Values<float> value;     ///< rows x columns
  Values<float> cover;     ///< 0 to 1, one per value: shown where at least a half; empty: 1
  float isoline_step = 0;  ///< in the unit of the field; 0: none
  ColorMap colormap = ColorMap::viridis;
  float range_min = 0, range_max = 1;
  bool operator==(const HeatMap&) const = default;
};

/// Straight lines of one width, hidden by objects before them.
struct Lines {
  std::vector<Vec3f> ends;          ///< two per line, m
  Vec3f color{0.75f, 0.8f, 0.85f};  ///< sRGB, of all where there are no values
  std::vector<float> value = {};    ///< empty, or one per line, coloured by the map
  ColorMap colormap = ColorMap::viridis;
  float range_min = 0, range_max = 1;
  float opacity = 1;
  float width = 1.25f;  ///< pixels of the finished picture
};

/// Words above a place in space.
struct Label {
  Vec3f position;  ///< m
  std::string text;
};

/// A solid triangle mesh, flat or smooth by its normals.
struct TriangleMesh {
  Values<Vec3f> position, normal;
  Values<std::uint32_t> index;
  Vec3f color{0.35f, 0.35f, 0.36f};
  /// Hides what is behind it, casts no shadow, and shows the background where none falls on it.
  bool is_holdout = false;
  bool operator==(const TriangleMesh&) const = default;
};

/// An infinite plane with grid lines that fades into the background. A solid one is seen from above
/// only, a ghost from both sides.
struct GroundPlane {
  Vec3f point{0, 0, 0}, normal{0, 1, 0};
  float line_spacing = 0.125f;  ///< m
  Vec3f color{0.20f, 0.215f, 0.24f};
  float fill = 0.16f;       ///< of a ghost: opacity between its lines
  bool is_holdout = false;  ///< likewise
  bool operator==(const GroundPlane&) const = default;
};

struct Light {
  Vec3f direction{-0.62f, 0.62f, 0.42f};  ///< towards the light
  float intensity = 1;
  float ambient = 1;
};

/// A colour bar: title with unit, range and ticks, and a tip at an end beyond which values lie, as
/// they have the colour of that end.
struct Legend {
  std::string title;  ///< "speed"
  std::string unit;   ///< "m/s", may be empty
  ColorMap colormap = ColorMap::viridis;
  float min = 0, max = 1;
  std::vector<std::array<std::uint8_t, 3>> colors = {};  ///< sRGB, from min to max, for the map's
  bool has_lower_values = false, has_higher_values = false;
  bool operator==(const Legend&) const = default;
};

/// One series of a plot: a curve, with `bar_width` bars that end at each x, or with `dot_radius` a
/// dot for each value.
struct PlotSeries {
  std::string name;
  std::array<std::uint8_t, 3> color{255, 255, 255};  ///< sRGB
  std::vector<float> x;                              ///< of a curve increasing
  std::vector<float> value;                          ///< one per x; not-a-number: a gap
  float bar_width = 0;
  float dot_radius = 0;                 ///< px where a line of text has 16
  bool has_rings = false;               ///< instead of filled dots
  std::vector<std::string> notes = {};  ///< empty, or one per dot, for a mouse that points at it
};

/// A panel of series over the time of the whole scene, or over another x.
struct Plot {
  std::string title;              ///< "energy"
  std::string unit;               ///< "J", may be empty
  float x_end = 1;                ///< x starts at 0
  std::optional<float> now = {};  ///< x of a line
  float min = 0, max = 1;         ///< of the values, the same in every frame
  std::vector<PlotSeries> series;
  std::string x_title = {}, x_unit = "s";
  std::vector<Tick> ticks = {}, x_ticks = {};  ///< empty: round numbers
  int cell_columns = 0;                        ///< of a ground of coloured cells; 0: there is none
  std::vector<std::array<std::uint8_t, 3>> cells = {};  ///< sRGB, rows from the top
};

/// A filled rectangle on the finished picture, below all text; pixels from the upper left corner.
struct Patch {
  float x = 0, y = 0, width = 0, height = 0;
  std::array<std::uint8_t, 4> color{8, 10, 16, 150};  ///< sRGB and opacity
  /// Text over the patch, which is no wider than the longest line and the rims beside it.
  std::vector<std::string> lines{};
  float rim = 0;  ///< px
};

/// A line of text at a place on the finished picture.
struct Note {
  enum class Anchor { left, middle, right };

  float x = 0, y = 0;  ///< px: upper edge of the text, and its left end, middle or right end
  std::string text;    ///< UTF-8
  Anchor anchor = Anchor::left;
  float room = 0;         ///< px; longer text ends in an ellipsis; 0: any length
  bool is_title = false;  ///< in the larger font
  std::array<std::uint8_t, 3> color{205, 213, 224};  ///< sRGB
};

/// A length at a place in space, drawn as a bar at the lower edge.
struct ScaleBar {
  float pixels = 0;  ///< of the finished picture
  std::string text;  ///< "20 cm"
};

struct Frame {
  int width = 1280, height = 720;  ///< pixels of the finished picture
  int supersampling = 1;           ///< 1 or 2: samples per pixel and axis
  int grain_detail = 1;  ///< grain is as fine as for so many samples in place of one, on each axis
  bool has_smooth_edges = false;  ///< with one sample for each pixel
  bool is_transparent = false;    ///< nothing behind: the picture has an alpha channel
  Camera camera;
  Light light;
  Points points;
  bool has_snow_surface =
      false;  ///< shows points as a surface with grain, and spheres only for spray
  Smoke smoke;
  std::vector<Arrows> arrows;
  std::vector<HeatMap> heat_maps;
  std::vector<Lines> lines;
  std::vector<Label> labels;
  std::vector<TriangleMesh> meshes;
  std::vector<GroundPlane> grounds;
  std::vector<TriangleMesh> ghosts;        ///< see-through, without shadow
  std::vector<GroundPlane> ghost_grounds;  ///< likewise
  std::vector<Legend> legends;
  float legend_width = 0;  ///< px, in which their titles are wrapped; 0: a third of the picture
  std::vector<Plot> plots;
  std::vector<Patch> patches;
  std::vector<Note> notes;
  std::vector<std::string> caption;   ///< lines, UTF-8; the first one is the title
  std::string footnote;               ///< at the bottom, between plots and legends
  std::optional<ScaleBar> scale_bar;  ///< above the footnote
  /// Words at the upper edge from left to right, then at the lower one; empty: none.
  std::array<std::string, 6> edge_words{};
  int caption_height = 0;          ///< px; above 0: the caption has a strip this high to itself
  bool has_caption_plate = false;  ///< dark behind its lines: whatever is near stays readable
  int font_size = 0;               ///< px; 0: in proportion to the picture
  std::vector<Vec3f> marks;        ///< centres of rings that point out particles, for incidents
};

/// Frames within the shutter, made one at a time: each has places of its own for all points.
struct Moments {
  int count = 0;
  std::function<Frame(int)> at{};  ///< from 0 on
};

}  // namespace neve::render
