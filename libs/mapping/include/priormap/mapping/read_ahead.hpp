#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include <priormap/mapping/scan_source.hpp>

namespace priormap {

/// Scans [first, last) of a source in order, read by a thread of its own while the caller works on the one before.
class ReadAhead {
 public:
  /// @param depth  scans held ready at most; `source` must outlive this
  ReadAhead(const ScanSource& source, std::size_t first, std::size_t last, std::size_t depth = 4);
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// The next scan, none at the end. @throws what reading it threw
  std::optional<Scan> next();

 private:
  void read_all(std::size_t first, std::size_t last);

  const ScanSource& source_;
  std::size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Scan> ready_;
  std::exception_ptr failure_;
  bool finished_ = false, stopped_ = false;
  std::thread reader_;
};

}  // namespace priormap
