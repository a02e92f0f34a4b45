#include <priormap/core/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace priormap {
namespace {

std::size_t worker_count(std::size_t count, int threads) {
  return std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
}

}  // namespace

int default_thread_count() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  const std::size_t workers = worker_count(count, threads);
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }

  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  std::mutex mutex;
  std::size_t failed_index = count;
  std::exception_ptr failure;

  // Indices are handed out in order and those begun are finished, so the lowest index that fails is the same for any
  // thread count.
  const auto work = [&] {
    while (!failed) {
      const std::size_t i = next++;
      if (i >= count) return;
      try {
        body(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failed = true;
        if (i < failed_index) {
          failed_index = i;
          failure = std::current_exception();
        }
      }
    }
  };

  {
    std::vector<std::jthread> pool;
    for (std::size_t t = 1; t < workers; ++t) pool.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

void ordered_pipeline(std::size_t count, int threads, std::size_t window, const std::function<void(std::size_t)>& work,
                      const std::function<void(std::size_t)>& consume) {
  const std::size_t workers = worker_count(count, threads);
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) {
      work(i);
      consume(i);
    }
    return;
  }

  struct Slot {
    bool done = false;
    std::exception_ptr failure;
  };
  window = std::max<std::size_t>(window, 1);
  std::vector<Slot> slots(window);
  std::mutex mutex;
  std::condition_variable slot_done, slot_free;
  std::size_t begun = 0, consumed = 0;
  bool stopped = false;

  const auto run_worker = [&] {
    std::unique_lock lock(mutex);
    for (;;) {
      slot_free.wait(lock, [&] { return stopped || begun >= count || begun < consumed + window; });
      if (stopped || begun >= count) return;
      const std::size_t i = begun++;
      lock.unlock();
      std::exception_ptr failure;
      try {
        work(i);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      slots[i % window] = {true, failure};
      slot_done.notify_one();
    }
  };
  const auto stop = [&] {
    const std::lock_guard lock(mutex);
    stopped = true;
    slot_free.notify_all();
  };

  std::vector<std::jthread> pool;
  for (std::size_t t = 0; t < workers; ++t) pool.emplace_back(run_worker);
  try {
    for (std::size_t i = 0; i < count; ++i) {
      {
        std::unique_lock lock(mutex);
        slot_done.wait(lock, [&] { return slots[i % window].done; });
        if (slots[i % window].failure) std::rethrow_exception(slots[i % window].failure);
      }
      consume(i);
      const std::lock_guard lock(mutex);
      slots[i % window] = {};
      consumed = i + 1;
      slot_free.notify_all();
    }
  } catch (...) {
    stop();
    throw;
  }
}

}  // namespace priormap
