#include "sim/rigid/rigid_shape.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <LinearMath/btConvexHullComputer.h>

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <type_traits>

#include "sim/rigid/triangles.h"
#include "sim/shapes/height_field.h"
#include "sim/shapes/mesh_surface.h"

namespace neve::sim::rigid {

namespace {

/// Bullet rounds the edges of convex shapes by this share of their smallest half width.
constexpr double rounding = 0.04;
/// Faces of a body with hollows are plates, at most so thick, as a share of its least extent.
constexpr double thickest_plate = 0.1;
constexpr int doublings = 7;
constexpr std::size_t max_plates = 10'000;
/// Bullet adds to a convex hull this share of the least extent of its body.
constexpr double beyond_hull = 1e-3;
/// No vertex of a convex mesh is further beyond a face than this share of its largest extent.
constexpr double flat = 1e-4;
/// Capsules that a torus is made of.
constexpr int pieces_of_ring = 32;

/// Faces are clipped against those of other shapes and against triangles: they touch in all corners
/// of what they share. A plate that touched a mesh in one point of each triangle sank through it.
void tell_faces(btPolyhedralConvexShape& shape) {
  shape.initializePolyhedralFeatures();
}

/// A shape that has memory of its own.
template <class Shape>
class Single final : public RigidShape {
 public:
  template <class... Args>
  explicit Single(double smallest, Args&&... args) : shape_(std::forward<Args>(args)...) {
    if (smallest > 0) shape_.setMargin(rounding * smallest);
    if constexpr (std::is_same_v<Shape, btBoxShape>) tell_faces(shape_);
  }
  btCollisionShape* get() override { return &shape_; }

 private:
  Shape shape_;
};

class Compound final : public RigidShape {
 public:
  void add(std::unique_ptr<RigidShape> part, const btTransform& place) {
    shape_.addChildShape(place, part->get());
    parts_.push_back(std::move(part));
  }
  btCollisionShape* get() override { return &shape_; }

 private:
  std::vector<std::unique_ptr<RigidShape>> parts_;
  btCompoundShape shape_;
};

/// Posts of a terrain. Beyond them it continues level, as it does for snow (shapes::HeightField):
/// as if the posts of the border stood there again and again, as far as a body reaches.
class Posts final : public btHeightfieldTerrainShape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// @param heights  kept by the caller, in Bullet's unit, as `low` and `high`
  Posts(const files::HeightGrid& grid, const std::vector<double>& heights, double low, double high,
        double unit)
      : btHeightfieldTerrainShape(static_cast<int>(grid.columns), static_cast<int>(grid.rows),
                                  heights.data(), low, high, 1, false),
        spacing_(grid.spacing / unit),
        reach_(shapes::no_ground / unit),
        last_{static_cast<double>(grid.columns - 1), static_cast<double>(grid.rows - 1)} {
    setLocalScaling(btVector3(spacing_, 1, spacing_));
  }

  void getAabb(const btTransform& place, btVector3& low, btVector3& high) const override {
    btHeightfieldTerrainShape::getAabb(place, low, high);
    const btMatrix3x3 axes = place.getBasis().absolute();
    const btVector3 beyond = btVector3(reach_, 0, reach_).dot3(axes[0], axes[1], axes[2]);
    low -= beyond;
    high += beyond;
  }

  void processAllTriangles(btTriangleCallback* visit, const btVector3& low,
                           const btVector3& high) const override {
    const Cells east(low.x(), high.x(), spacing_, last_[0]),
        south(low.z(), high.z(), spacing_, last_[1]);
    if (east.are_between_posts && south.are_between_posts)
      return btHeightfieldTerrainShape::processAllTriangles(visit, low, high);
    // Cut and ordered as Bullet does it between posts.
    for (double z = south.first, to_z; z <= south.last; z = to_z) {
      to_z = south.end_of(z);
      for (double x = east.first, to_x; x <= east.last; x = to_x) {
        to_x = east.end_of(x);
        btVector3 first[] = {post(x, z), post(x, to_z), post(to_x, z)};
        visit->processTriangle(first, 0, 0);
        btVector3 second[] = {first[2], first[1], post(to_x, to_z)};
        visit->processTriangle(second, 0, 0);
      }
    }
  }

 private:
  /// Cells along one side that a box touches, counted from the first post.
  struct Cells {
    double first, last, last_post;
    bool are_between_posts;
    Cells(double low, double high, double spacing, double last_of_posts)
        : first(std::floor(low / spacing + 0.5 * last_of_posts)),
          last(std::floor(high / spacing + 0.5 * last_of_posts)),
          last_post(last_of_posts),
          are_between_posts(first >= 0 && last < last_post) {
      // Places so far away are in no cells: the run has long diverged.
      constexpr double max_cell = 1e15;
      if (!(first > -max_cell && last < max_cell)) first = 0, last = -1;
    }
    /// Returns the beginning of the next cell. Many beyond the posts, where nothing changes along
    /// this side, are one: a large body over small cells would have no end of them.
    double end_of(double cell) const {
      constexpr double max_single = 64;
      const double border = cell < 0 ? std::min(0.0, last + 1) : last + 1;
      return (cell < 0 || cell >= last_post) && border - cell > max_single ? border : cell + 1;
    }
  };

  /// Returns a place of the ground between posts or beyond them.
  btVector3 post(double x, double z) const {
    const double column = std::clamp(x, 0.0, last_[0]), row = std::clamp(z, 0.0, last_[1]);
    btVector3 at;
    getVertex(static_cast<int>(column), static_cast<int>(row), at);
    return at + btVector3(spacing_ * (x - column), 0, spacing_ * (z - row));
  }

  const double spacing_, reach_, last_[2];
};

/// Holes are so deep that nothing stands in them.
class Ground final : public RigidShape {
 public:
  Ground(const shapes::HeightField& field, double unit)
      : columns_(field.grid().columns),
        rows_(field.grid().rows),
        spacing_(field.grid().spacing / unit),
        first_{field.x_of(0) / unit, field.z_of(0) / unit} {
    const files::HeightGrid& grid = field.grid();
    const shapes::Bounds& box = field.bounds();
    const double deep = box.min.y() - (box.max - box.min).norm();
    for (std::size_t row = 0; row < grid.rows; ++row)
      for (std::size_t column = 0; column < grid.columns; ++column) {
        const double height = field.height_of(column, row);
        heights_.push_back((std::isfinite(height) ? height : deep) / unit);
      }
    const auto [low, high] = std::minmax_element(heights_.begin(), heights_.end());
    auto shape = std::make_unique<Posts>(grid, heights_, *low, *high, unit);
    // Bullet has the middle of its box at the origin.
    const auto middle = [](double first, double last) { return 0.5 * (first + last); };
    const btVector3 to(middle(field.x_of(0), field.x_of(grid.columns - 1)) / unit,
                       middle(*low, *high),
                       middle(field.z_of(0), field.z_of(grid.rows - 1)) / unit);
    shape_.addChildShape(btTransform(btMatrix3x3::getIdentity(), to), shape.get());
    field_ = std::move(shape);
  }
  btCollisionShape* get() override { return &shape_; }

  std::vector<Face> faces_at([[maybe_unused]] int triangle, const Vec3d& place,
                             [[maybe_unused]] double reach) const override {
    constexpr double beside = 1e-3;  // of a cell
    const double x = (place.x() - first_[0]) / spacing_, z = (place.z() - first_[1]) / spacing_;
    return {face_at(x, z), face_at(x - beside, z), face_at(x + beside, z), face_at(x, z - beside),
            face_at(x, z + beside)};
  }

 private:
  /// @param x, z  in cells from the first post
  Face face_at(double x, double z) const {
    const double column = std::floor(x), row = std::floor(z);
    const auto post = [&](double i, double j) {
      const auto at = [](double k, std::size_t count) {
        return static_cast<std::size_t>(std::clamp(k, 0.0, static_cast<double>(count - 1)));
      };
      return Vec3d(first_[0] + spacing_ * i, heights_[at(j, rows_) * columns_ + at(i, columns_)],
                   first_[1] + spacing_ * j);
    };
    const Vec3d a = post(column + 1, row), b = post(column, row + 1);
    const bool is_first = x - column + z - row < 1;
    const Vec3d c = is_first ? post(column, row) : post(column + 1, row + 1);
    const Vec3d normal = is_first ? (b - c).cross(a - c) : (a - c).cross(b - c);
    return {normal.normalized(), (a + b + c) / 3};
  }

  std::size_t columns_, rows_;
  double spacing_, first_[2];
  std::vector<double> heights_;
  std::unique_ptr<Posts> field_;
  btCompoundShape shape_;
};

/// Bullet adds the margin of a cone to it, that of other forms it keeps inside of them. Here it is
/// added to a cone that lies so far inside.
class InnerCone final : public btConeShape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  InnerCone(double radius, double height, double margin)
      : InnerCone(radius, height, margin, margin * std::hypot(radius, height) / radius) {}

  btVector3 localGetSupportingVertex(const btVector3& along) const override {
    return btConeShape::localGetSupportingVertex(along) + middle_;
  }
  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& along) const override {
    return btConeShape::localGetSupportingVertexWithoutMargin(along) + middle_;
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* along, btVector3* found,
                                                         int count) const override {
    for (int k = 0; k < count; ++k) found[k] = localGetSupportingVertexWithoutMargin(along[k]);
  }

 private:
  /// @param from_apex  from the apex to that of the inner cone
  InnerCone(double radius, double height, double margin, double from_apex)
      : btConeShape(radius * (1 - (margin + from_apex) / height), height - margin - from_apex),
        middle_(0, 0.5 * (margin - from_apex), 0) {}

  const btVector3 middle_;
};

template <class Shape, class... Args>
std::unique_ptr<RigidShape> single(double smallest, Args&&... args) {
  return std::make_unique<Single<Shape>>(smallest, std::forward<Args>(args)...);
}

/// Looks for a place that is further than a distance beyond a plane.
struct BeyondPlane {
  Vec3d point, normal;
  double distance;
  bool is_found = false;
  bool intersectVolume(const Eigen::AlignedBox3d& box) const {
    return normal.dot(box.center() - point) + normal.cwiseAbs().dot(box.sizes()) / 2 > distance;
  }
  bool intersectObject(const Vec3d& x) {
    return is_found = normal.dot(x - point) > distance;  // the search ends with it
  }
};

bool is_convex_surface(const shapes::MeshSurface& surface) {
  const std::vector<Vec3d>& vertices = surface.mesh().vertices;
  std::vector<Eigen::AlignedBox3d> boxes(vertices.begin(), vertices.end());
  // Each face asks for all vertices; of those on its own side of it a tree knows at once.
  Eigen::KdBVH<double, 3, Vec3d> tree;
  tree.init(vertices.begin(), vertices.end(), boxes.begin(), boxes.end());
  const double beyond = flat * (surface.bounds().max - surface.bounds().min).maxCoeff();
  for (const auto& t : surface.mesh().triangles) {
    const Vec3d &a = vertices[t[0]], across = (vertices[t[1]] - a).cross(vertices[t[2]] - a);
    const double size = across.norm();
    if (!(size > 0)) continue;
    BeyondPlane plane{a, across / size, beyond};
    Eigen::BVIntersect(tree, plane);
    if (plane.is_found) return false;
  }
  return true;
}

/// Returns the thickness of a plate that does not come out of the other side of its wall, m:
/// doubled as long as the face is the nearest one to its back.
/// @param normal  outward
double thickness_of_plate(const shapes::MeshSurface& surface, const Vec3d& middle,
                          const Vec3d& normal, double most) {
  double thickness = std::ldexp(most, -doublings);
  for (int k = 0; k < doublings; ++k) {
    const double next = 2 * thickness;
    const Vec3d back = middle - next * normal;
    if (surface.nearest_place(back, 1.01 * next).distance < 0.7 * next) break;
    thickness = next;
  }
  return thickness;
}

/// A body with hollows: its faces, as plates that reach into it. Bullet's own shape for such bodies
/// (GImpact, its faces alone) rattles where it lies: a ring on a peg moves at 0.1 to 0.2 m/s for
/// ever.
std::unique_ptr<RigidShape> plates(const shapes::MeshSurface& surface, double unit) {
  auto out = std::make_unique<Compound>();
  const std::vector<Vec3d>& vertices = surface.mesh().vertices;
  const double least = (surface.bounds().max - surface.bounds().min).minCoeff();
  for (const auto& t : surface.mesh().triangles) {
    const Vec3d &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
    const Vec3d across = (b - a).cross(c - a);
    const double size = across.norm();
    if (!(size > 0)) continue;
    const Vec3d normal = across / size;
    const Vec3d inward =
        -thickness_of_plate(surface, (a + b + c) / 3, normal, thickest_plate * least) * normal;
    auto plate = std::make_unique<Single<btConvexHullShape>>(0.0);
    auto* shape = static_cast<btConvexHullShape*>(plate->get());
    for (const std::uint32_t v : t) {
      shape->addPoint(to_bullet(Vec3d(vertices[v] / unit)), false);
      shape->addPoint(to_bullet(Vec3d((vertices[v] + inward) / unit)), false);
    }
    shape->recalcLocalAabb();
    shape->setMargin(beyond_hull * least / unit);
    tell_faces(*shape);
    out->add(std::move(plate), btTransform::getIdentity());
  }
  return out;
}

/// Capsules from point to point of the ring.
std::unique_ptr<RigidShape> ring(double major_radius, double minor_radius) {
  auto out = std::make_unique<Compound>();
  const double turn = 2 * std::numbers::pi / pieces_of_ring;
  // Capsules are as far inside of the ring in their middles as outside of it at their ends.
  const double middle = major_radius * 0.5 * (1 + std::cos(0.5 * turn));
  const double length = 2 * major_radius * std::sin(0.5 * turn);
  for (int k = 0; k < pieces_of_ring; ++k) {
    const double angle = turn * k;
    const btVector3 outward(std::cos(angle), 0, std::sin(angle)), up(0, 1, 0);
    const btVector3 along = outward.cross(up);
    // Capsules lie along y.
    const btMatrix3x3 axes(outward.x(), along.x(), up.x(), outward.y(), along.y(), up.y(),
                           outward.z(), along.z(), up.z());
    out->add(single<btCapsuleShape>(0, minor_radius, length), btTransform(axes, middle * outward));
  }
  return out;
}

/// Forms that are the same whether they stand or move.
struct MakeForm {
  double unit;  ///< m, Bullet's unit of length

  std::unique_ptr<RigidShape> operator()(const shapes::Sphere& s) const {
    return single<btSphereShape>(0, s.radius / unit);
  }
  std::unique_ptr<RigidShape> operator()(const shapes::Box& s) const {
    return single<btBoxShape>(0.5 * s.size.minCoeff() / unit,
                              to_bullet(Vec3d(0.5 * s.size / unit)));
  }
  std::unique_ptr<RigidShape> operator()(const shapes::Capsule& s) const {
    return single<btCapsuleShape>(0, s.radius / unit, (s.b - s.a).norm() / unit);
  }
  std::unique_ptr<RigidShape> operator()(const shapes::Cylinder& s) const {
    const double radius = s.radius / unit, half = 0.5 * s.height / unit;
    return single<btCylinderShape>(std::min(radius, half), btVector3(radius, half, radius));
  }
  std::unique_ptr<RigidShape> operator()(const shapes::Cone& s) const {
    const double radius = s.radius / unit, height = s.height / unit;
    const double smallest = std::min(radius, 0.5 * height);
    return single<InnerCone>(smallest, radius, height, rounding * smallest);
  }
  std::unique_ptr<RigidShape> operator()(const shapes::Torus& s) const {
    return ring(s.major_radius / unit, s.minor_radius / unit);
  }
  template <class Form>
  std::unique_ptr<RigidShape> operator()(const Form&) const {
    throw std::invalid_argument("bodies that move cannot meet this kind of shape");
  }
};

struct MakeFixed : MakeForm {
  using MakeForm::operator();
  std::unique_ptr<RigidShape> operator()(const shapes::Plane& s) const {
    return single<btStaticPlaneShape>(0, to_bullet(Vec3d(s.normal.normalized())), 0.0);
  }
  std::unique_ptr<RigidShape> operator()(const shapes::Mesh& s) const {
    const auto surface = shapes::mesh_surface(s);
    return std::make_unique<Triangles>(surface->mesh(), surface->bounds(), unit);
  }
  std::unique_ptr<RigidShape> operator()(const shapes::Terrain& s) const {
    return std::make_unique<Ground>(*shapes::height_field(s), unit);
  }
};

struct MakeBody : MakeForm {
  bool is_convex;

  using MakeForm::operator();
  std::unique_ptr<RigidShape> operator()(const shapes::Mesh& s) const {
    const std::shared_ptr<const shapes::MeshSurface> surface = shapes::mesh_surface(s);
    if (!is_convex) return plates(*surface, unit);
    const std::vector<Vec3d>& vertices = surface->mesh().vertices;
    std::vector<double> numbers;
    for (const Vec3d& x : vertices)
      numbers.insert(numbers.end(), {x[0] / unit, x[1] / unit, x[2] / unit});
    btConvexHullComputer hull;
    hull.compute(numbers.data(), 3 * sizeof(double), static_cast<int>(vertices.size()), 0, 0);
    auto out = std::make_unique<Single<btConvexHullShape>>(0.0);
    auto* shape = static_cast<btConvexHullShape*>(out->get());
    for (int k = 0; k < hull.vertices.size(); ++k) shape->addPoint(hull.vertices[k], false);
    shape->recalcLocalAabb();
    btVector3 low, high;
    shape->getAabb(btTransform::getIdentity(), low, high);
    // The margin lies beyond the hull.
    shape->setMargin(beyond_hull * (high - low)[(high - low).minAxis()]);
    tell_faces(*shape);
    return out;
  }
};

}  // namespace

std::unique_ptr<RigidShape> fixed_shape(const shapes::Shape& shape, double unit) {
  return std::visit(MakeFixed{{unit}}, shape.form);
}

bool is_convex(const shapes::Shape& shape) {
  const auto* mesh = std::get_if<shapes::Mesh>(&shape.form);
  if (!mesh) return true;
  const std::shared_ptr<const shapes::MeshSurface> surface = shapes::mesh_surface(*mesh);
  if (is_convex_surface(*surface)) return true;
  const std::size_t faces = surface->mesh().triangles.size();
  if (faces > max_plates)
    throw ShapeError(mesh->file + ": has hollows and " + std::to_string(faces) +
                     " faces, and a body that moves by itself can have " +
                     std::to_string(max_plates) + "; simplify the mesh, or take its convex hull");
  return false;
}

std::unique_ptr<RigidShape> body_shape(const shapes::Shape& shape, const MassProperties& mass,
                                       const Mat3d& principal, bool is_convex, double unit) {
  std::unique_ptr<RigidShape> form = std::visit(MakeBody{{unit}, is_convex}, shape.form);
  if (principal.isIdentity(0) && mass.centre.isZero(0)) return form;
  auto out = std::make_unique<Compound>();
  const Mat3d axes = principal.transpose();
  out->add(std::move(form),
           btTransform(to_bullet(axes), to_bullet(Vec3d(-axes * mass.centre / unit))));
  return out;
}

btVector3 to_bullet(const Vec3d& v) {
  return {v[0], v[1], v[2]};
}

btMatrix3x3 to_bullet(const Mat3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

Vec3d from_bullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

Mat3d from_bullet(const btMatrix3x3& m) {
  Mat3d out;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) out(a, b) = m[a][b];
  return out;
}

}  // namespace neve::sim::rigid
