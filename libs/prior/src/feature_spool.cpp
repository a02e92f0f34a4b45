#include "feature_spool.hpp"

#include <algorithm>
#include <cstring>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/core/output_file.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/pointcloud/point_cloud.hpp>

#include "feature_lines.hpp"
#include "lattice.hpp"

namespace priormap {
namespace {

class ByteWriter {
 public:
  template <class T>
  void put(T value) {
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), first, first + sizeof(T));
  }
  void put(const std::string& text) {
    put(std::uint32_t(text.size()));
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    bytes_.insert(bytes_.end(), first, first + text.size());
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  T get() {
    T value;
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }
  std::string text() {
    const auto size = get<std::uint32_t>();
    std::string value(reinterpret_cast<const char*>(bytes_.data()), size);
    bytes_ = bytes_.subspan(size);
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
};

std::vector<std::byte> pack(const Feature& feature) {
  ByteWriter out;
  out.put(feature.source);
  out.put(feature.id);
  out.put(feature.height_m);
  out.put(feature.height_rule);
  out.put(feature.ground_z);
  out.put(feature.sigma_m);
  out.put(std::uint32_t(feature.outline.size()));
  for (const auto& polygon : feature.outline) {
    out.put(std::uint32_t(polygon.size()));
    for (const auto& ring : polygon) {
      out.put(std::uint32_t(ring.size()));
      for (const Eigen::Vector2d& p : ring) {
        out.put(to_lattice(p.x()));
        out.put(to_lattice(p.y()));
      }
    }
  }
  return out.take();
}

Feature unpack(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  Feature feature;
  feature.source = in.text();
  feature.id = in.text();
  feature.height_m = in.get<double>();
  feature.height_rule = in.text();
  feature.ground_z = in.get<double>();
  feature.sigma_m = in.get<double>();
  feature.outline.resize(in.get<std::uint32_t>());
  for (auto& polygon : feature.outline) {
    polygon.resize(in.get<std::uint32_t>());
    for (auto& ring : polygon) {
      ring.resize(in.get<std::uint32_t>());
      for (Eigen::Vector2d& p : ring) {
        p.x() = double(in.get<std::int64_t>()) / 1000.0;
        p.y() = double(in.get<std::int64_t>()) / 1000.0;
      }
    }
  }
  return feature;
}

}  // namespace

std::vector<std::byte> FeatureSpool::bytes_of(const Item& item) const {
  std::vector<std::byte> bytes(item.piece.size);
  spill_.read(item.piece, bytes.data());
  return bytes;
}

Feature FeatureSpool::feature(std::uint32_t number) const { return unpack(bytes_of(items_[number])); }

std::uint32_t FeatureSpool::add(const Feature& feature) {
  const std::vector<std::byte> bytes = pack(feature);
  const std::lock_guard lock(mutex_);
  if (items_.size() == PointCloud::no_feature) throw Error("a prior holds at most 4294967295 features; write several priors");
  const auto [found, is_new] = number_of_name_.try_emplace(feature.source + '\0' + feature.id, std::uint32_t(items_.size()));
  if (is_new) {
    items_.push_back({spill_.append(bytes)});
  } else if (Item& item = items_[found->second]; bytes < bytes_of(item)) {
    item.piece = spill_.append(bytes);
  }
  return found->second;
}

void FeatureSpool::mark_used(std::span<const std::uint32_t> numbers) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t number : numbers) {
    if (number >= items_.size()) throw Error("a point names feature " + std::to_string(number) + ", which the prior does not hold");
    items_[number].used = true;
  }
}

FeatureSpool::Written FeatureSpool::write(const std::filesystem::path& file, const std::string& prior_crs, int threads) const {
  std::vector<std::pair<std::string_view, std::uint32_t>> order;
  for (const auto& [name, number] : number_of_name_)
    if (items_[number].used) order.emplace_back(name, number);
  std::sort(order.begin(), order.end());

  Written written;
  written.index_of_number.assign(items_.size(), PointCloud::no_feature);
  for (std::size_t i = 0; i < order.size(); ++i) written.index_of_number[order[i].second] = std::uint32_t(i);
  written.count = order.size();

  const OutlineFrame frame = OutlineFrame::for_prior(prior_crs);
  written.crs = frame.file_crs();
  OutputFile out(file);
  Sha256 hash;
  constexpr std::size_t chunk_size = 2000;
  const std::size_t num_chunks = (order.size() + chunk_size - 1) / chunk_size;
  std::vector<std::string> chunks(num_chunks);
  ordered_pipeline(
      num_chunks, threads, std::size_t(threads) * 2,
      [&](std::size_t chunk) {
        const OutlineFrame own_frame = frame;
        for (std::size_t i = chunk * chunk_size; i < std::min(order.size(), (chunk + 1) * chunk_size); ++i)
          chunks[chunk] += feature_line(feature(order[i].second), std::uint32_t(i), own_frame);
      },
      [&](std::size_t chunk) {
        out << chunks[chunk];
        hash.update(chunks[chunk]);
        std::string().swap(chunks[chunk]);
      });
  out.close();
  written.sha256 = hash.hex_digest();
  return written;
}

}  // namespace priormap
