#pragma once
#include <chrono>
#include <functional>
#include <future>
#include <string>

#include <priormap/core/events.hpp>
#include <priormap/core/resumable_output.hpp>
#include <priormap/core/state_archive.hpp>

namespace priormap {

/// The state of a run, kept now and then beside its output: each some seconds, and never so often that it takes a fiftieth of the time. It is written by a thread of its own.
class Checkpoints {
 public:
  using Exchange = std::function<void(StateArchive&)>;

  /// @param identity  of the run: another run's state is refused   @param interval_s  0: keeps none   @param output  must outlive this
  Checkpoints(ResumableDirectory& output, std::string identity, double interval_s, const Events& events);
  ~Checkpoints();
  Checkpoints(const Checkpoints&) = delete;
  Checkpoints& operator=(const Checkpoints&) = delete;

  /// Takes the state from the last checkpoint. @return false: there is none. @throws UsageError when it is of a run with other inputs or options, or of another build
  bool restore(const Exchange& exchange) const;
  /// Keeps the state if it is time. Where that fails, it warns and keeps no more.
  void offer(const Exchange& exchange);

 private:
  using Clock = std::chrono::steady_clock;
  bool writer_is_free();

  ResumableDirectory& output_;
  std::string identity_;
  const Events& events_;
  std::chrono::duration<double> interval_;
  bool enabled_;
  Clock::time_point next_;
  std::future<void> writing_;
};

}  // namespace priormap
