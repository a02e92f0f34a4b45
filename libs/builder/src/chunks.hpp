#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>

#include <priormap/core/parallel.hpp>

namespace priormap {

/// Calls `work(context, chunk, begin, end)` for each stretch of [0, count), on up to `threads` threads. Each thread makes a context of its own:
/// transformers, rasters and scratch memory are not shared. Chunks come in no fixed order: collect results by chunk.
template <class MakeContext, class Work>
void for_each_chunk(std::size_t count, std::size_t chunk_size, int threads, const MakeContext& make_context, const Work& work) {
  const std::size_t num_chunks = (count + chunk_size - 1) / chunk_size;
  std::atomic<std::size_t> next{0};
  const auto num_workers = std::min(static_cast<std::size_t>(threads), num_chunks);
  parallel_for(num_workers, threads, [&](std::size_t) {
    auto context = make_context();
    for (std::size_t chunk; (chunk = next++) < num_chunks;) work(context, chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
  });
}

}  // namespace priormap
