#include <priormap/prior/prior_store.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/pointcloud/las.hpp>

#include "feature_lines.hpp"
#include "lattice.hpp"

namespace priormap {
namespace {

std::vector<std::byte> read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw IoError(file, "is missing or cannot be read; make the prior again");
  std::vector<std::byte> bytes(std::size_t(in.tellg()));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  if (!in) throw IoError(file, "cannot be read");
  return bytes;
}

std::string sha256_of(const std::vector<std::byte>& bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.hex_digest();
}

void verify(const std::filesystem::path& file, const std::string& sha256, const TileEntry& entry) {
  if (sha256 != entry.sha256)
    throw FormatError(file, "does not have the sha256 that the index states: it was changed or damaged; make the prior again");
}

void check_count(const std::filesystem::path& file, const LasReader& reader, const TileEntry& entry) {
  if (reader.header().num_points != entry.num_points)
    throw FormatError(file, "holds " + std::to_string(reader.header().num_points) + " points, the index says " +
                                std::to_string(entry.num_points) + "; make the prior again");
}

/// Fills columns that a tile written by another program may lack.
void complete_columns(PointCloud& points) {
  const std::size_t n = points.size();
  if (points.normal.empty()) points.normal.resize(n, Eigen::Vector3f::Zero());
  if (points.classification.empty()) points.classification.resize(n);
  if (points.sigma_m.empty()) points.sigma_m.resize(n, std::numeric_limits<float>::quiet_NaN());
  if (points.source.empty()) points.source.resize(n);
  if (points.feature.empty()) points.feature.resize(n, PointCloud::no_feature);
  if (points.intensity.empty()) points.intensity.resize(n);
}

/// Indices that lie in no range of a tile grid are clamped: no tile lies there.
std::int32_t clamped_index(double coordinate, double tile_size) {
  return std::int32_t(std::clamp(std::floor(coordinate / tile_size), double(INT32_MIN), double(INT32_MAX)));
}

}  // namespace

struct PriorStore::Impl {
  std::filesystem::path directory;
  PriorManifest manifest;
  LatticeGrid grid;
  TileIndex index;

  explicit Impl(const std::filesystem::path& path)
      : directory(path),
        manifest(read_manifest(path)),
        grid(manifest.tile_size),
        index(path / tile_index_file_name, manifest.tiles.head_sha256) {
    if (index.size() != manifest.num_tiles)
      throw FormatError(path / tile_index_file_name, "holds " + std::to_string(index.size()) + " tiles, prior.json says " +
                                                         std::to_string(manifest.num_tiles) + "; make the prior again");
  }

  TileEntry entry(TileKey key) const {
    const std::optional<TileEntry> found = index.find(key);
    if (!found) throw FormatError(directory, "has no tile " + TileGrid::name(key));
    return *found;
  }
  Eigen::Vector3d origin(const TileEntry& entry) const {
    return {double(grid.origin(entry.key.x)) / 1000.0, double(grid.origin(entry.key.y)) / 1000.0, std::floor(double(entry.min_z))};
  }
};

PriorStore::PriorStore(const std::filesystem::path& directory) : impl_(std::make_unique<Impl>(directory)) {}
PriorStore::~PriorStore() = default;
PriorStore::PriorStore(PriorStore&&) noexcept = default;
PriorStore& PriorStore::operator=(PriorStore&&) noexcept = default;

const std::filesystem::path& PriorStore::directory() const { return impl_->directory; }
const PriorManifest& PriorStore::manifest() const { return impl_->manifest; }
const TileIndex& PriorStore::index() const { return impl_->index; }

std::filesystem::path PriorStore::tile_file(TileKey key) const {
  return impl_->directory / tiles_folder_name / (TileGrid::name(key) + ".las");
}

std::vector<TileKey> PriorStore::tiles_within(const Bounds2& bounds) const {
  const double size = impl_->manifest.tile_size;
  return impl_->index.keys_within({clamped_index(bounds.min_x, size), clamped_index(bounds.min_y, size)},
                                  {clamped_index(bounds.max_x, size), clamped_index(bounds.max_y, size)});
}

PriorTile PriorStore::load(TileKey key, bool verify_hash) const {
  const TileEntry entry = impl_->entry(key);
  const std::filesystem::path file = tile_file(key);
  std::vector<std::byte> bytes = read_bytes(file);
  if (verify_hash) verify(file, sha256_of(bytes), entry);

  PriorTile tile{key, {}};
  const Eigen::Vector3d origin = impl_->origin(entry);
  LasReader reader(std::move(bytes), file.string());
  check_count(file, reader, entry);
  reader.read(tile.points, entry.num_points, origin);
  tile.points.origin = origin;
  complete_columns(tile.points);
  return tile;
}

void PriorStore::for_each_block(TileKey key, std::size_t points_a_block, const std::function<void(const PointCloud&)>& consume) const {
  const TileEntry entry = impl_->entry(key);
  const std::filesystem::path file = tile_file(key);
  if (!std::filesystem::is_regular_file(file)) throw IoError(file, "is missing or cannot be read; make the prior again");
  verify(file, sha256_file(file), entry);
  LasReader reader(file);
  check_count(file, reader, entry);
  PointCloud block;
  while (reader.read(block, points_a_block, impl_->origin(entry))) {
    complete_columns(block);
    consume(block);
  }
}

void PriorStore::for_each_feature(const std::function<void(std::uint32_t, const Feature&)>& consume) const {
  read_feature_lines(impl_->directory / features_file_name, OutlineFrame(impl_->manifest.crs, impl_->manifest.features_crs, impl_->manifest.features_operation), consume);
}

std::vector<Feature> PriorStore::features() const {
  std::vector<Feature> features;
  for_each_feature([&](std::uint32_t, const Feature& feature) { features.push_back(feature); });
  return features;
}

}  // namespace priormap
