/// Every part of a job is done once, by any thread.

#include "sim/base/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <numeric>
#include <vector>

namespace {

using namespace neve;

TEST(ThreadPool, ThreadPoolDoesEveryPartOfManyTinyJobsOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    ThreadPool pool(threads);
    ASSERT_EQ(pool.thread_count(), threads);
    std::vector<std::atomic<int>> done(64);
    const int jobs = 20000;
    std::int64_t expected = 0;
    for (int job = 0; job < jobs; ++job) {
      const int parts = job % 64;
      pool.run(threads, parts, [&](int part) { ++done[static_cast<std::size_t>(part)]; });
      expected += parts;
    }
    std::int64_t sum = 0;
    for (const auto& d : done) sum += d;
    EXPECT_EQ(sum, expected) << threads << " threads";
    // Part k belongs to jobs of more than k parts.
    for (int part = 0; part < 64; ++part)
      EXPECT_EQ(done[static_cast<std::size_t>(part)],
                jobs / 64 * (63 - part) + std::max(0, jobs % 64 - part - 1))
          << threads << " threads, part " << part;
  }
}

TEST(ThreadPool, PartsSeeWhatTheCallerWroteAndTheCallerSeesWhatTheyWrote) {
  ThreadPool pool(3);
  std::vector<int> numbers(1000);
  for (int job = 0; job < 2000; ++job) {
    for (int& n : numbers) n = job;
    pool.ranges(numbers.size(), 3, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) numbers[k] += static_cast<int>(k);
    });
    for (std::size_t k = 0; k < numbers.size(); ++k)
      ASSERT_EQ(numbers[k], job + static_cast<int>(k));
  }
}

TEST(ThreadPool, RangesCoverWithoutOverlap) {
  for (const int threads : {1, 2, 3, 7}) {
    ThreadPool pool(threads);
    for (const std::size_t count : {0, 1, 5, 56, 57, 1000}) {
      std::vector<std::atomic<int>> seen(count);
      pool.ranges(count, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) ++seen[k];
      });
      for (const auto& s : seen) EXPECT_EQ(s, 1);
    }
  }
}

TEST(ThreadPool, ThreadPoolAsksForNoMoreThreadsThanItHas) {
  ThreadPool pool(2);
  std::atomic<int> calls{0};
  pool.run(9, [&](int) { ++calls; });
  EXPECT_EQ(calls, 2);
  pool.run(0, [&](int) { ++calls; });
  EXPECT_EQ(calls, 3);
}

TEST(ThreadPool, ThreadPoolEndsWhileIdleAsleepOrJustCalled) {
  for (int k = 0; k < 200; ++k) {
    ThreadPool idle(1 + k % 7);
    if (k % 2) idle.run(idle.thread_count(), [](int) {});
    if (k % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(ThreadPool, ThreadPoolWakesThreadsThatFellAsleep) {
  ThreadPool pool(3);
  for (int k = 0; k < 20; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::atomic<int> calls{0};
    pool.run(3, 30, [&](int) { ++calls; });
    ASSERT_EQ(calls, 30);
  }
}

TEST(ThreadPool, WhatAPartThrowsReachesTheCallerAndThePoolContinues) {
  ThreadPool pool(3);
  for (int k = 0; k < 50; ++k) {
    EXPECT_THROW(pool.run(3, 30,
                          [&](int part) {
                            if (part % 7 == k % 7) throw std::bad_alloc();
                          }),
                 std::bad_alloc);
    std::atomic<int> calls{0};
    pool.run(3, 30, [&](int) { ++calls; });
    ASSERT_EQ(calls, 30);
  }
}

}  // namespace
