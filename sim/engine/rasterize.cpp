#include "sim/engine/rasterize.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/engine/state_reader.h"

namespace neve::sim::engine {

namespace {

struct MassAndMean {
  std::vector<double> mass;
  std::vector<Vec3d> mean;
};

/// Mass and momentum of all nodes of some blocks; momentum over mass is the mean.
template <class Real>
MassAndMean mass_and_mean(const std::vector<kernels::StagedNodes<Real>>& staged) {
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
RasterizedNodes rasterize(State<Real> copy, const std::vector<std::vector<double>>& values) {
  std::vector<kernels::Particle<Real>>& records = copy.particles.records;
  for (const std::vector<double>& list : values)
    if (list.size() != records.size())
      throw std::invalid_argument("rasterize: a list has " + std::to_string(list.size()) +
                                  " values for " + std::to_string(records.size()) + " particles");
  RasterizedNodes out;
  out.spacing = copy.method.settings.cell_size;
  out.mean.resize(values.size());
  if (records.empty()) return out;

  copy.partition();
  kernels::SweepArgs<Real> a = copy.sweep_args(0, kernels::all_channels);
  std::vector<kernels::StagedNodes<Real>> staged(copy.particles.partition.node_blocks().size());
  a.staged = staged.data();
  const auto sweep = [&] {
    copy.over_particle_blocks(copy.method.sweeps->rasterize, a);
    copy.over_node_blocks(copy.method.sweeps->collect_momentum, a);
    return mass_and_mean(staged);
  };
  MassAndMean nodes = sweep();
  out.mass = std::move(nodes.mass);
  out.velocity = std::move(nodes.mean);
  const Ranks rank = StateReader<Real>(copy).ranks();
  // Three lists at a time, where velocity was. An affine part would belong to the velocity.
  for (kernels::Particle<Real>& p : records) std::fill(std::begin(p.C), std::end(p.C), Real(0));
  for (std::size_t first = 0; first < values.size(); first += 3) {
    const std::size_t lists = std::min<std::size_t>(3, values.size() - first);
    for (kernels::Particle<Real>& p : records)
      for (std::size_t k = 0; k < lists; ++k)
        p.v[k] = static_cast<Real>(values[first + k][rank[p]]);
    const MassAndMean means = sweep();
    for (std::size_t k = 0; k < lists; ++k) {
      std::vector<double>& list = out.mean[first + k];
      list.reserve(means.mean.size());
      for (const Vec3d& mean : means.mean) list.push_back(mean[static_cast<Eigen::Index>(k)]);
    }
  }
  for (const kernels::NodeBlock& block : copy.particles.partition.node_blocks())
    out.block.push_back(copy.method.lattice.first_cell(block.key) / kernels::block_side);
  return out;
}

template <class Real>
RasterizedNodes rasterize_some(State<Real> copy, const std::vector<std::size_t>& rows) {
  std::vector<bool> is_wanted(copy.particles.size(), false);
  for (const std::size_t row : rows) is_wanted.at(row) = true;
  const Ranks rank = StateReader<Real>(copy).ranks();
  for (std::size_t q = copy.particles.size(); q-- > 0;)
    if (!is_wanted[rank[copy.particles.records[q]]]) copy.particles.remove(q);
  copy.particles.partition.invalidate();
  return rasterize(std::move(copy), {});
}

template RasterizedNodes rasterize(State<float>, const std::vector<std::vector<double>>&);
template RasterizedNodes rasterize(State<double>, const std::vector<std::vector<double>>&);
template RasterizedNodes rasterize_some(State<float>, const std::vector<std::size_t>&);
template RasterizedNodes rasterize_some(State<double>, const std::vector<std::size_t>&);

}  // namespace neve::sim::engine
