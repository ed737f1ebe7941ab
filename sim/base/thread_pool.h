#pragma once
/// Worker threads for data-parallel loops whose result must not depend on how many there are.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace neve {

/// A fixed team of threads. The caller takes part as thread 0, so a team of one starts nothing.
class ThreadPool {
 public:
  /// @param thread_count 0 means one per core
  explicit ThreadPool(int thread_count = 0) {
    if (thread_count <= 0) thread_count = static_cast<int>(std::thread::hardware_concurrency());
    if (thread_count <= 0) thread_count = 1;
    for (int t = 1; t < thread_count; ++t) workers_.emplace_back([this, t] { work(t); });
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool() {
    {
      std::lock_guard lock(mutex_);
      is_stopping_ = true;
      generation_.fetch_add(1, std::memory_order_release);
    }
    wake_.notify_all();
    for (std::thread& worker : workers_) worker.join();
  }

  int thread_count() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls task(thread) once on each of the first `threads` threads and waits for all of them.
  /// The task must not throw. Not reentrant.
  void run(int threads, const std::function<void(int)>& task) {
    if (threads > thread_count()) threads = thread_count();
    if (threads <= 1) {
      task(0);
      return;
    }
    {
      std::lock_guard lock(mutex_);
      task_ = &task;
      active_ = threads;
      pending_.store(thread_count() - 1, std::memory_order_relaxed);
      generation_.fetch_add(1, std::memory_order_release);
    }
    wake_.notify_all();
    task(0);
    // A short spin covers the usual case of threads finishing together; blocking afterwards keeps
    // a team usable when another process holds one of the cores.
    for (int spin = 0; spin < spin_count; ++spin) {
      if (pending_.load(std::memory_order_acquire) == 0) return;
      pause();
    }
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return pending_.load(std::memory_order_acquire) == 0; });
  }

  /// Splits [0, count) into one contiguous range per thread: body(begin, end).
  template <class Body>
  void ranges(std::size_t count, int threads, const Body& body) {
    if (threads > thread_count()) threads = thread_count();
    if (threads < 1) threads = 1;
    const std::size_t parts = static_cast<std::size_t>(threads);
    run(threads, [&](int t) {
      const std::size_t part = static_cast<std::size_t>(t);
      body(count * part / parts, count * (part + 1) / parts);
    });
  }

 private:
  static constexpr int spin_count = 2000;

  static void pause() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }

  void work(int thread) {
    unsigned seen = 0;
    for (;;) {
      for (int spin = 0; spin < spin_count; ++spin) {
        if (generation_.load(std::memory_order_acquire) != seen) break;
        pause();
      }
      const std::function<void(int)>* task = nullptr;
      int active = 0;
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [&] { return generation_.load(std::memory_order_acquire) != seen; });
        seen = generation_.load(std::memory_order_acquire);
        if (is_stopping_) return;
        task = task_;
        active = active_;
      }
      if (thread < active) (*task)(thread);
      if (pending_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
        std::lock_guard lock(mutex_);
        done_.notify_one();
      }
    }
  }

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::atomic<unsigned> generation_{0};
  std::atomic<int> pending_{0};
  const std::function<void(int)>* task_ = nullptr;
  int active_ = 0;
  bool is_stopping_ = false;
};

}  // namespace neve
