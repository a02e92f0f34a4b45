#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/feature.hpp>
#include <priormap/prior/prior_manifest.hpp>
#include <priormap/prior/tile_index.hpp>

namespace priormap {

struct PriorTile {
  TileKey key;
  PointCloud points;   ///< origin at the tile's lower-left corner, z origin at a whole metre below its points; all columns present
};

/// Read access to a prior of any size: opening reads prior.json and the head of tiles.idx, tiles are loaded one by one.
/// Const members are thread-safe.
class PriorStore {
 public:
  /// @throws IoError, FormatError (schema, digest of the index)
  explicit PriorStore(const std::filesystem::path& directory);
  ~PriorStore();
  PriorStore(PriorStore&&) noexcept;
  PriorStore& operator=(PriorStore&&) noexcept;

  const std::filesystem::path& directory() const;
  const PriorManifest& manifest() const;
  const TileIndex& index() const;                                  ///< sorted by key
  auto tiles() const { return index().entries(); }
  std::filesystem::path tile_file(TileKey key) const;
  std::vector<TileKey> tiles_within(const Bounds2& bounds) const;   ///< existing tiles that touch the bounds
  /// @throws IoError, FormatError when the prior has no such tile, its file is unreadable or, with `verify_hash`, its sha256 differs
  /// from the index.
  PriorTile load(TileKey key, bool verify_hash = true) const;
  /// The same block by block, verified, for tiles of any size. Columns and origin as in `load`.
  void for_each_block(TileKey key, std::size_t points_a_block, const std::function<void(const PointCloud&)>& consume) const;

  std::vector<Feature> features() const;
  /// The same one after the other, for priors whose features do not fit in memory. Outlines are in the prior's CRS.
  void for_each_feature(const std::function<void(std::uint32_t index, const Feature&)>& consume) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
