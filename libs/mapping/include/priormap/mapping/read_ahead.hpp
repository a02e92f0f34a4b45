#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace priormap {

/// The items [first, last) in order, as scans, each made by a thread of its own while the caller works on the one before.
template <class Item>
class ReadAhead {
 public:
  /// @param read  makes the item of a number; called by that thread alone   @param depth  items held ready at most
  ReadAhead(std::function<Item(std::size_t)> read, std::size_t first, std::size_t last, std::size_t depth = 4)
      : read_(std::move(read)), depth_(depth), reader_([this, first, last] { read_all(first, last); }) {}
  ~ReadAhead() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    reader_.join();
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// The next item, none at the end. @throws what making it threw
  std::optional<Item> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !ready_.empty() || finished_; });
    if (!ready_.empty()) {
      Item item = std::move(ready_.front());
      ready_.pop_front();
      changed_.notify_all();
      return item;
    }
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::nullopt;
  }

 private:
  void read_all(std::size_t first, std::size_t last) {
    std::exception_ptr failure;
    try {
      for (std::size_t i = first; i < last; ++i) {
        Item item = read_(i);
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return stopped_ || ready_.size() < depth_; });
        if (stopped_) return;
        ready_.push_back(std::move(item));
        changed_.notify_all();
      }
    } catch (...) {
      failure = std::current_exception();
    }
    {
      const std::lock_guard lock(mutex_);
      failure_ = failure;
      finished_ = true;
    }
    changed_.notify_all();
  }

  std::function<Item(std::size_t)> read_;
  std::size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> ready_;
  std::exception_ptr failure_;
  bool finished_ = false, stopped_ = false;
  std::thread reader_;
};

}  // namespace priormap
