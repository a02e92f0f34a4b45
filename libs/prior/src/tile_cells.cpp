#include "tile_cells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <priormap/core/atomic_output.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/core/output_file.hpp>

#include "lattice.hpp"

namespace priormap {

struct TileCells::Head {
  char magic[8];
  std::uint32_t version;
  std::uint32_t cells_along_tile;
  Digest tile_sha256;
  double voxel_m, horizontal_unit_m, vertical_unit_m;
};

struct TileCells::Row {
  std::uint32_t num_patches, num_points;
  std::uint64_t offset;       // of the patches in the file; the points follow
  Digest patches_sha256, points_sha256;
};

namespace {

static_assert(std::endian::native == std::endian::little, "lookup files are little-endian");

constexpr char magic[8] = {'P', 'R', 'I', 'O', 'R', 'C', 'E', 'L'};
constexpr std::uint32_t format_version = 4;

struct PointRow {
  std::uint16_t x, y;   // lattice steps from the corner of the cell
  std::int32_t z;       // lattice steps from the base of the tile
};
static_assert(sizeof(PointRow) == 8);

struct PatchRow {
  float mean[3];
  float covariance[6];
  float sigma_m;
  std::int16_t normal[3];   // 1/32767
  std::uint16_t count;
  std::uint32_t feature;
};
static_assert(sizeof(PatchRow) == 52);

constexpr std::size_t points_a_block = std::size_t(1) << 16;

Digest digest_of(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.update(bytes);
  return digest_from_hex(hash.hex_digest());
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(T));
}

template <class T>
T read_at(std::span<const std::byte> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

void append_points(std::vector<std::byte>& bytes, const PointCloud& points) {
  for (const Eigen::Vector3f& p : points.xyz) {
    const auto steps = [](float v) { return std::lround(1000.0 * double(v)); };
    append(bytes, PointRow{std::uint16_t(steps(p.x())), std::uint16_t(steps(p.y())), std::int32_t(steps(p.z()))});
  }
}

void append_patches(std::vector<std::byte>& bytes, const PatchCloud& cloud) {
  for (const SurfacePatch& patch : cloud.patches) {
    PatchRow row{};
    std::copy_n(patch.mean.data(), 3, row.mean);
    std::copy_n(patch.covariance.data(), 6, row.covariance);
    row.sigma_m = patch.sigma_m;
    for (int a = 0; a < 3; ++a) row.normal[a] = std::int16_t(std::lround(32767.0f * patch.normal[a]));
    row.count = std::uint16_t(std::min(patch.count, 65535.0f));
    row.feature = patch.feature;
    append(bytes, row);
  }
}

SurfacePatch patch_from(const PatchRow& row) {
  SurfacePatch patch;
  std::copy_n(row.mean, 3, patch.mean.data());
  std::copy_n(row.covariance, 6, patch.covariance.data());
  patch.normal = Eigen::Vector3f(row.normal[0], row.normal[1], row.normal[2]).normalized();
  patch.sigma_m = row.sigma_m;
  patch.count = row.count;
  patch.feature = row.feature;
  return patch;
}

}  // namespace

TileCells::TileCells(const std::filesystem::path& file, const PriorStore& store, const TileEntry& tile, const CellGrid& grid)
    : name_(file), grid_(grid), base_z_(std::int32_t(std::floor(double(tile.min_z)))) {
  const LatticeGrid lattice(store.manifest().tile_size);
  corner_x_ = lattice.origin(tile.key.x);
  corner_y_ = lattice.origin(tile.key.y);
}

TileCells::Head TileCells::head_of(const TileEntry& tile, const CellGrid& grid, const PriorUnits& units) {
  Head head{{}, format_version, std::uint32_t(grid.cells_along_tile()), digest_from_hex(tile.sha256), lookup_voxel_m, units.horizontal_m, units.vertical_m};
  std::memcpy(head.magic, magic, sizeof(magic));
  return head;
}

/// Points come in order of x, so only one column of cells is held at a time.
TileCells::TileCells(const PriorStore& store, const TileEntry& tile, const CellGrid& grid, const PriorUnits& units)
    : TileCells(store.tile_file(tile.key), store, tile, grid) {
  const Head head = head_of(tile, grid, units);
  static_assert(sizeof(Head) == 72 && sizeof(Row) == 80);
  made_.resize(end_of_rows() + sizeof(Digest));
  std::memcpy(made_.data(), &head, sizeof(Head));

  const std::int64_t tile_steps = LatticeGrid(store.manifest().tile_size).tile_steps();
  const auto rows = std::size_t(grid.cells_along_tile());
  std::vector<PointCloud> column(rows);
  std::int64_t i = 0;
  const auto end_columns_before = [&](std::int64_t next) {
    for (; i < next; ++i)
      for (std::size_t j = 0; j < rows; ++j) add_cell(int(std::size_t(i) * rows + j), std::exchange(column[j], {}), units);
  };
  store.for_each_block(tile.key, points_a_block, [&](const PointCloud& block) {
    for (std::size_t k = 0; k < block.size(); ++k) {
      const std::int64_t x = to_lattice(double(block.xyz[k].x())), y = to_lattice(double(block.xyz[k].y()));
      if (std::min(x, y) < 0 || std::max(x, y) >= tile_steps) throw FormatError(name_, "holds a point outside the tile; make the prior again");
      if (x / grid.edge() < i) throw FormatError(name_, "is not sorted by x; make the prior again");
      end_columns_before(x / grid.edge());
      PointCloud& cell = column[std::size_t(y / grid.edge())];
      cell.xyz.push_back({float(double(x % grid.edge()) / 1000.0), float(double(y % grid.edge()) / 1000.0), block.xyz[k].z()});
      cell.normal.push_back(block.normal[k]);
      cell.sigma_m.push_back(block.sigma_m[k]);
      cell.classification.push_back(block.classification[k]);
      cell.feature.push_back(block.feature[k]);
    }
  });
  end_columns_before(std::int64_t(rows));
  const Digest digest = digest_of(bytes().first(end_of_rows()));
  std::memcpy(made_.data() + end_of_rows(), digest.data(), sizeof(Digest));
  made_.shrink_to_fit();
}

void TileCells::add_cell(int number, PointCloud points, const PriorUnits& units) {
  Row row{};
  row.offset = made_.size();
  row.num_points = std::uint32_t(points.size());
  points.origin = corner(number);
  std::vector<std::byte> point_rows;
  append_points(point_rows, points);
  const PatchCloud patches = patches_of_cell(std::move(points), units);
  row.num_patches = std::uint32_t(patches.size());
  append_patches(made_, patches);
  made_.insert(made_.end(), point_rows.begin(), point_rows.end());
  row.patches_sha256 = digest_of(patch_bytes(row));
  row.points_sha256 = digest_of(point_bytes(row));
  std::memcpy(made_.data() + sizeof(Head) + std::size_t(number) * sizeof(Row), &row, sizeof(Row));
}

std::shared_ptr<const TileCells> TileCells::open(const std::filesystem::path& file, const PriorStore& store, const TileEntry& tile, const CellGrid& grid,
                                                 const PriorUnits& units) {
  std::error_code error;
  if (std::filesystem::file_size(store.tile_file(tile.key), error) != tile.num_bytes) return nullptr;   // making it anew says what is wrong
  std::shared_ptr<TileCells> cells(new TileCells(file, store, tile, grid));
  try {
    cells->mapped_.emplace(file);
  } catch (const IoError&) {
    return nullptr;
  }
  return cells->is_sound(head_of(tile, grid, units)) ? cells : nullptr;
}

bool TileCells::is_sound(const Head& expected) const {
  const std::span<const std::byte> all = bytes();
  if (all.size() < end_of_rows() + sizeof(Digest) || std::memcmp(all.data(), &expected, sizeof(Head)) != 0) return false;
  if (digest_of(all.first(end_of_rows())) != read_at<Digest>(all, end_of_rows())) return false;
  std::uint64_t next = end_of_rows() + sizeof(Digest);
  for (int number = 0; number < grid_.cells_a_tile(); ++number) {
    const Row r = row(number);
    if (r.offset != next) return false;
    next += r.num_patches * sizeof(PatchRow) + r.num_points * sizeof(PointRow);
  }
  return next == all.size();
}

void TileCells::write(const std::filesystem::path& file) const {
  AtomicFile target(file, Overwrite::allow);
  OutputFile out(target.temporary_path());
  out.write(reinterpret_cast<const char*>(bytes().data()), std::streamsize(bytes().size()));
  out.close();
  target.commit();
}

TileCells::Row TileCells::row(int number) const { return read_at<Row>(bytes(), sizeof(Head) + std::size_t(number) * sizeof(Row)); }

std::size_t TileCells::end_of_rows() const { return sizeof(Head) + std::size_t(grid_.cells_a_tile()) * sizeof(Row); }

Eigen::Vector3d TileCells::corner(int number) const {
  return {double(corner_x_ + grid_.corner_x(number)) / 1000.0, double(corner_y_ + grid_.corner_y(number)) / 1000.0, double(base_z_)};
}

std::span<const std::byte> TileCells::patch_bytes(const Row& row) const { return bytes().subspan(row.offset, row.num_patches * sizeof(PatchRow)); }

std::span<const std::byte> TileCells::point_bytes(const Row& row) const {
  return bytes().subspan(row.offset + row.num_patches * sizeof(PatchRow), row.num_points * sizeof(PointRow));
}

void TileCells::check(int number, std::span<const std::byte> part, const Digest& digest) const {
  if (digest_of(part) != digest)
    throw DamagedCell(name_, "cell " + std::to_string(number) + " does not have the sha256 its head states; delete the file, it is made again");
}

bool TileCells::is_whole() const {
  for (int number = 0; number < grid_.cells_a_tile(); ++number) {
    const Row r = row(number);
    if (digest_of(patch_bytes(r)) != r.patches_sha256 || digest_of(point_bytes(r)) != r.points_sha256) return false;
  }
  return true;
}

PatchCloud TileCells::patches(int number) const {
  const Row r = row(number);
  const auto part = patch_bytes(r);
  check(number, part, r.patches_sha256);
  PatchCloud cloud;
  cloud.origin = corner(number);
  cloud.patches.reserve(r.num_patches);
  for (std::size_t i = 0; i < r.num_patches; ++i) cloud.patches.push_back(patch_from(read_at<PatchRow>(part, i * sizeof(PatchRow))));
  return cloud;
}

PointCloud TileCells::points(int number) const {
  const Row r = row(number);
  const auto part = point_bytes(r);
  check(number, part, r.points_sha256);
  PointCloud cloud;
  cloud.origin = corner(number);
  cloud.xyz.reserve(r.num_points);
  for (std::size_t i = 0; i < r.num_points; ++i) {
    const auto p = read_at<PointRow>(part, i * sizeof(PointRow));
    cloud.xyz.push_back((Eigen::Vector3d(p.x, p.y, p.z) / 1000.0).cast<float>());
  }
  return cloud;
}

}  // namespace priormap
