#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "fuzz_file.hpp"
#include "tile_cells.hpp"
#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/prior/prior_writer.hpp>

namespace {

using namespace priormap;

constexpr std::size_t head_size = 72, row_size = 80, patch_size = 52, point_size = 8;   // docs/file-formats.md

/// A prior of one point, whose only tile has four cells.
class OneTile {
 public:
  OneTile() : store_(written()), tile_(store_.index().entry(0)), grid_(store_.manifest().tile_size) {
    const auto file = fuzz::file_with("true.cells", nullptr, 0);
    TileCells(store_, tile_, grid_, {}).write(file);
    head_.resize(head_size);
    std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(head_.data()), head_size);
  }

  std::shared_ptr<const TileCells> open(const std::filesystem::path& file) const { return TileCells::open(file, store_, tile_, grid_, {}); }
  int num_cells() const { return grid_.cells_a_tile(); }
  const std::vector<std::uint8_t>& head() const { return head_; }

 private:
  static std::filesystem::path written() {
    PriorManifest manifest;
    manifest.tile_size = 100;
    manifest.generator = "fuzz";
    PriorSource source;
    source.id = source.kind = source.file_name = "fuzz";
    source.sha256 = std::string(64, '0');
    manifest.sources = {source};
    const auto directory = fuzz::file_with("prior.parent", nullptr, 0).parent_path() / "prior";
    PriorWriter writer(directory, manifest, Overwrite::allow);
    PointCloud cloud;
    cloud.xyz = {{10, 20, 3}};
    cloud.normal = {{0, 0, 1}};
    cloud.sigma_m = {0.1f};
    cloud.classification = {2};
    cloud.source = {0};
    cloud.feature = {PointCloud::no_feature};
    writer.add(cloud);
    writer.finish(1);
    return directory;
  }

  PriorStore store_;
  TileEntry tile_;
  CellGrid grid_;
  std::vector<std::uint8_t> head_;
};

void put_digest(std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t begin, std::size_t length) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(bytes).subspan(begin, length)));
  const Digest digest = digest_from_hex(hash.hex_digest());
  std::memcpy(bytes.data() + at, digest.data(), digest.size());
}

/// The head and the digests that this file would have had when written, so that what follows the checks is reached.
std::vector<std::uint8_t> sealed(std::vector<std::uint8_t> bytes, const OneTile& tile) {
  const std::size_t end_of_rows = head_size + row_size * static_cast<std::size_t>(tile.num_cells());
  if (bytes.size() < end_of_rows + sizeof(Digest)) return bytes;
  std::memcpy(bytes.data(), tile.head().data(), head_size);
  for (std::size_t row = head_size; row < end_of_rows; row += row_size) {
    std::uint32_t num_patches, num_points;
    std::uint64_t offset;
    std::memcpy(&num_patches, bytes.data() + row, sizeof num_patches);
    std::memcpy(&num_points, bytes.data() + row + 4, sizeof num_points);
    std::memcpy(&offset, bytes.data() + row + 8, sizeof offset);
    const std::size_t patches = num_patches * patch_size, points = num_points * point_size;
    if (offset > bytes.size() || patches + points > bytes.size() - offset) continue;
    put_digest(bytes, row + 16, offset, patches);
    put_digest(bytes, row + 16 + sizeof(Digest), offset + patches, points);
  }
  put_digest(bytes, end_of_rows, 0, end_of_rows);
  return bytes;
}

void read_all(const OneTile& tile, const std::vector<std::uint8_t>& bytes) {
  const auto cells = tile.open(fuzz::file_with("fuzzed.cells", bytes.data(), bytes.size()));
  if (!cells) return;
  cells->is_whole();
  for (int number = 0; number < tile.num_cells(); ++number) {
    try {
      cells->patches(number);
      cells->points(number);
    } catch (const DamagedCell&) {
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const OneTile tile;
  const std::vector<std::uint8_t> bytes(data, data + size);
  read_all(tile, bytes);
  read_all(tile, sealed(bytes, tile));
  return 0;
}
