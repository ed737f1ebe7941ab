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

}  // namespace neve::render::surface
