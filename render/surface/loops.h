#pragma once
/// Loops with and without threads.

#include "sim/base/thread_pool.h"

namespace neve::render::surface {

/// body(begin, end) for ranges of [0, count) that do not depend on each other. @param pool may be
/// null
template <class Body>
void for_ranges(ThreadPool* pool, std::size_t count, const Body& body) {
  if (pool)
    pool->ranges(count, pool->thread_count(), body);
  else if (count > 0)
    body(std::size_t{0}, count);
}

/// Parts that [0, count) is cut into by for_parts.
inline std::size_t part_count(const ThreadPool* pool) {
  return pool ? static_cast<std::size_t>(ThreadPool::parts_for(pool->thread_count())) : 1;
}

/// body(part, begin, end) for each part, all in [0, part_count(pool)) and in order.
template <class Body>
void for_parts(ThreadPool* pool, std::size_t count, const Body& body) {
  const std::size_t parts = part_count(pool);
  const auto run = [&](int n) {
    const auto part = static_cast<std::size_t>(n);
    body(part, count * part / parts, count * (part + 1) / parts);
  };
  if (pool)
    pool->run(pool->thread_count(), static_cast<int>(parts), run);
  else
    run(0);
}

}  // namespace neve::render::surface
