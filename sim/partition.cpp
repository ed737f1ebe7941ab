#include "sim/partition.h"

#include <algorithm>
#include <numeric>

namespace neve::sim {

namespace {

constexpr std::uint64_t key_offset(int o) {
  return static_cast<std::uint64_t>(o >> 2) << 42 | static_cast<std::uint64_t>(o >> 1 & 1) << 21 |
         static_cast<std::uint64_t>(o & 1);
}

std::uint32_t index_of(const std::vector<std::uint64_t>& sorted, std::uint64_t key) {
  return static_cast<std::uint32_t>(std::lower_bound(sorted.begin(), sorted.end(), key) -
                                    sorted.begin());
}

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

constexpr int local_codes = model_codes * block_nodes;

}  // namespace

void Partition::build(const std::vector<std::uint64_t>& keys,
                      const std::vector<std::uint16_t>& locals, ThreadPool& pool, int threads) {
  order_.resize(keys.size());
  block_of_.resize(keys.size());
  find_blocks(keys, pool, threads);
  count_and_place(keys, pool, threads);
  sort_inside_blocks(locals, pool, threads);
  // The blocks change far less often than the particles in them.
  if (block_keys_ != previous_keys_) link_node_blocks();
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    std::copy_n(links_.begin() + static_cast<std::ptrdiff_t>(8 * b), 8, blocks_[b].node_block);
}

std::uint64_t Partition::wrapped(std::uint64_t key) const {
  int block[3];
  for (int a = 0; a < 3; ++a) {
    block[a] = block_coordinate(key, a);
    if (period_[a] > 0) block[a] = (block[a] % period_[a] + period_[a]) % period_[a];
  }
  return block_key(block[0], block[1], block[2]);
}

void Partition::wrap(std::vector<std::uint64_t>& keys, ThreadPool& pool, int threads) const {
  if (period_.isZero()) return;
  pool.ranges(keys.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) keys[q] = wrapped(keys[q]);
  });
}

void Partition::storage_was_sorted() {
  std::iota(order_.begin(), order_.end(), 0u);
}

std::size_t Partition::memory_bytes() const {
  std::size_t bytes = 4 * (order_.capacity() + block_of_.capacity() + links_.capacity()) +
                      8 * (block_keys_.capacity() + previous_keys_.capacity()) +
                      sizeof(ParticleBlock) * blocks_.capacity() +
                      sizeof(NodeBlock) * node_blocks_.capacity();
  for (const auto& found : found_) bytes += 8 * found.capacity();
  for (const auto& counts : counts_) bytes += 4 * counts.capacity();
  for (const auto& scratch : scratch_) bytes += 4 * scratch.capacity();
  return bytes;
}

std::uint32_t Partition::first_block(int thread, int threads) const {
  const std::uint64_t particle =
      order_.size() * static_cast<std::uint64_t>(thread) / static_cast<std::uint64_t>(threads);
  if (thread >= threads) return static_cast<std::uint32_t>(blocks_.size());
  const auto at =
      std::partition_point(blocks_.begin(), blocks_.end(),
                           [&](const ParticleBlock& block) { return block.begin < particle; });
  return static_cast<std::uint32_t>(at - blocks_.begin());
}

void Partition::find_blocks(const std::vector<std::uint64_t>& keys, ThreadPool& pool, int threads) {
  found_.resize(static_cast<std::size_t>(threads));
  const std::size_t count = keys.size(), parts = static_cast<std::size_t>(threads);
  pool.run(threads, [&](int t) {
    std::vector<std::uint64_t>& found = found_[static_cast<std::size_t>(t)];
    found.clear();
    const std::size_t part = static_cast<std::size_t>(t);
    const std::size_t begin = count * part / parts, end = count * (part + 1) / parts;
    for (std::size_t q = begin; q < end; ++q)
      if (q == begin || keys[q] != keys[q - 1]) found.push_back(keys[q]);
    sort_unique(found);
  });
  block_keys_.clear();
  for (const auto& found : found_)
    block_keys_.insert(block_keys_.end(), found.begin(), found.end());
  sort_unique(block_keys_);
}

void Partition::count_and_place(const std::vector<std::uint64_t>& keys, ThreadPool& pool,
                                int threads) {
  const std::size_t block_count = block_keys_.size();
  counts_.resize(static_cast<std::size_t>(threads));
  const std::size_t count = keys.size(), parts = static_cast<std::size_t>(threads);
  pool.run(threads, [&](int t) {
    std::vector<std::uint32_t>& counts = counts_[static_cast<std::size_t>(t)];
    counts.assign(block_count, 0);
    const std::size_t part = static_cast<std::size_t>(t);
    const std::size_t begin = count * part / parts, end = count * (part + 1) / parts;
    std::uint32_t block = 0;
    for (std::size_t q = begin; q < end; ++q) {
      if (q == begin || keys[q] != keys[q - 1]) block = index_of(block_keys_, keys[q]);
      block_of_[q] = block;
      ++counts[block];
    }
  });
  // Where each thread writes in each block: in storage order, whoever does it.
  blocks_.resize(block_count);
  std::uint32_t sum = 0;
  for (std::size_t b = 0; b < block_count; ++b) {
    blocks_[b].key = block_keys_[b];
    blocks_[b].begin = sum;
    for (auto& counts : counts_) {
      const std::uint32_t here = counts[b];
      counts[b] = sum;
      sum += here;
    }
    blocks_[b].end = sum;
  }
  pool.run(threads, [&](int t) {
    std::vector<std::uint32_t>& next = counts_[static_cast<std::size_t>(t)];
    const std::size_t part = static_cast<std::size_t>(t);
    const std::size_t begin = count * part / parts, end = count * (part + 1) / parts;
    for (std::size_t q = begin; q < end; ++q)
      order_[next[block_of_[q]]++] = static_cast<std::uint32_t>(q);
  });
}

void Partition::sort_inside_blocks(const std::vector<std::uint16_t>& locals, ThreadPool& pool,
                                   int threads) {
  scratch_.resize(static_cast<std::size_t>(threads));
  pool.run(threads, [&](int t) {
    std::vector<std::uint32_t>& scratch = scratch_[static_cast<std::size_t>(t)];
    std::uint32_t start[local_codes + 1];
    const std::uint32_t end = first_block(t + 1, threads);
    for (std::uint32_t b = first_block(t, threads); b < end; ++b) {
      std::uint32_t* order = order_.data() + blocks_[b].begin;
      const std::size_t count = blocks_[b].end - blocks_[b].begin;
      const auto by_local = [&](std::uint32_t a, std::uint32_t c) { return locals[a] < locals[c]; };
      if (std::is_sorted(order, order + count, by_local)) continue;
      std::fill(start, start + local_codes + 1, 0u);
      for (std::size_t q = 0; q < count; ++q) ++start[locals[order[q]] + 1];
      std::partial_sum(start, start + local_codes + 1, start);
      scratch.assign(order, order + count);
      for (const std::uint32_t q : scratch) order[start[locals[q]]++] = q;
    }
  });
}

void Partition::link_node_blocks() {
  previous_keys_ = block_keys_;
  std::vector<std::uint64_t> node_keys;
  node_keys.reserve(8 * block_keys_.size());
  for (const std::uint64_t key : block_keys_)
    for (int o = 0; o < 8; ++o) node_keys.push_back(wrapped(key + key_offset(o)));
  sort_unique(node_keys);
  node_blocks_.resize(node_keys.size());
  for (std::size_t n = 0; n < node_keys.size(); ++n) {
    node_blocks_[n].key = node_keys[n];
    std::fill(std::begin(node_blocks_[n].tile), std::end(node_blocks_[n].tile), -1);
  }
  links_.clear();
  for (std::size_t b = 0; b < block_keys_.size(); ++b) {
    for (int o = 0; o < 8; ++o) {
      const std::uint32_t n = index_of(node_keys, wrapped(block_keys_[b] + key_offset(o)));
      node_blocks_[n].tile[o] = static_cast<std::int32_t>(b);
      links_.push_back(n);
    }
  }
}

}  // namespace neve::sim
