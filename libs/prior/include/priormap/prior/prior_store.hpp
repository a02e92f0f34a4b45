#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <priormap/pointcloud/point_cloud.hpp>
#include <priormap/prior/feature.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

struct PriorTile {
  TileKey key;
  PointCloud points;   ///< origin at the tile's lower-left corner, z origin 0 or near the ground; all columns present
};

/// Read access to a prior of any size: opens at once, loads tile by tile. Const members are thread-safe.
class PriorStore {
 public:
  /// @throws IoError, FormatError (schema, index hash)
  explicit PriorStore(const std::filesystem::path& directory);
  ~PriorStore();
  PriorStore(PriorStore&&) noexcept;

  const std::filesystem::path& directory() const;
  const PriorManifest& manifest() const;
  const std::vector<TileEntry>& tiles() const;                     ///< sorted by key
  std::vector<TileKey> tiles_within(const Bounds2& bounds) const;   ///< existing tiles that touch the bounds
  /// @throws FormatError when the file is unreadable or, with `verify_hash`, its sha256 differs from the index.
  PriorTile load(TileKey key, bool verify_hash = true) const;
  std::vector<Feature> features() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace priormap
