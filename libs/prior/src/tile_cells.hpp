#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <priormap/prior/prior_lookup.hpp>

#include "hex.hpp"
#include "mapped_file.hpp"

namespace priormap {

/// A cell of a lookup file that is not what was written.
class DamagedCell : public FormatError {
 public:
  using FormatError::FormatError;
};

/// The cells of one tile as a lookup file holds them, in memory or mapped. The layout stands in docs/file-formats.md. Const members are thread-safe.
class TileCells {
 public:
  /// Made from the tile.
  /// @throws IoError, FormatError when the tile is unreadable or damaged
  TileCells(const PriorStore& store, const TileEntry& tile, const CellGrid& grid, const PriorUnits& units);
  /// The file, mapped; none when there is no such file to be read, or it is damaged, or was made from another tile or otherwise, or the tile itself is gone or
  /// of another size.
  static std::shared_ptr<const TileCells> open(const std::filesystem::path& file, const PriorStore& store, const TileEntry& tile, const CellGrid& grid,
                                               const PriorUnits& units);
  /// @throws IoError
  void write(const std::filesystem::path& file) const;

  /// @throws DamagedCell when the bytes do not have the digest that the head states
  PatchCloud patches(int number) const;
  PointCloud points(int number) const;
  /// Whether all cells have their digests.
  bool is_whole() const;

 private:
  struct Head;
  struct Row;
  static Head head_of(const TileEntry& tile, const CellGrid& grid, const PriorUnits& units);
  TileCells(const std::filesystem::path& file, const PriorStore& store, const TileEntry& tile, const CellGrid& grid);

  std::span<const std::byte> bytes() const { return mapped_ ? mapped_->bytes() : std::span<const std::byte>(made_); }
  bool is_sound(const Head& expected) const;
  Row row(int number) const;
  std::size_t end_of_rows() const;
  Eigen::Vector3d corner(int number) const;
  void add_cell(int number, PointCloud points, const PriorUnits& units);
  std::span<const std::byte> patch_bytes(const Row& row) const;
  std::span<const std::byte> point_bytes(const Row& row) const;
  void check(int number, std::span<const std::byte> part, const Digest& digest) const;

  std::filesystem::path name_;
  CellGrid grid_;
  std::int64_t corner_x_, corner_y_;   // lattice steps
  std::int32_t base_z_;                // whole CRS units below the lowest point
  std::vector<std::byte> made_;
  std::optional<MappedFile> mapped_;
};

}  // namespace priormap
