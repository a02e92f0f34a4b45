#include <priormap/prior/tile_index.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/core/output_file.hpp>

#include "hex.hpp"
#include "mapped_file.hpp"

namespace priormap {
namespace {

static_assert(std::endian::native == std::endian::little, "tiles.idx is little-endian");

constexpr char magic[8] = {'P', 'R', 'I', 'O', 'R', 'I', 'D', 'X'};
constexpr std::uint32_t format_version = 1;
constexpr std::size_t rows_per_page = 1024;

struct Head {
  char magic[8];
  std::uint32_t version;
  std::uint32_t rows_per_page;
  std::uint64_t num_rows;
  std::uint64_t num_pages;
};
static_assert(sizeof(Head) == 32);

struct Row {
  std::int32_t x, y;
  std::uint64_t num_points;
  float min_z, max_z;
  std::uint64_t num_bytes;
  Digest sha256;
};
static_assert(sizeof(Row) == 64);

std::size_t page_count(std::size_t rows) { return (rows + rows_per_page - 1) / rows_per_page; }
std::size_t head_bytes(std::size_t pages) { return sizeof(Head) + pages * sizeof(Digest); }

std::string sha256_of(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.hex_digest();
}

}  // namespace

struct TileIndex::Impl {
  std::filesystem::path file;
  MappedFile mapped;
  std::size_t num_rows = 0;
  const Row* rows = nullptr;
  const Digest* page_digests = nullptr;
  mutable std::vector<std::atomic<bool>> page_is_checked;

  Impl(const std::filesystem::path& path, const std::string& head_sha256) : file(path), mapped(path) {
    const std::span<const std::byte> bytes = mapped.bytes();
    Head head{};
    if (bytes.size() < sizeof(Head)) throw FormatError(file, "is cut short, or is no tile index; make the prior again");
    std::memcpy(&head, bytes.data(), sizeof(Head));
    if (std::memcmp(head.magic, magic, sizeof(magic)) != 0) throw FormatError(file, "is no tile index; make the prior again");
    if (head.version != format_version)
      throw FormatError(file, "is a tile index of version " + std::to_string(head.version) + ", this program knows version " +
                                  std::to_string(format_version));
    const bool head_agrees = head.rows_per_page == rows_per_page && head.num_rows <= bytes.size() / sizeof(Row) &&
                             head.num_pages == page_count(head.num_rows);
    if (!head_agrees || bytes.size() != head_bytes(head.num_pages) + head.num_rows * sizeof(Row))
      throw FormatError(file, "is cut short or damaged (" + std::to_string(bytes.size()) + " bytes for " +
                                  std::to_string(head.num_rows) + " tiles); make the prior again");
    if (sha256_of(bytes.first(head_bytes(head.num_pages))) != head_sha256)
      throw FormatError(file, "does not have the sha256 that prior.json states; make the prior again");
    num_rows = head.num_rows;
    page_digests = reinterpret_cast<const Digest*>(bytes.data() + sizeof(Head));
    rows = reinterpret_cast<const Row*>(bytes.data() + head_bytes(head.num_pages));
    page_is_checked = std::vector<std::atomic<bool>>(head.num_pages);
  }

  const Row& row(std::size_t i) const {
    const std::size_t page = i / rows_per_page;
    if (!page_is_checked[page].load(std::memory_order_acquire)) check(page);
    return rows[i];
  }

  void check(std::size_t page) const {
    const std::size_t first = page * rows_per_page;
    const auto bytes = std::as_bytes(std::span(rows + first, std::min(rows_per_page, num_rows - first)));
    if (sha256_of(bytes) != to_hex(page_digests[page]))
      throw FormatError(file, "page " + std::to_string(page) + " does not have the sha256 its head states; make the prior again");
    page_is_checked[page].store(true, std::memory_order_release);
  }

  TileKey key(std::size_t i) const { return {row(i).x, row(i).y}; }

  /// First row not before `key`.
  std::size_t lower_bound(TileKey key) const {
    const auto range = std::views::iota(std::size_t(0), num_rows);
    return std::size_t(std::ranges::lower_bound(range, key, {}, [this](std::size_t i) { return this->key(i); }) - range.begin());
  }
};

TileIndex::TileIndex(const std::filesystem::path& file, const std::string& head_sha256)
    : impl_(std::make_unique<Impl>(file, head_sha256)) {}
TileIndex::~TileIndex() = default;
TileIndex::TileIndex(TileIndex&&) noexcept = default;
TileIndex& TileIndex::operator=(TileIndex&&) noexcept = default;

std::size_t TileIndex::size() const { return impl_->num_rows; }

TileEntry TileIndex::entry(std::size_t i) const {
  const Row& row = impl_->row(i);
  return {{row.x, row.y}, row.num_points, row.min_z, row.max_z, row.num_bytes, to_hex(row.sha256)};
}

std::optional<TileEntry> TileIndex::find(TileKey key) const {
  const std::size_t i = impl_->lower_bound(key);
  if (i == size() || impl_->key(i) != key) return std::nullopt;
  return entry(i);
}

std::vector<TileKey> TileIndex::keys_within(TileKey low, TileKey high) const {
  std::vector<TileKey> keys;
  if (low.x > high.x || low.y > high.y) return keys;
  for (std::size_t i = impl_->lower_bound(low); i < size();) {
    const TileKey key = impl_->key(i);
    if (key.x > high.x) break;
    if (key.y < low.y) {
      i = impl_->lower_bound({key.x, low.y});
    } else if (key.y > high.y) {
      if (key.x == high.x) break;
      i = impl_->lower_bound({key.x + 1, low.y});
    } else {
      keys.push_back(key);
      ++i;
    }
  }
  return keys;
}

TileIndexDigest write_tile_index(const std::filesystem::path& file, std::span<const TileEntry> entries) {
  std::vector<Row> rows;
  rows.reserve(entries.size());
  for (const TileEntry& e : entries)
    rows.push_back({e.key.x, e.key.y, e.num_points, e.min_z, e.max_z, e.num_bytes, digest_from_hex(e.sha256)});

  Head head{{}, format_version, rows_per_page, rows.size(), page_count(rows.size())};
  std::memcpy(head.magic, magic, sizeof(magic));
  std::vector<std::byte> head_and_digests(head_bytes(head.num_pages));
  std::memcpy(head_and_digests.data(), &head, sizeof(head));
  for (std::size_t page = 0; page < head.num_pages; ++page) {
    const std::size_t first = page * rows_per_page;
    const auto bytes = std::as_bytes(std::span(rows).subspan(first, std::min(rows_per_page, rows.size() - first)));
    const Digest digest = digest_from_hex(sha256_of(bytes));
    std::memcpy(head_and_digests.data() + sizeof(Head) + page * sizeof(Digest), digest.data(), sizeof(Digest));
  }

  const std::span<const std::byte> row_bytes = std::as_bytes(std::span(rows));
  OutputFile out(file);
  Sha256 whole;
  for (const std::span<const std::byte> part : {std::span<const std::byte>(head_and_digests), row_bytes}) {
    out.write(reinterpret_cast<const char*>(part.data()), std::streamsize(part.size()));
    whole.update(part);
  }
  out.close();
  return {whole.hex_digest(), sha256_of(head_and_digests)};
}

}  // namespace priormap
