#pragma once
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace priormap {

/// Objects that keep their buffers from one use to the next: as many as threads have used one at the same time.
template <class T>
class Reused {
 public:
  explicit Reused(std::function<T()> make) : make_(std::move(make)) {}

  /// Thread-safe. @return what `use(T&)` returns
  template <class Use>
  auto with_one(Use&& use) {
    T one = take();
    auto result = use(one);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(one));
    return result;
  }

 private:
  T take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return make_();
    T one = std::move(idle_.back());
    idle_.pop_back();
    return one;
  }

  std::function<T()> make_;
  std::mutex mutex_;
  std::vector<T> idle_;
};

}  // namespace priormap
