#include "feature_spool.hpp"

#include <algorithm>

#include <priormap/core/error.hpp>
#include <priormap/core/hash.hpp>
#include <priormap/core/output_file.hpp>
#include <priormap/core/packed_bytes.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/pointcloud/point_cloud.hpp>

#include "feature_lines.hpp"
#include "lattice.hpp"

namespace priormap {
namespace {

void pack(const Feature& feature, ByteWriter& out) {
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

std::string_view FeatureSpool::kept(const std::string& name) {
  auto* text = static_cast<char*>(memory_.allocate(name.size(), 1));
  std::ranges::copy(name, text);
  return {text, name.size()};
}

std::uint32_t FeatureSpool::add(const Feature& feature) {
  ByteWriter packed;
  pack(feature, packed);
  const std::span<const std::byte> bytes = packed.bytes();
  const std::lock_guard lock(mutex_);
  if (items_.size() == PointCloud::no_feature) throw Error("a prior holds at most 4294967295 features; write several priors");
  const std::string name = feature.source + '\0' + feature.id;
  if (const auto found = number_of_name_.find(name); found != number_of_name_.end()) {
    Item& item = items_[found->second];
    if (std::ranges::lexicographical_compare(bytes, spill_.read(item.piece))) item.piece = spill_.append(bytes);
    return found->second;
  }
  const auto number = std::uint32_t(items_.size());
  number_of_name_.emplace(kept(name), number);
  items_.push_back({spill_.append(bytes)});
  return number;
}

void FeatureSpool::mark_used(std::span<const std::uint32_t> numbers) {
  if (numbers.empty()) return;
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t number : numbers) {
    if (number >= items_.size()) throw Error("a point names feature " + std::to_string(number) + ", which the prior does not hold");
    items_[number].used = true;
  }
}

FeatureSpool::Written FeatureSpool::write(const std::filesystem::path& file, const PriorManifest& prior, const Bounds2& extent, int threads) const {
  std::vector<std::pair<std::string_view, std::uint32_t>> order;
  for (const auto& [name, number] : number_of_name_)
    if (items_[number].used) order.emplace_back(name, number);
  std::sort(order.begin(), order.end());

  Written written;
  written.index_of_number.assign(items_.size(), PointCloud::no_feature);
  for (std::size_t i = 0; i < order.size(); ++i) written.index_of_number[order[i].second] = std::uint32_t(i);
  written.count = order.size();

  const OutlineFrame frame = OutlineFrame::for_prior(prior, extent);
  written.crs = frame.file_crs();
  written.operation = frame.operation();
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
          chunks[chunk] += feature_line(unpack(spill_.read(items_[order[i].second].piece)), std::uint32_t(i), own_frame);
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
