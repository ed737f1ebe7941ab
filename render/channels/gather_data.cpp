#include <cmath>
#include <limits>

#include "render/channels/gather.h"
#include "render/light/light_fields.h"
#include "render/light/shading_constants.h"
#include "render/surface/nearby.h"

namespace neve::render::channels {
namespace {

/// The surface that a pixel shows.
struct SeenSurface {
  Vec3f position, normal, albedo;  ///< m in the world; unit; linear light
  float depth = 0;                 ///< m along the view
  float cover = 1;                 ///< share over the background
  float u = 0, v = 0;              ///< samples from the lower left corner
  std::int64_t point = -1, mesh = -1, ground = -1;
};

/// Everything that the planes are filled from, and the planes.
class Gatherer {
 public:
  Gatherer(const LitSurfaces& lit, const Request& request, const View& view,
           const cpu::SolidSamples* meshes, cpu::Splatter& points, DataPlanes& out);
  void take_tile(int tile);
  /// Gives what has no sphere the particle that is nearest to it.
  void take_bare(ThreadPool* pool);

 private:
  /// A place of the snow surface without the sphere of a particle there, and its pixel.
  struct Bare {
    SeenSurface surface;
    std::size_t pixel;
  };
  void make_planes();
  /// @param at in the tile @param x, y  sample of the picture
  SeenSurface surface(const light::GBufferTile& tile, const light::GBufferTile& points, int at,
                      int x, int y) const;
  static Vec3f albedo_of(unsigned word);
  bool is_near(std::int64_t point, Vec3f position) const;
  std::int64_t mesh_at(int x, int y, float inverse) const;
  std::int64_t ground_at(Vec3f position) const;
  void write(const SeenSurface& surface, std::size_t pixel);
  void write_motion(const SeenSurface& surface, std::size_t pixel);
  Vec3f moved(const SeenSurface& surface, bool is_after) const;
  bool has(Pass pass) const { return request_.passes.contains(pass); }

  const LitSurfaces& lit_;
  const Frame& frame_;
  const Request& request_;
  const View& view_;
  const View before_, after_;
  const cpu::SolidSamples* meshes_;
  cpu::Splatter& points_;
  DataPlanes& out_;
  /// m: the surface lies about a spacing around its particles.
  const float reach_;
  std::vector<std::vector<Bare>> bare_;  ///< of each tile
};

Gatherer::Gatherer(const LitSurfaces& lit, const Request& request, const View& view,
                   const cpu::SolidSamples* meshes, cpu::Splatter& points, DataPlanes& out)
    : lit_(lit),
      frame_(lit.frame),
      request_(request),
      view_(view),
      before_(make_view(request.before, view.width, view.height)),
      after_(make_view(request.after, view.width, view.height)),
      meshes_(meshes),
      points_(points),
      out_(out),
      reach_(1.5f * lit.frame.points.spacing),
      bare_(static_cast<std::size_t>(points.columns() * points.rows())) {
  make_planes();
}

void Gatherer::make_planes() {
  const auto pixels =
      static_cast<std::size_t>(frame_.width) * static_cast<std::size_t>(frame_.height);
  const auto make = [&](Pass pass, Plane& plane, float nothing) {
    if (has(pass)) plane.assign(pixels, nothing);
  };
  make(Pass::depth, out_.depth, nothing_depth);
  for (Plane& plane : out_.position) make(Pass::position, plane, 0);
  for (Plane& plane : out_.normal) make(Pass::normal, plane, 0);
  for (Plane& plane : out_.albedo) make(Pass::albedo, plane, 0);
  for (Plane& plane : out_.motion) make(Pass::motion, plane, 0);
  make(Pass::id, out_.id, no_number);
  make(Pass::body, out_.body, no_number);
  make(Pass::collider, out_.collider, no_number);
  for (const PointNumbers& numbers : request_.numbers)
    out_.numbers.insert(out_.numbers.end(), numbers.channels.size(), Plane(pixels, 0.0f));
}

/// The nearest sample of each pixel decides.
void Gatherer::take_tile(int tile) {
  const light::GBufferTile& drawn = lit_.surfaces.kept()[tile];
  const light::LitTile* lit = lit_.surfaces.kept_parts(tile);
  light::GBufferTile points;
  points_.draw_tile(tile, points);
  const int ss = frame_.supersampling, columns = lit_.surfaces.columns();
  const int left = tile % columns * light::tile_width, low = tile / columns * light::tile_height;
  for (int y = 0; y < light::tile_height && low + y < view_.height; y += ss)
    for (int x = 0; x < light::tile_width && left + x < view_.width; x += ss) {
      int nearest = -1;
      for (int j = 0; j < ss; ++j)
        for (int i = 0; i < ss; ++i) {
          const int at = (y + j) * light::tile_width + x + i;
          if (drawn.kind[at] == light::kind_nothing) continue;
          if (nearest < 0 || drawn.inverse[at] > drawn.inverse[nearest]) nearest = at;
        }
      if (nearest < 0 || drawn.kind[nearest] == light::kind_holdout) continue;
      const int row = frame_.height - 1 - (low + y) / ss, column = (left + x) / ss;
      SeenSurface seen = surface(drawn, points, nearest, left + nearest % light::tile_width,
                                 low + nearest / light::tile_width);
      const bool is_snow = drawn.kind[nearest] == light::kind_lit;
      if (lit && is_snow) seen.albedo = albedo_of(lit->albedo[nearest]);
      const std::size_t pixel =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(frame_.width) +
          static_cast<std::size_t>(column);
      if (is_snow && !is_near(seen.point, seen.position))
        bare_[static_cast<std::size_t>(tile)].push_back({seen, pixel});
      else
        write(seen, pixel);
    }
}

void Gatherer::take_bare(ThreadPool* pool) {
  std::vector<Bare> all;
  std::vector<Vec3f> place;
  for (const std::vector<Bare>& some : bare_) all.insert(all.end(), some.begin(), some.end());
  if (all.empty()) return;
  for (const Bare& one : all) place.push_back(one.surface.position);
  const surface::Shares near =
      surface::shares_of(place, {frame_.points.position, {}}, {}, reach_, pool);
  for (std::size_t n = 0; n < all.size(); ++n) {
    const std::uint32_t first = near.first[n];
    all[n].surface.point = first < near.first[n + 1] ? std::int64_t{near.grain[first]} : -1;
    write(all[n].surface, all[n].pixel);
  }
}

bool Gatherer::is_near(std::int64_t point, Vec3f position) const {
  if (point < 0) return false;
  return length(frame_.points.position[static_cast<std::size_t>(point)] - position) <= reach_;
}

SeenSurface Gatherer::surface(const light::GBufferTile& tile, const light::GBufferTile& points,
                              int at, int x, int y) const {
  SeenSurface s;
  s.u = static_cast<float>(x) + 0.5f;
  s.v = static_cast<float>(y) + 0.5f;
  s.depth = 1 / tile.inverse[at];
  const float per_sample = 1 / view_.pixels_per_slope;
  const Vec3f ray = view_.forward +
                    view_.right * ((s.u - 0.5f * static_cast<float>(view_.width)) * per_sample) +
                    view_.up * ((s.v - 0.5f * static_cast<float>(view_.height)) * per_sample);
  s.position = view_.eye + ray * s.depth;
  s.normal = {tile.normal_x[at], tile.normal_y[at], tile.normal_z[at]};
  s.albedo = albedo_of(tile.albedo[at]);
  s.cover = static_cast<float>(tile.albedo[at] >> 24) / 255;
  const int kind = tile.kind[at];
  if (kind == light::kind_ground)
    s.ground = ground_at(s.position);
  else if (kind == light::kind_solid)
    s.mesh = mesh_at(x, y, tile.inverse[at]);
  else if (kind != light::kind_flat && points.kind[at] != light::kind_nothing)
    s.point = points.albedo[at];
  return s;
}

Vec3f Gatherer::albedo_of(unsigned word) {
  const auto root = [&](int byte) { return static_cast<float>(word >> 8 * byte & 0xff) / 255; };
  return {root(0) * root(0), root(1) * root(1), root(2) * root(2)};
}

/// An arrow before a mesh is solid too, and nearer.
std::int64_t Gatherer::mesh_at(int x, int y, float inverse) const {
  if (!meshes_) return -1;
  const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(meshes_->width) +
                         static_cast<std::size_t>(x);
  const float there = (1 - meshes_->depth[at]) / view_.near_distance;
  if (!(std::abs(there - inverse) <= 1e-5f * inverse)) return -1;
  const std::int64_t mesh = meshes_->albedo[at] & 0xffffff;
  return mesh < static_cast<std::int64_t>(request_.meshes.size()) ? mesh : -1;
}

/// The plane that the place lies on.
std::int64_t Gatherer::ground_at(Vec3f position) const {
  std::int64_t best = -1;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t g = 0; g < frame_.grounds.size() && g < request_.grounds.size(); ++g) {
    const GroundPlane& ground = frame_.grounds[g];
    const float distance = std::abs(dot(position - ground.point, normalized(ground.normal)));
    if (distance >= least) continue;
    least = distance;
    best = static_cast<std::int64_t>(g);
  }
  return best;
}

/// The same part of the surface an interval later or earlier.
Vec3f Gatherer::moved(const SeenSurface& s, bool is_after) const {
  const auto place = [&](const Thing& thing) {
    return is_after ? thing.after(s.position) : thing.before(s.position);
  };
  if (s.mesh >= 0) return place(request_.meshes[static_cast<std::size_t>(s.mesh)]);
  if (s.ground >= 0) return place(request_.grounds[static_cast<std::size_t>(s.ground)]);
  if (s.point < 0) return s.position;
  const float seconds = is_after ? request_.interval : -request_.interval;
  return s.position + request_.velocity[static_cast<std::size_t>(s.point)] * seconds;
}

/// Pixels, right and up. Behind the camera there is no place on the picture: then none.
void Gatherer::write_motion(const SeenSurface& s, std::size_t pixel) {
  const float per_sample = 1 / static_cast<float>(frame_.supersampling);
  for (const bool is_after : {true, false}) {
    const Vec3f there = (is_after ? after_ : before_).project(moved(s, is_after));
    if (!(there.z > 0)) continue;
    out_.motion[is_after ? 0 : 2][pixel] = (there.x - s.u) * per_sample;
    out_.motion[is_after ? 1 : 3][pixel] = (there.y - s.v) * per_sample;
  }
}

void Gatherer::write(const SeenSurface& s, std::size_t pixel) {
  if (has(Pass::depth)) out_.depth[pixel] = s.depth;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    if (has(Pass::position)) out_.position[axis][pixel] = s.position[a];
    if (has(Pass::normal)) out_.normal[axis][pixel] = s.normal[a];
    if (has(Pass::albedo)) out_.albedo[axis][pixel] = s.albedo[a] * s.cover;
  }
  if (has(Pass::motion)) write_motion(s, pixel);
  if (has(Pass::collider)) {
    if (s.mesh >= 0)
      out_.collider[pixel] =
          static_cast<float>(request_.meshes[static_cast<std::size_t>(s.mesh)].collider);
    if (s.ground >= 0)
      out_.collider[pixel] =
          static_cast<float>(request_.grounds[static_cast<std::size_t>(s.ground)].collider);
  }
  if (s.point < 0) return;
  const auto point = static_cast<std::size_t>(s.point);
  if (has(Pass::id))
    out_.id[pixel] = static_cast<float>(frame_.points.id.empty() ? point : frame_.points.id[point]);
  if (has(Pass::body)) out_.body[pixel] = static_cast<float>(request_.body[point]);
  std::size_t plane = 0;
  for (const PointNumbers& numbers : request_.numbers) {
    const std::size_t count = numbers.channels.size();
    for (std::size_t c = 0; c < count; ++c)
      out_.numbers[plane++][pixel] = numbers.value[point * count + c];
  }
}

}  // namespace

DataPlanes gather_data(const LitSurfaces& lit, const Request& request, const View& view,
                       const cpu::SolidSamples* meshes, ThreadPool* pool) {
  DataPlanes out;
  cpu::Splatter points;
  points.prepare(lit.frame.points, view, pool, cpu::Paint::index);
  Gatherer gatherer(lit, request, view, meshes, points, out);
  light::for_each_task(points.columns() * points.rows(), pool,
                       [&](int tile) { gatherer.take_tile(tile); });
  gatherer.take_bare(pool);
  return out;
}

}  // namespace neve::render::channels
