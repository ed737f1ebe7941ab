#pragma once
/// Worker threads for data-parallel loops whose result must not depend on how many there are.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace neve {

/// A fixed team of threads. The caller takes part as thread 0, so a team of one starts nothing.
///
/// Work comes in numbered parts. Each thread owns a contiguous run of them, for the sake of its
/// cache, and takes them from the front; who is done takes parts from the back of others. The
/// caller waits for parts, never for threads: a worker whose core is held by another process delays
/// at most the part that it has in hand.
class ThreadPool {
 public:
  /// @param thread_count 0 means one per core
  explicit ThreadPool(int thread_count = 0) {
    const int cores = static_cast<int>(std::thread::hardware_concurrency());
    if (thread_count <= 0) thread_count = cores;
    if (thread_count <= 0) thread_count = 1;
    has_cores_ = thread_count <= cores;
    shares_ = std::make_unique<Share[]>(static_cast<std::size_t>(thread_count));
    for (int t = 1; t < thread_count; ++t) workers_.emplace_back([this, t] { work(t); });
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool() {
    is_stopping_.store(true, std::memory_order_relaxed);
    ++generation_;
    for (int t = 1; t < thread_count(); ++t) ring(share(t));
    for (std::thread& worker : workers_) worker.join();
  }

  int thread_count() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls task(part) once for every part in [0, parts), parts <= 65535, on at most `threads`
  /// threads, and waits for all of them. Not reentrant.
  /// @throws what a part threw; others may have been called or not
  template <class Task>
  void run(int threads, int parts, const Task& task) {
    if (threads > thread_count()) threads = thread_count();
    if (threads > parts) threads = parts;
    if (threads <= 1) {
      for (int part = 0; part < parts; ++part) task(part);
      return;
    }
    task_ = &task;
    call_ = [](const void* t, int part) { (*static_cast<const Task*>(t))(part); };
    start(threads, parts);
    take_parts(0, generation_);
    wait_for_parts();
    if (has_failed_.load(std::memory_order_relaxed)) rethrow();
  }

  /// One part per thread.
  template <class Task>
  void run(int threads, const Task& task) {
    if (threads > thread_count()) threads = thread_count();
    run(threads, threads < 1 ? 1 : threads, task);
  }

  /// Returns as many parts as even out the delays of threads by each other and by other processes.
  static int parts_for(int threads) { return threads <= 1 ? 1 : 8 * threads; }

  /// Splits [0, count) into contiguous ranges: body(begin, end).
  template <class Body>
  void ranges(std::size_t count, int threads, const Body& body) {
    if (threads > thread_count()) threads = thread_count();
    const int parts = parts_for(threads);
    run(threads, parts, [&](int part) {
      const std::size_t p = static_cast<std::size_t>(part), of = static_cast<std::size_t>(parts);
      const std::size_t begin = count * p / of, end = count * (p + 1) / of;
      if (begin < end) body(begin, end);
    });
  }

 private:
  /// Covers the gaps between the sweeps of a step; longer would take cores from other processes.
  static constexpr std::chrono::microseconds spin_time{20};

  /// Remaining work of one thread, and its signal. On a cache line of its own.
  struct alignas(64) Share {
    /// Generation, begin and end of its parts in 32, 16 and 16 bits. They change as one, so that no
    /// thread takes parts of a finished job.
    std::atomic<std::uint64_t> parts{0};
    std::atomic<std::uint32_t> generation{0};
  };

  Share& share(int thread) { return shares_[static_cast<std::size_t>(thread)]; }

  static std::uint64_t pack(std::uint32_t generation, int begin, int end) {
    return static_cast<std::uint64_t>(generation) << 32 | static_cast<std::uint64_t>(begin) << 16 |
           static_cast<std::uint64_t>(end);
  }

  void start(int threads, int parts) {
    ++generation_;
    pending_.store(parts, std::memory_order_relaxed);
    for (int t = 0; t < threads; ++t)
      share(t).parts.store(pack(generation_, parts * t / threads, parts * (t + 1) / threads),
                           std::memory_order_release);
    for (int t = 1; t < threads; ++t) ring(share(t));
  }

  void ring(Share& s) {
    s.generation.store(generation_, std::memory_order_release);
    s.generation.notify_one();
  }

  /// A part of a share: its owner's next or a helper's last. -1: none left, or another job.
  static int take(Share& s, std::uint32_t generation, bool is_own) {
    std::uint64_t word = s.parts.load(std::memory_order_acquire);
    for (;;) {
      const int begin = static_cast<int>(word >> 16 & 0xffff),
                end = static_cast<int>(word & 0xffff);
      if (word >> 32 != generation || begin >= end) return -1;
      const int taken = is_own ? begin : end - 1;
      const std::uint64_t rest =
          is_own ? pack(generation, begin + 1, end) : pack(generation, begin, end - 1);
      if (s.parts.compare_exchange_weak(word, rest, std::memory_order_acq_rel,
                                        std::memory_order_acquire))
        return taken;
    }
  }

  /// Works until no part of this job is left to take. A thread with a part may read the job: its
  /// caller waits for that part.
  void take_parts(int thread, std::uint32_t generation) {
    const int owners = thread_count();
    for (int k = 0; k < owners; ++k) {
      Share& s = share((thread + k) % owners);
      for (int part = take(s, generation, k == 0); part >= 0; part = take(s, generation, k == 0)) {
        try {
          call_(task_, part);
        } catch (...) {
          if (!has_failed_.exchange(true)) failure_ = std::current_exception();
        }
        if (pending_.fetch_sub(1, std::memory_order_acq_rel) == 1) pending_.notify_one();
      }
    }
  }

  [[noreturn]] void rethrow() {
    has_failed_ = false;
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }

  void wait_for_parts() {
    const auto is_done = [this] { return pending_.load(std::memory_order_acquire) == 0; };
    if (spin_until(is_done)) return;
    for (int left = pending_.load(std::memory_order_acquire); left != 0;
         left = pending_.load(std::memory_order_acquire))
      pending_.wait(left, std::memory_order_acquire);
  }

  void work(int thread) {
    std::atomic<std::uint32_t>& bell = share(thread).generation;
    for (std::uint32_t seen = 0;;) {
      if (!spin_until([&] { return bell.load(std::memory_order_acquire) != seen; }))
        bell.wait(seen, std::memory_order_acquire);
      seen = bell.load(std::memory_order_acquire);
      if (is_stopping_.load(std::memory_order_relaxed)) return;
      take_parts(thread, seen);
    }
  }

  /// Looks again and again for a short while. With more threads than cores that would only keep
  /// another thread of the team from its work.
  template <class Condition>
  bool spin_until(const Condition& holds) const {
    if (!has_cores_) return holds();
    const auto start = std::chrono::steady_clock::now();
    for (;;) {
      for (int k = 0; k < 32; ++k) {
        if (holds()) return true;
        pause();
      }
      if (std::chrono::steady_clock::now() - start > spin_time) return false;
    }
  }

  static void pause() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }

  std::vector<std::thread> workers_;
  std::unique_ptr<Share[]> shares_;
  bool has_cores_ = true;
  std::atomic<bool> is_stopping_{false};
  std::atomic<int> pending_{0};
  std::uint32_t generation_ = 0;
  // The job.
  const void* task_ = nullptr;
  void (*call_)(const void*, int) = nullptr;
  std::atomic<bool> has_failed_{false};
  std::exception_ptr failure_;
};

}  // namespace neve
