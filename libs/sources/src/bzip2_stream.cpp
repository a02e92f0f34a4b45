#include "bzip2_stream.hpp"

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

namespace priormap {

Bzip2Stream::Bzip2Stream(FileHandle file) : file_(std::move(file)), packed_(std::size_t{1} << 16) {}

Bzip2Stream::~Bzip2Stream() { end_stream(); }

std::size_t Bzip2Stream::read(std::span<char> buffer) {
  state_.next_out = buffer.data();
  state_.avail_out = static_cast<unsigned>(buffer.size());
  while (state_.avail_out > 0) {
    if (state_.avail_in == 0) refill();
    if (state_.avail_in == 0 && !in_stream_) break;   // the end of the last stream
    if (!in_stream_ && !is_first_ && *state_.next_in == 0) {
      pass_padding();
      break;
    }
    if (!in_stream_) begin_stream();
    const bool starved = state_.avail_in == 0;
    const unsigned room = state_.avail_out;
    const int result = BZ2_bzDecompress(&state_);
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();   // it takes what the first bytes of the stream state
    if (result == BZ_STREAM_END) end_stream();
    else if (result != BZ_OK) throw Bzip2Fault("the bzip2 stream is damaged");
    else if (starved && state_.avail_out == room) throw Bzip2Fault("the bzip2 stream is cut short");
  }
  return buffer.size() - state_.avail_out;
}

void Bzip2Stream::refill() {
  state_.next_in = packed_.data();
  state_.avail_in = static_cast<unsigned>(std::fread(packed_.data(), 1, packed_.size(), file_.get()));
  if (std::ferror(file_.get())) throw std::system_error(errno, std::generic_category());
}

void Bzip2Stream::pass_padding() {
  for (; state_.avail_in > 0; refill())
    if (std::any_of(state_.next_in, state_.next_in + state_.avail_in, [](char c) { return c != 0; })) throw Bzip2Fault("the bzip2 stream is damaged");
}

void Bzip2Stream::begin_stream() {
  is_first_ = false;
  if (BZ2_bzDecompressInit(&state_, 0, 0) != BZ_OK) throw std::bad_alloc();
  in_stream_ = true;
}

void Bzip2Stream::end_stream() {
  if (in_stream_) BZ2_bzDecompressEnd(&state_);
  in_stream_ = false;
}

}  // namespace priormap
