#include "checkpoints.hpp"

#include <algorithm>
#include <utility>

#include <priormap/core/error.hpp>
#include <priormap/core/process.hpp>

#include "run_inputs.hpp"

namespace priormap {
namespace {

[[noreturn]] void refuse_other_build() { throw UsageError("--resume: the checkpoint is of another build of mapper; leave out --resume to begin anew"); }

}  // namespace

Checkpoints::Checkpoints(ResumableDirectory& output, std::string identity, double interval_s, const Events& events)
    : output_(output), identity_(std::move(identity)), events_(events), interval_(interval_s), enabled_(interval_s > 0), next_(Clock::now() + std::chrono::duration_cast<Clock::duration>(interval_)) {}

Checkpoints::~Checkpoints() {
  if (writing_.valid()) writing_.wait();
}

bool Checkpoints::restore(const Exchange& exchange) const {
  std::optional<std::string> kept = output_.checkpoint();
  if (!kept) return false;
  StateArchive archive(std::move(*kept));
  std::string build, identity;
  archive(build);
  if (build != build_id()) refuse_other_build();
  archive(identity);
  const std::string differs = difference(identity, identity_);
  if (!differs.empty()) throw UsageError("--resume: the run that was interrupted is another one: " + differs + "; leave out --resume to begin anew");
  try {
    exchange(archive);
    archive.expect_end();
  } catch (const FormatError&) {   // where builds carry no ID, their states tell
    refuse_other_build();
  }
  return true;
}

bool Checkpoints::writer_is_free() {
  if (!writing_.valid()) return true;
  if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  try {
    writing_.get();
  } catch (const std::exception& error) {
    events_.warn(std::string("no more checkpoints are kept: ") + error.what());
    enabled_ = false;
  }
  return enabled_;
}

void Checkpoints::offer(const Exchange& exchange) {
  constexpr double most_of_the_time = 0.02;
  const Clock::time_point now = Clock::now();
  if (!enabled_ || now < next_ || !writer_is_free()) return;
  StateArchive archive;
  std::string build = build_id();
  archive(build, identity_);
  exchange(archive);
  writing_ = std::async(std::launch::async, [this, state = archive.take()]() mutable {
    const std::string kept = std::move(state);   // gone when it is written: the task itself lives on until the next one
    output_.keep(kept);
  });
  next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::max<std::chrono::duration<double>>(interval_, (Clock::now() - now) / most_of_the_time));
}

}  // namespace priormap
