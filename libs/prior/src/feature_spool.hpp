#pragma once
#include <cstdint>
#include <filesystem>
#include <memory_resource>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <priormap/geodesy/tile_grid.hpp>
#include <priormap/prior/feature.hpp>
#include <priormap/prior/prior_manifest.hpp>

#include <priormap/core/spill_file.hpp>

namespace priormap {

/// Features collected in any order: names in memory, everything else in a spill file. Thread-safe.
class FeatureSpool {
 public:
  explicit FeatureSpool(std::filesystem::path folder) : spill_(std::move(folder), buffer_bytes) {}

  /// The feature's number here. Of two that share source and id one remains, whatever the order: the smaller in its bytes.
  std::uint32_t add(const Feature& feature);
  bool empty() const {
    const std::lock_guard lock(mutex_);
    return items_.empty();
  }
  /// Only features that own a point are written.
  void mark_used(std::span<const std::uint32_t> numbers);

  struct Written {
    std::vector<std::uint32_t> index_of_number;   ///< position in the file, in order of (source, id)
    std::uint64_t count = 0;
    std::string crs, operation;   ///< as PriorManifest's
    std::string sha256;
  };
  /// Writes features.geojsonl. @param prior  its CRS and sources. @param extent  in that CRS. @throws IoError
  Written write(const std::filesystem::path& file, const PriorManifest& prior, const Bounds2& extent, int threads) const;

 private:
  struct Item {
    SpillFile::Piece piece;
    bool used = false;
  };
  std::string_view kept(const std::string& name);

  static constexpr std::size_t buffer_bytes = std::size_t(8) << 20;
  mutable std::mutex mutex_;
  SpillFile spill_;
  std::vector<Item> items_;
  std::pmr::monotonic_buffer_resource memory_;   ///< for millions of names, none of which goes before the end
  std::pmr::unordered_map<std::string_view, std::uint32_t> number_of_name_{&memory_};   ///< source, a zero, id
};

}  // namespace priormap
