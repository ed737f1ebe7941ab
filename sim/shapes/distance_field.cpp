#include "sim/shapes/distance_field.h"

#include <algorithm>

#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

/// Samples around the mesh, so that the lattice ends where all is outside.
constexpr double samples_around = 2;

/// Limit for a lattice finer than half a cell: 8 MiB, a second.
constexpr double max_refined = 128.0 * 128.0 * 128.0;

/// Faces that are looked at for all points of a lattice, some ten seconds, where many are looked at
/// for each. Faces of things are small or along an axis, or few; those of thousands of slabs askew
/// are in each other's boxes.
constexpr double max_looks = 5e7, max_overlap = 100;

}  // namespace

Eigen::Array3d sample_counts(const Bounds& bounds, double spacing) {
  return ((bounds.max - bounds.min).array() / spacing).ceil() + (1 + 2 * samples_around);
}

FieldLattice::FieldLattice(const Bounds& bounds, double spacing) : spacing_(spacing) {
  const Eigen::Array3d count = sample_counts(bounds, spacing);
  size_ = count.cast<int>();
  const Vec3d lattice = spacing * (count - 1).matrix();
  first_ = 0.5 * (bounds.min + bounds.max - lattice);
}

Vec3d FieldLattice::place(std::size_t row, std::size_t k) const {
  const auto ny = static_cast<std::size_t>(size_[1]);
  return first_ + spacing_ * Vec3d(static_cast<double>(row / ny), static_cast<double>(row % ny),
                                   static_cast<double>(k));
}

DistanceSamples FieldLattice::samples(const float* distance) const {
  DistanceSamples out;
  out.distance = distance;
  out.spacing = spacing_;
  for (int a = 0; a < 3; ++a) {
    out.size[a] = size_[a];
    out.first[a] = first_[a];
  }
  return out;
}

double field_spacing(const MeshSurface& surface, double cell_size) {
  const Bounds& bounds = surface.bounds();
  const Vec3d extent = bounds.max - bounds.min;
  const double coarse = 0.5 * cell_size;
  // A row of so many samples is too many by itself: no need to begin below, where a flat mesh
  // would.
  const double least = extent.maxCoeff() / max_refined;
  double fine = std::max(std::min({coarse, extent.minCoeff() / 8, extent.maxCoeff() / 64}), least);
  while (fine < coarse && sample_counts(bounds, fine).prod() > max_refined) fine *= 1.1;
  return std::min(fine, coarse);
}

DistanceField::DistanceField(const MeshSurface& surface, const std::string& name, double spacing,
                             ThreadPool& pool) {
  const Bounds& bounds = surface.bounds();
  const Eigen::Array3d count = sample_counts(bounds, spacing);
  if (!(count.prod() <= max_samples))
    throw ShapeError(name + ": the mesh is " + number_text((bounds.max - bounds.min).maxCoeff()) +
                     " m across (in centimetres, give scale = 0.01), and its distance field has a "
                     "point every " +
                     number_text(spacing) + " m (half a cell), in total " + number_text(count[0]) +
                     " x " + number_text(count[1]) + " x " + number_text(count[2]) +
                     " points; at most 256^3 are allowed. Make it smaller, split " +
                     "it into several colliders, or make solver.cell_size larger");
  if (surface.overlap() > max_overlap && count.prod() * surface.overlap() > max_looks)
    throw ShapeError(name +
                     ": large faces of the mesh lie so close to each other that each of the " +
                     number_text(count.prod(), 2) + " points of its distance field would look at " +
                     number_text(surface.overlap(), 2) +
                     " of them. Turn the mesh so that they lie along its axes, split it into "
                     "several colliders, or make solver.cell_size larger");
  lattice_ = FieldLattice(bounds, spacing);
  values_.resize(lattice_.count());
  visit_samples(surface, lattice_, pool,
                [&](std::size_t index, double distance, const MeshSurface::Place&) {
                  values_[index] = static_cast<float>(distance);
                });
  if (std::none_of(values_.begin(), values_.end(), [](float d) { return d < 0; }))
    throw ShapeError(name + ": the mesh is thinner than the " + number_text(spacing) +
                     " m between the points of its distance field, and snow would pass through. "
                     "Make it thicker, or smaller as a whole, or use a box");
}

DistanceSamples DistanceField::samples() const {
  return lattice_.samples(values_.data());
}

std::shared_ptr<const DistanceField> distance_field(const Mesh& mesh, double cell_size,
                                                    ThreadPool& pool) {
  static Recent<DistanceField> recent;
  const std::shared_ptr<const MeshSurface> surface = mesh_surface(mesh);
  const double spacing = field_spacing(*surface, cell_size);
  return recent.get(reading_key(mesh) + "|" + number_text(spacing, 17), [&] {
    return std::make_shared<const DistanceField>(*surface, mesh.file, spacing, pool);
  });
}

}  // namespace neve::sim::shapes
