#pragma once
#include <cstddef>
#include <functional>

namespace priormap {

/// Number of threads to use when the user names none: the cores this process may run on.
int default_thread_count();

/// Calls `body(i)` for each i in [0, count), on up to `threads` threads, each index once, in no fixed order.
/// The first exception is rethrown in the caller after all threads have ended.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

/// Runs `work(i)` in parallel and `consume(i)` in the caller's thread in order of i, with at most `window` results
/// waiting: output in a fixed order, memory bounded, whatever the thread count.
void ordered_pipeline(std::size_t count, int threads, std::size_t window, const std::function<void(std::size_t)>& work,
                      const std::function<void(std::size_t)>& consume);

}  // namespace priormap
