#include "engine/geometry/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace sinew {

namespace {

struct Loop {
  Loop(std::size_t n_, std::size_t block_, const std::function<void(std::size_t, std::size_t)>& body_)
      : n(n_), block(block_), body(&body_) {}

  std::size_t n, block;
  const std::function<void(std::size_t, std::size_t)>* body;
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t error_block = SIZE_MAX;

  void run() {
    for (;;) {
      const std::size_t i = next.fetch_add(1);
      if (i * block >= n) return;
      try {
        (*body)(i * block, std::min(n, (i + 1) * block));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (i < error_block) {
          error_block = i;
          error = std::current_exception();
        }
      }
    }
  }
};

thread_local bool inside_loop = false;

/// Workers that sleep between loops. One loop at a time; a second caller does its own alone, so that a window never
/// waits for the solver.
class Pool {
 public:
  ~Pool() { resize(0); }

  void run(Loop& loop, int helpers) {
    const std::unique_lock one_loop(caller_, std::try_to_lock);
    if (!one_loop) {
      loop.run();
      return;
    }
    if (static_cast<int>(workers_.size()) != helpers) resize(helpers);
    {
      const std::lock_guard lock(mutex_);
      loop_ = &loop;
      busy_ = helpers;
      ++round_;
    }
    wake_.notify_all();
    inside_loop = true;
    loop.run();
    inside_loop = false;
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
    loop_ = nullptr;
  }

 private:
  void resize(int helpers) {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_all();
    for (std::thread& worker : workers_) worker.join();
    workers_.clear();
    stop_ = false;
    for (int i = 0; i < helpers; ++i) workers_.emplace_back([this, seen = round_] { work(seen); });
  }

  void work(std::uint64_t seen) {
    inside_loop = true;
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [&] { return stop_ || round_ != seen; });
      if (stop_) return;
      seen = round_;
      Loop* loop = loop_;
      lock.unlock();
      loop->run();
      lock.lock();
      if (--busy_ == 0) done_.notify_one();
    }
  }

  std::mutex caller_, mutex_;
  std::condition_variable wake_, done_;
  std::vector<std::thread> workers_;
  Loop* loop_ = nullptr;
  std::uint64_t round_ = 0;
  int busy_ = 0;
  bool stop_ = false;
};

int count_at_start() {
  if (const char* text = std::getenv("SINEW_THREADS")) return std::max(1, std::atoi(text));
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

std::atomic<int>& count() {
  static std::atomic<int> value = count_at_start();
  return value;
}

}  // namespace

int thread_count() {
  return count();
}

void set_thread_count(int n) {
  count() = std::max(1, n);
}

void parallel_for(std::size_t n, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body) {
  Loop loop(n, std::max<std::size_t>(1, block), body);
  const int helpers = thread_count() - 1;
  if (inside_loop || helpers == 0 || n <= loop.block) {
    loop.run();
  } else {
    static Pool pool;
    pool.run(loop, helpers);
  }
  if (loop.error) std::rethrow_exception(loop.error);
}

}  // namespace sinew
