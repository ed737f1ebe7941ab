/// Particles to nodes on a copy, with whatever quantity in the place of the velocity: the transfer
/// is the one of the steps.

#include <stdexcept>

#include "sim/engine/engine.h"
#include "sim/engine/engine_records.h"

namespace neve::sim::engine {

namespace {

struct MassAndMean {
  std::vector<double> mass;
  std::vector<Vec3d> mean;
};

/// Mass and momentum of all nodes of some blocks; momentum over mass is the mean.
template <class Real>
MassAndMean read(const std::vector<kernels::StagedNodes<Real>>& staged) {
  MassAndMean out;
  out.mass.resize(kernels::block_nodes * staged.size());
  out.mean.resize(out.mass.size(), Vec3d::Zero());
  for (std::size_t b = 0; b < staged.size(); ++b)
    for (int n = 0; n < kernels::block_nodes; ++n) {
      const Quad<Real> q = staged[b].momentum[n];
      const double m = static_cast<double>(q[3]);
      if (!(m > 0)) continue;
      const std::size_t at = kernels::block_nodes * b + static_cast<std::size_t>(n);
      out.mass[at] = m;
      out.mean[at] =
          Vec3d(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2])) /
          m;
    }
  return out;
}

}  // namespace

template <class Real>
RasterizedNodes Engine<Real>::rasterize(const std::vector<std::vector<double>>& values) const {
  for (const std::vector<double>& list : values)
    if (list.size() != particles_.size())
      throw std::invalid_argument("rasterize: a list has " + std::to_string(list.size()) +
                                  " values for " + std::to_string(particles_.size()) +
                                  " particles");
  RasterizedNodes out;
  out.spacing = settings_.cell_size;
  out.mean.resize(values.size());
  if (particles_.empty()) return out;

  Engine copy(*this);
  copy.partition();
  const kernels::SweepArgs<Real> with_places = copy.args(0, kernels::all_channels);
  std::vector<kernels::StagedNodes<Real>> staged(copy.partition_.node_blocks().size());
  const auto sweep = [&] {
    kernels::SweepArgs<Real> a = with_places;
    a.staged = staged.data();
    copy.over_particle_blocks(sweeps_->rasterize, a);
    copy.over_node_blocks(sweeps_->collect_momentum, a);
    return read(staged);
  };
  MassAndMean nodes = sweep();
  out.mass = std::move(nodes.mass);
  out.velocity = std::move(nodes.mean);
  const Ranks rank = ranks();
  // Three lists at a time, where velocity was. An affine part would belong to the velocity.
  for (kernels::Particle<Real>& p : copy.particles_)
    std::fill(std::begin(p.C), std::end(p.C), Real(0));
  for (std::size_t first = 0; first < values.size(); first += 3) {
    const std::size_t lists = std::min<std::size_t>(3, values.size() - first);
    for (kernels::Particle<Real>& p : copy.particles_)
      for (std::size_t k = 0; k < lists; ++k)
        p.v[k] = static_cast<Real>(values[first + k][rank[p]]);
    const MassAndMean means = sweep();
    for (std::size_t k = 0; k < lists; ++k) {
      std::vector<double>& list = out.mean[first + k];
      list.reserve(means.mean.size());
      for (const Vec3d& mean : means.mean) list.push_back(mean[static_cast<Eigen::Index>(k)]);
    }
  }
  for (const kernels::NodeBlock& block : copy.partition_.node_blocks()) {
    Vec3i at;
    for (int axis = 0; axis < 3; ++axis)
      at[axis] = kernels::block_coordinate(block.key, axis) - lattice_origin_[axis];
    out.block.push_back(at);
  }
  return out;
}

template RasterizedNodes Engine<float>::rasterize(const std::vector<std::vector<double>>&) const;
template RasterizedNodes Engine<double>::rasterize(const std::vector<std::vector<double>>&) const;

}  // namespace neve::sim::engine
