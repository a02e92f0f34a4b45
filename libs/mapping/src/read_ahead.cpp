#include <priormap/mapping/read_ahead.hpp>

#include <utility>

namespace priormap {

ReadAhead::ReadAhead(const ScanSource& source, std::size_t first, std::size_t last, std::size_t depth)
    : source_(source), depth_(depth), reader_([this, first, last] { read_all(first, last); }) {}

ReadAhead::~ReadAhead() {
  {
    std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  reader_.join();
}

void ReadAhead::read_all(std::size_t first, std::size_t last) {
  std::exception_ptr failure;
  try {
    for (std::size_t i = first; i < last; ++i) {
      Scan scan = source_.read(i);
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stopped_ || ready_.size() < depth_; });
      if (stopped_) return;
      ready_.push_back(std::move(scan));
      changed_.notify_all();
    }
  } catch (...) {
    failure = std::current_exception();
  }
  {
    std::lock_guard lock(mutex_);
    failure_ = failure;
    finished_ = true;
  }
  changed_.notify_all();
}

std::optional<Scan> ReadAhead::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !ready_.empty() || finished_; });
  if (!ready_.empty()) {
    Scan scan = std::move(ready_.front());
    ready_.pop_front();
    changed_.notify_all();
    return scan;
  }
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  return std::nullopt;
}

}  // namespace priormap
