#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "fuzz_file.hpp"
#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/prior/tile_index.hpp>

namespace {

/// The digest that a manifest would state of this file's head, so that what follows the check is reached.
std::string head_digest(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t pages_at = 24, head = 32, digest = 32;
  std::uint64_t pages = 0;
  if (bytes.size() >= head) std::memcpy(&pages, bytes.data() + pages_at, sizeof pages);
  const std::size_t length = head + digest * static_cast<std::size_t>(std::min<std::uint64_t>(pages, bytes.size()));
  priormap::Sha256 hash;
  hash.update(std::as_bytes(bytes.first(std::min(length, bytes.size()))));
  return hash.hex_digest();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const priormap::TileIndex index(priormap::fuzz::file_with("tiles.idx", data, size), head_digest({data, size}));
    index.keys_within({-10, -10}, {10, 10});
    for (const priormap::TileEntry& entry : index.entries()) index.find(entry.key);
  } catch (const priormap::Error&) {
  }
  return 0;
}
