#pragma once
/// Putting records into another order without a second copy of them.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/base/thread_pool.h"

namespace neve::sim::engine {

/// Record q becomes what record order[q] was; the order becomes 0, 1, 2, ...
///
/// Each thread owns a range. Records that its range gets from others are set aside first, before
/// anything moves; then records follow each other into the place that was freed last. Snow that was
/// in order a few steps ago gets little from elsewhere; if it is much, one thread does all and
/// needs nothing.
template <class Record>
class Reordering {
 public:
  void run(std::vector<Record>& records, std::vector<std::uint32_t>& order, ThreadPool& pool,
           int threads) {
    parts_.resize(static_cast<std::size_t>(threads < 1 ? 1 : threads));
    if (count_foreign(order, pool) > order.size() / 8) parts_.resize(1);
    const int parts = static_cast<int>(parts_.size());
    pool.run(parts, parts, [&](int p) { set_aside(records, order, p); });
    pool.run(parts, parts, [&](int p) { move(records, order, p); });
  }

  std::size_t memory_bytes() const {
    std::size_t bytes = 0;
    for (const Part& part : parts_)
      bytes += sizeof(Record) * part.foreign.capacity() + part.is_needed.capacity();
    return bytes;
  }

 private:
  struct Part {
    std::size_t begin = 0, end = 0, foreign_count = 0;
    std::vector<Record> foreign;
    std::vector<std::uint8_t> is_needed;  ///< within the range
    bool owns(std::uint32_t q) const { return q >= begin && q < end; }
  };
  /// Marks an order that counts in foreign instead.
  static constexpr std::uint32_t foreign_flag = std::uint32_t(1) << 31;

  std::size_t count_foreign(const std::vector<std::uint32_t>& order, ThreadPool& pool) {
    const int parts = static_cast<int>(parts_.size());
    pool.run(parts, parts, [&](int p) {
      Part& part = parts_[static_cast<std::size_t>(p)];
      cut(part, order.size(), static_cast<std::size_t>(p), parts_.size());
      part.foreign_count = 0;
      for (std::size_t q = part.begin; q < part.end; ++q)
        part.foreign_count += !part.owns(order[q]);
    });
    std::size_t sum = 0;
    for (const Part& part : parts_) sum += part.foreign_count;
    return sum;
  }

  static void cut(Part& part, std::size_t count, std::size_t p, std::size_t parts) {
    part.begin = count * p / parts;
    part.end = count * (p + 1) / parts;
  }

  void set_aside(const std::vector<Record>& records, std::vector<std::uint32_t>& order, int p) {
    Part& part = parts_[static_cast<std::size_t>(p)];
    cut(part, order.size(), static_cast<std::size_t>(p), parts_.size());
    part.foreign.clear();
    part.is_needed.assign(part.end - part.begin, 0);
    for (std::size_t q = part.begin; q < part.end; ++q) {
      const std::uint32_t source = order[q];
      if (part.owns(source)) {
        part.is_needed[source - part.begin] = 1;
      } else {
        order[q] = foreign_flag | static_cast<std::uint32_t>(part.foreign.size());
        part.foreign.push_back(records[source]);
      }
    }
  }

  void move(std::vector<Record>& records, std::vector<std::uint32_t>& order, int p) {
    Part& part = parts_[static_cast<std::size_t>(p)];
    // Fills a place from its source, the source's from its own, and so on, until the source is one
    // that was set aside or the first place. A scout goes ahead and fetches.
    const auto fill = [&](std::uint32_t first) {
      std::uint32_t place = first, scout = first;
      for (int k = 0; k < steps_ahead; ++k) advance(scout, order, records);
      for (;;) {
        const std::uint32_t source = order[place];
        advance(scout, order, records);
        order[place] = place;
        if (source == first || source & foreign_flag)
          return std::pair<std::uint32_t, std::uint32_t>(place, source);
        records[place] = records[source];
        place = source;
      }
    };
    // A place whose record nobody here needs is free: a chain begins that ends with one set aside.
    for (std::size_t q = part.begin; q < part.end; ++q) {
      if (part.is_needed[q - part.begin]) continue;
      const auto [place, source] = fill(static_cast<std::uint32_t>(q));
      records[place] = part.foreign[source & ~foreign_flag];
    }
    // The remaining moves form cycles.
    for (std::size_t q = part.begin; q < part.end; ++q) {
      if (order[q] == q) continue;
      const Record record = records[q];
      records[fill(static_cast<std::uint32_t>(q)).first] = record;
    }
  }

  static void advance(std::uint32_t& scout, const std::vector<std::uint32_t>& order,
                      const std::vector<Record>& records) {
    const std::uint32_t next = order[scout];
    if (next & foreign_flag) return;
    scout = next;
    const char* at = reinterpret_cast<const char*>(&records[scout]);
    for (std::size_t byte = 0; byte < sizeof(Record); byte += 64) __builtin_prefetch(at + byte);
  }

  static constexpr int steps_ahead = 8;

  std::vector<Part> parts_;
};

}  // namespace neve::sim::engine
