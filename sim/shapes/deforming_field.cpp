#include "sim/shapes/deforming_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/types/number_text.h"

namespace neve::sim::shapes {
namespace {

/// Limit for a lattice finer than half a cell: each of its fields takes some hundredths of a
/// second.
constexpr double max_fine_samples = 64.0 * 64.0 * 64.0;

/// Distance and velocity of a part's two ends and of now.
constexpr std::size_t bytes_per_sample = 3 * 4 * sizeof(float);

/// Counts the samples of the largest lattice.
double max_samples_of(const DeformingMesh& mesh, double spacing) {
  double most = 0;
  for (std::size_t k = 0; k < mesh.intervals(); ++k)
    most = std::max(most, sample_counts(mesh.bounds(k), spacing).prod());
  return most;
}

}  // namespace

double field_spacing(const DeformingMesh& mesh, double cell_size) {
  const double coarse = 0.5 * cell_size;
  double fine = std::min(coarse, mesh.thickness() / 3);
  while (fine < coarse && max_samples_of(mesh, fine) > max_fine_samples) fine *= 1.1;
  return std::min(fine, coarse);
}

double memory_of(const DeformingMesh& mesh, double cell_size) {
  const double samples = max_samples_of(mesh, field_spacing(mesh, cell_size));
  return static_cast<double>(mesh.bytes()) + static_cast<double>(bytes_per_sample) * samples;
}

DeformingField::DeformingField(std::shared_ptr<const DeformingMesh> mesh, const std::string& name,
                               double cell_size)
    : mesh_(std::move(mesh)), spacing_(field_spacing(*mesh_, cell_size)) {
  const double samples = max_samples_of(*mesh_, spacing_);
  if (!(samples <= max_samples))
    throw ShapeError(name + ": the distance field of this collider has a point every " +
                     number_text(spacing_) + " m (half a cell), in total up to " +
                     number_text(samples) +
                     " points between two files; at most 128^3 are allowed. Make it smaller, "
                     "split it into several colliders, export more files per second, or make "
                     "solver.cell_size larger");
  if (mesh_->thickness() < spacing_)
    throw ShapeError(mesh_->thinnest_file() + ": the mesh is about " +
                     number_text(mesh_->thickness()) + " m thick, thinner than the " +
                     number_text(spacing_) +
                     " m between the points of its distance field, and snow would pass through. "
                     "Make it thicker, or solver.cell_size smaller");
}

FieldLattice DeformingField::lattice(std::size_t interval) const {
  return FieldLattice(mesh_->bounds(interval), spacing_);
}

int DeformingField::parts(std::size_t interval) const {
  constexpr double most = 1e6;
  const double parts = std::ceil(mesh_->longest_way(interval) / (0.5 * spacing_));
  return static_cast<int>(std::clamp(parts, 1.0, most));
}

void DeformingField::move_to(double time, ThreadPool& pool) {
  const DeformingMesh::Moment at = mesh_->moment(time);
  const int count = parts(at.interval);
  const int first = std::min(static_cast<int>(at.part * count), count - 1);
  const auto part = static_cast<float>(at.part * count - first);
  const Cut before{at.interval, first}, after{at.interval, first + 1};
  lattice_ = lattice(at.interval);
  moves_ = at.moves;
  if (after_ && after_->cut == before) std::swap(before_, after_);
  require(before, pool, before_);
  require(after, pool, after_);
  blend(part, pool);
}

void DeformingField::require(const Cut& cut, ThreadPool& pool,
                             std::shared_ptr<const Values>& values) const {
  if (values && values->cut == cut) return;
  const double part = static_cast<double>(cut.number) / parts(cut.interval);
  const MeshSurface surface(mesh_->mesh(cut.interval, part));
  auto made = std::make_shared<Values>();
  made->cut = cut;
  made->distance.resize(lattice_.count());
  made->velocity.resize(3 * lattice_.count());
  visit_samples(surface, lattice_, pool,
                [&](std::size_t index, double distance, const MeshSurface::Place& nearest) {
                  const Vec3d velocity = mesh_->velocity(cut.interval, surface.mesh(),
                                                         nearest.triangle, nearest.point);
                  made->distance[index] = static_cast<float>(distance);
                  for (std::size_t a = 0; a < 3; ++a)
                    made->velocity[3 * index + a] =
                        static_cast<float>(velocity[static_cast<Eigen::Index>(a)]);
                });
  values = std::move(made);
}

void DeformingField::blend(float part, ThreadPool& pool) {
  // Poses of a copy may still read them.
  if (!now_ || now_.use_count() > 1) now_ = std::make_shared<Values>();
  const auto between = [&](std::vector<float> Values::*list) {
    const std::vector<float>&a = (*before_).*list, &b = (*after_).*list;
    std::vector<float>& out = (*now_).*list;
    out.resize(a.size());
    pool.ranges(a.size(), pool.thread_count(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) out[k] = a[k] + part * (b[k] - a[k]);
    });
  };
  between(&Values::distance);
  if (moves_) between(&Values::velocity);
}

DistanceSamples DeformingField::samples() const {
  DistanceSamples out = lattice_.samples(now_->distance.data());
  out.velocity = moves_ ? now_->velocity.data() : nullptr;
  return out;
}

std::size_t DeformingField::bytes() const {
  std::size_t floats = 0;
  for (const Values* values : {before_.get(), after_.get(), static_cast<const Values*>(now_.get())})
    if (values) floats += values->distance.capacity() + values->velocity.capacity();
  return floats * sizeof(float) + mesh_->bytes();
}

}  // namespace neve::sim::shapes
