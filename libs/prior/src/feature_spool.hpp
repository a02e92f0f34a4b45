#pragma once
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <priormap/prior/feature.hpp>

#include "spill_file.hpp"

namespace priormap {

/// Features collected in any order: names in memory, everything else in a spill file. Thread-safe.
class FeatureSpool {
 public:
  explicit FeatureSpool(std::filesystem::path folder) : spill_(std::move(folder)) {}

  /// The feature's number here. Of two that share source and id one remains, whatever the order: the smaller in its bytes.
  std::uint32_t add(const Feature& feature);
  /// Only features that own a point are written.
  void mark_used(std::span<const std::uint32_t> numbers);

  struct Written {
    std::vector<std::uint32_t> index_of_number;   ///< position in the file, in order of (source, id)
    std::uint64_t count = 0;
    std::string crs;
    std::string sha256;
  };
  /// Writes features.geojsonl. @throws IoError
  Written write(const std::filesystem::path& file, const std::string& prior_crs, int threads) const;

 private:
  struct Item {
    SpillFile::Piece piece;
    bool used = false;
  };
  std::vector<std::byte> bytes_of(const Item& item) const;
  Feature feature(std::uint32_t number) const;

  mutable std::mutex mutex_;
  SpillFile spill_;
  std::vector<Item> items_;
  std::unordered_map<std::string, std::uint32_t> number_of_name_;   ///< source, a zero, id
};

}  // namespace priormap
