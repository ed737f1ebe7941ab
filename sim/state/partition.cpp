#include "sim/state/partition.h"

#include <algorithm>
#include <numeric>

#include "sim/laws/list.h"

namespace neve::sim::engine {

namespace {

/// One block up an axis.
constexpr std::uint64_t key_step(int axis) {
  return std::uint64_t(1) << (42 - 21 * axis);
}

constexpr std::uint64_t place_of(std::uint16_t local, std::uint32_t particle) {
  return static_cast<std::uint64_t>(local) << 32 | particle;
}

constexpr auto is_before = [](const auto& a, const auto& b) { return a.key < b.key; };

/// Cuts count into parts: where one begins.
std::size_t cut(std::size_t count, std::size_t part, std::size_t parts) {
  return count * part / parts;
}

/// Many are put into their cells first; what remains are a few of each cell, mostly in order. Many
/// in a cell, as of a file of equal points, would take the square of their number.
void sort_places(std::vector<std::uint64_t>& places, std::vector<std::uint64_t>& scattered) {
  if (places.size() < 64) {
    std::sort(places.begin(), places.end());
    return;
  }
  // The starts of each model and cell, which are the upper bits of a place.
  std::uint32_t start[laws::law_count * kernels::block_nodes + 1] = {};
  for (const std::uint64_t place : places) ++start[(place >> 32) + 1];
  std::partial_sum(std::begin(start), std::end(start), std::begin(start));
  scattered.resize(places.size());
  for (const std::uint64_t place : places) scattered[start[place >> 32]++] = place;
  places.swap(scattered);
  std::size_t moves_left = 32 * places.size();
  for (std::size_t k = 1; k < places.size(); ++k) {
    const std::uint64_t place = places[k];
    std::size_t to = k;
    for (; to > 0 && places[to - 1] > place; --to) places[to] = places[to - 1];
    places[to] = place;
    if (moves_left < k - to) {
      std::sort(places.begin(), places.end());
      return;
    }
    moves_left -= k - to;
  }
}

/// The cells that a block's particles are in, along x and y. Small numbers: eight at a time.
void find_cells(const std::uint16_t* locals, kernels::ParticleBlock& block) {
  constexpr std::int16_t x_bits = 3 << 4, y_bits = 3 << 2;
  std::int16_t first_x = x_bits, last_x = 0, first_y = y_bits, last_y = 0;
  for (std::uint32_t p = block.begin; p < block.end; ++p) {
    const auto x = static_cast<std::int16_t>(locals[p] & x_bits);
    const auto y = static_cast<std::int16_t>(locals[p] & y_bits);
    first_x = std::min(first_x, x);
    last_x = std::max(last_x, x);
    first_y = std::min(first_y, y);
    last_y = std::max(last_y, y);
  }
  block.first_cell[0] = static_cast<std::uint8_t>(first_x >> 4);
  block.last_cell[0] = static_cast<std::uint8_t>(last_x >> 4);
  block.first_cell[1] = static_cast<std::uint8_t>(first_y >> 2);
  block.last_cell[1] = static_cast<std::uint8_t>(last_y >> 2);
}

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
  return sizeof(T) * v.capacity();
}

}  // namespace

void Partition::invalidate() {
  order_.clear();
  locals_.clear();
  all_.clear();
}

void Partition::build(const std::vector<std::uint64_t>& keys,
                      const std::vector<std::uint16_t>& locals, ThreadPool& pool, int threads) {
  if (keys.size() < order_.size()) invalidate();
  const std::size_t known = order_.size();
  order_.resize(keys.size());
  locals_.resize(keys.size());
  next_order_.resize(keys.size());
  next_locals_.resize(keys.size());
  parts_.resize(static_cast<std::size_t>(std::max(1, threads)));
  find_changes(keys, locals, known, pool);
  list_blocks();
  place_particles(pool);
  // The first build moves every particle: free its buffers.
  if (known == 0)
    for (Part& part : parts_) part = Part();
}

/// Finds the particles that stay, those that changed cell and those that arrive in another block.
void Partition::find_changes(const std::vector<std::uint64_t>& keys,
                             const std::vector<std::uint16_t>& locals, std::size_t known,
                             ThreadPool& pool) {
  kept_.resize(all_.size());
  const int threads = static_cast<int>(parts_.size());
  pool.run(threads, threads, [&](int t) {
    Part& part = parts_[static_cast<std::size_t>(t)];
    part.arrivals.clear();
    part.groups.clear();
    const std::uint32_t end = first_of_all(t + 1, threads);
    for (std::uint32_t b = first_of_all(t, threads); b < end; ++b) keep(b, keys, locals, part);
    const std::size_t added = keys.size() - known, before = part.arrivals.size();
    const std::size_t last = known + cut(added, static_cast<std::size_t>(t) + 1, parts_.size());
    for (std::size_t q = known + cut(added, static_cast<std::size_t>(t), parts_.size()); q < last;
         ++q)
      part.arrivals.push_back({keys[q], place_of(locals[q], static_cast<std::uint32_t>(q))});
    group_arrivals(part, before);
    std::sort(part.groups.begin(), part.groups.end(), is_before);
  });
}

/// Groups the arrivals from `begin` on by the block that they go to.
void Partition::group_arrivals(Part& part, std::size_t begin) {
  if (begin == part.arrivals.size()) return;
  std::sort(part.arrivals.begin() + static_cast<std::ptrdiff_t>(begin), part.arrivals.end(),
            is_before);
  const std::size_t first = part.groups.size();
  for (std::size_t a = begin; a < part.arrivals.size(); ++a) {
    const std::uint64_t key = part.arrivals[a].key;
    if (part.groups.size() == first || part.groups.back().key != key)
      part.groups.push_back({key, static_cast<std::uint32_t>(a), 0});
    ++part.groups.back().count;
  }
}

void Partition::keep(std::size_t b, const std::vector<std::uint64_t>& keys,
                     const std::vector<std::uint16_t>& locals, Part& part) {
  const kernels::BlockRange& block = all_[b];
  const std::size_t before = part.arrivals.size();
  part.places.clear();
  std::uint32_t stay = block.begin;
  for (std::uint32_t p = block.begin; p < block.end; ++p) {
    const std::uint32_t q = order_[p];
    const std::uint16_t local = locals[q];
    if (keys[q] != block.key) {
      part.arrivals.push_back({keys[q], place_of(local, q)});
    } else if (local != locals_[p]) {
      part.places.push_back(place_of(local, q));
    } else {
      order_[stay] = q;
      locals_[stay++] = local;
    }
  }
  std::uint32_t back = block.end;
  for (const std::uint64_t place : part.places) {
    order_[--back] = static_cast<std::uint32_t>(place);
    locals_[back] = static_cast<std::uint16_t>(place >> 32);
  }
  group_arrivals(part, before);
  kept_[b] = {block.begin, stay, back, block.end};
}

/// Lists the blocks that have particles now, with their ranges.
void Partition::list_blocks() {
  arrival_groups_.clear();
  for (const Part& part : parts_)
    arrival_groups_.insert(arrival_groups_.end(), part.groups.begin(), part.groups.end());
  std::sort(arrival_groups_.begin(), arrival_groups_.end(), is_before);
  next_all_.clear();
  source_.clear();
  std::uint32_t sum = 0;
  std::size_t a = 0, b = 0;
  while (b < all_.size() || a < arrival_groups_.size()) {
    const bool is_known =
        b < all_.size() && (a == arrival_groups_.size() || all_[b].key <= arrival_groups_[a].key);
    kernels::BlockRange block = is_known ? all_[b] : kernels::BlockRange{};
    std::uint32_t count = 0;
    if (is_known)
      count = kept_[b].stay - kept_[b].begin + kept_[b].end - kept_[b].moved;
    else
      block.key = arrival_groups_[a].key;
    for (; a < arrival_groups_.size() && arrival_groups_[a].key == block.key; ++a)
      count += arrival_groups_[a].count;
    if (count > 0) {
      block.begin = sum;
      block.end = sum += count;
      next_all_.push_back(block);
      source_.push_back(is_known ? static_cast<std::int32_t>(b) : -1);
    }
    b += is_known;
  }
  all_.swap(next_all_);
}

void Partition::place_particles(ThreadPool& pool) {
  const int threads = static_cast<int>(parts_.size());
  pool.run(threads, threads, [&](int t) {
    Part& part = parts_[static_cast<std::size_t>(t)];
    const std::uint32_t begin = first_of_all(t, threads), end = first_of_all(t + 1, threads);
    if (begin == end) return;
    part.next.clear();
    for (const Part& from : parts_)
      part.next.push_back(static_cast<std::size_t>(
          std::lower_bound(from.groups.begin(), from.groups.end(),
                           ArrivalGroup{all_[begin].key, 0, 0}, is_before) -
          from.groups.begin()));
    for (std::uint32_t b = begin; b < end; ++b)
      fill(all_[b], source_[b] < 0 ? Kept{} : kept_[static_cast<std::size_t>(source_[b])], part);
  });
  order_.swap(next_order_);
  locals_.swap(next_locals_);
}

/// Merges those that stayed with those that changed cell or block.
void Partition::fill(const kernels::BlockRange& block, const Kept& kept, Part& part) {
  std::vector<std::uint64_t>& places = part.places;
  places.clear();
  for (std::uint32_t p = kept.moved; p < kept.end; ++p)
    places.push_back(place_of(locals_[p], order_[p]));
  for (std::size_t t = 0; t < parts_.size(); ++t) {
    const std::vector<ArrivalGroup>& groups = parts_[t].groups;
    for (std::size_t& f = part.next[t]; f < groups.size() && groups[f].key == block.key; ++f)
      for (std::uint32_t a = groups[f].begin; a < groups[f].begin + groups[f].count; ++a)
        places.push_back(parts_[t].arrivals[a].place);
  }
  sort_places(places, part.scattered);

  std::uint32_t from = kept.begin, to = block.begin;
  const auto copy_until = [&](std::uint32_t end) {
    std::copy(order_.begin() + from, order_.begin() + end, next_order_.begin() + to);
    std::copy(locals_.begin() + from, locals_.begin() + end, next_locals_.begin() + to);
    to += end - from;
    from = end;
  };
  const auto put = [&](std::uint64_t place) {
    next_order_[to] = static_cast<std::uint32_t>(place);
    next_locals_[to++] = static_cast<std::uint16_t>(place >> 32);
  };
  const auto place_at = [&](std::uint32_t p) { return place_of(locals_[p], order_[p]); };
  if (12 * places.size() < kept.stay - kept.begin) {
    // Few: find where each goes.
    for (const std::uint64_t place : places) {
      std::uint32_t low = from;
      for (std::uint32_t count = kept.stay - from; count > 0;) {
        const std::uint32_t half = count / 2;
        const bool is_after = place_at(low + half) < place;
        low = is_after ? low + half + 1 : low;
        count = is_after ? count - half - 1 : half;
      }
      copy_until(low);
      put(place);
    }
  } else {
    for (const std::uint64_t place : places) {
      for (; from < kept.stay && place_at(from) < place; ++from) put(place_at(from));
      put(place);
    }
  }
  copy_until(kept.stay);
}

std::uint64_t Partition::wrapped(std::uint64_t key) const {
  int block[3];
  for (int a = 0; a < 3; ++a) {
    block[a] = kernels::block_coordinate(key, a);
    if (period_[a] > 0) block[a] = (block[a] % period_[a] + period_[a]) % period_[a];
  }
  return kernels::block_key(block[0], block[1], block[2]);
}

void Partition::wrap(std::vector<std::uint64_t>& keys, ThreadPool& pool, int threads) const {
  if (period_.isZero()) return;
  pool.ranges(keys.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) keys[q] = wrapped(keys[q]);
  });
}

void Partition::put_on_grid(ThreadPool& pool, int threads) {
  spray_ = Spray();
  list_grid_blocks(false);
  link_node_blocks(pool, threads);
}

void Partition::release_grid() {
  spray_ = Spray();
  blocks_ = decltype(blocks_)();
  first_particles_ = decltype(first_particles_)();
  grid_particles_ = 0;
  node_blocks_ = decltype(node_blocks_)();
  is_linked_ = false;
  for (Union& u : unions_) u = Union();
}

/// Blocks that were on the grid in the step before keep their node blocks if all of them did.
void Partition::list_grid_blocks(bool has_spray) {
  first_particles_.clear();
  grid_particles_ = 0;
  std::size_t count = 0;
  for (std::size_t b = 0; b < all_.size(); ++b) {
    if (has_spray && spray_.is_spray()[b]) continue;
    const kernels::BlockRange& block = all_[b];
    if (count == blocks_.size()) blocks_.emplace_back();
    is_linked_ = is_linked_ && blocks_[count].key == block.key;
    blocks_[count].key = block.key;
    blocks_[count].begin = block.begin;
    blocks_[count].end = block.end;
    find_cells(locals_.data(), blocks_[count++]);
    first_particles_.push_back(grid_particles_);
    grid_particles_ += block.end - block.begin;
  }
  is_linked_ = is_linked_ && count == blocks_.size();
  blocks_.resize(count);
}

void Partition::link_node_blocks(ThreadPool& pool, int threads) {
  if (!is_linked_) find_node_blocks(pool, threads);
  is_linked_ = true;
}

/// Neighbours in the storage are mostly of one block.
std::vector<kernels::BlockRange> Partition::blocks_of(const std::vector<std::uint64_t>& keys,
                                                      std::size_t begin, std::size_t end) const {
  std::vector<kernels::BlockRange> blocks;
  for (std::size_t q = begin; q < end; ++q)
    if (q == begin || keys[q] != keys[q - 1]) blocks.push_back({wrapped(keys[q]), 0, 0});
  std::sort(blocks.begin(), blocks.end(), is_before);
  const auto is_same = [](const auto& a, const auto& b) { return a.key == b.key; };
  blocks.erase(std::unique(blocks.begin(), blocks.end(), is_same), blocks.end());
  return blocks;
}

std::size_t Partition::reached_node_blocks(const std::vector<std::uint64_t>& keys) const {
  Union lines, planes, nodes;
  for (const kernels::BlockRange& block : blocks_of(keys, 0, keys.size()))
    nodes.keys.push_back(block.key);
  unite(nodes.keys, 2, lines);
  unite(lines.keys, 1, planes);
  unite(planes.keys, 0, nodes);
  return nodes.keys.size();
}

/// Tiles reach one block up each axis: three unions, axis by axis, give all node blocks in order
/// and which particle blocks reach them.
void Partition::find_node_blocks(ThreadPool& pool, int threads) {
  std::vector<std::uint64_t>& keys = unions_[0].keys;
  keys.clear();
  for (const kernels::ParticleBlock& block : blocks_) keys.push_back(block.key);
  unite(keys, 2, unions_[2]);
  unite(unions_[2].keys, 1, unions_[1]);
  unite(unions_[1].keys, 0, unions_[0]);
  node_blocks_.resize(unions_[0].keys.size());
  const auto up = [](const Union& u, std::int32_t at, int offset) {
    if (at < 0) return -1;
    return offset ? u.below[static_cast<std::size_t>(at)] : u.here[static_cast<std::size_t>(at)];
  };
  pool.ranges(node_blocks_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      node_blocks_[n].key = unions_[0].keys[n];
      for (int o = 0; o < 8; ++o) {
        const std::int32_t yz = up(unions_[0], static_cast<std::int32_t>(n), o >> 2);
        const std::int32_t tile = up(unions_[2], up(unions_[1], yz, o >> 1 & 1), o & 1);
        node_blocks_[n].tile[o] = tile;
        if (tile >= 0)
          blocks_[static_cast<std::size_t>(tile)].node_block[o] = static_cast<std::uint32_t>(n);
      }
    }
  });
}

/// Both lists are in order, so the union is a merge.
void Partition::unite(const std::vector<std::uint64_t>& keys, int axis, Union& out) const {
  constexpr std::uint64_t past_all = ~std::uint64_t(0);
  const std::size_t count = keys.size();
  // Around the end of a period the moved list begins again: then it has to be put in order.
  std::vector<std::pair<std::uint64_t, std::int32_t>> around;
  if (period_[axis] > 0) {
    for (std::size_t k = 0; k < count; ++k)
      around.emplace_back(wrapped(keys[k] + key_step(axis)), static_cast<std::int32_t>(k));
    std::sort(around.begin(), around.end());
  }
  out.keys.resize(2 * count);
  out.here.resize(2 * count);
  out.below.resize(2 * count);
  std::size_t size = 0;
  for (std::size_t h = 0, m = 0; h < count || m < count; ++size) {
    const std::uint64_t here = h < count ? keys[h] : past_all;
    const std::uint64_t moved = m == count       ? past_all
                                : around.empty() ? keys[m] + key_step(axis)
                                                 : around[m].first;
    const std::uint64_t key = std::min(here, moved);
    const auto index = static_cast<std::int32_t>(m);
    out.keys[size] = key;
    out.here[size] = here == key ? static_cast<std::int32_t>(h) : -1;
    out.below[size] = moved != key ? -1 : around.empty() ? index : around[m].second;
    h += here == key;
    m += moved == key;
  }
  out.keys.resize(size);
  out.here.resize(size);
  out.below.resize(size);
}

void Partition::storage_was_sorted(std::vector<std::uint64_t>& keys,
                                   std::vector<std::uint16_t>& locals, ThreadPool& pool,
                                   int threads) const {
  pool.ranges(all_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const kernels::BlockRange& block = all_[b];
      std::fill(keys.begin() + block.begin, keys.begin() + block.end, block.key);
      std::copy(locals_.begin() + block.begin, locals_.begin() + block.end,
                locals.begin() + block.begin);
    }
  });
}

std::size_t Partition::memory_bytes() const {
  std::size_t bytes = bytes_of(order_) + bytes_of(next_order_) + bytes_of(locals_) +
                      bytes_of(next_locals_) + bytes_of(all_) + bytes_of(next_all_) +
                      bytes_of(kept_) + bytes_of(source_) + bytes_of(arrival_groups_) +
                      bytes_of(blocks_) + bytes_of(first_particles_) + bytes_of(node_blocks_) +
                      spray_.memory_bytes();
  for (const Part& part : parts_)
    bytes += bytes_of(part.arrivals) + bytes_of(part.groups) + bytes_of(part.places) +
             bytes_of(part.next) + bytes_of(part.scattered);
  for (const Union& u : unions_) bytes += bytes_of(u.keys) + bytes_of(u.here) + bytes_of(u.below);
  return bytes;
}

std::uint32_t Partition::first_block(int part, int parts) const {
  if (part >= parts) return static_cast<std::uint32_t>(blocks_.size());
  const std::size_t particle =
      cut(grid_particles_, static_cast<std::size_t>(part), static_cast<std::size_t>(parts));
  const auto at = std::lower_bound(first_particles_.begin(), first_particles_.end(), particle);
  return static_cast<std::uint32_t>(at - first_particles_.begin());
}

std::uint32_t Partition::first_of_all(int part, int parts) const {
  if (part >= parts) return static_cast<std::uint32_t>(all_.size());
  const std::uint64_t particle =
      cut(order_.size(), static_cast<std::size_t>(part), static_cast<std::size_t>(parts));
  const auto at = std::partition_point(
      all_.begin(), all_.end(),
      [&](const kernels::BlockRange& block) { return block.begin < particle; });
  return static_cast<std::uint32_t>(at - all_.begin());
}

}  // namespace neve::sim::engine
