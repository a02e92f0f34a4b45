#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <priormap/core/state_archive.hpp>
#include <vector>

namespace priormap {

/// Flat hash (open addressing, linear probing) from integer voxel coordinates to the numbers 0, 1, 2 ... in order of addition.
class VoxelIndex {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  VoxelIndex() : slots_(64, none) {}

  std::uint32_t find(const Eigen::Vector3i& key) const { return slots_[slot_of(key)]; }
  /// The number of `key`, which gets the next one, size() before the call, if it has none yet.
  std::uint32_t find_or_add(const Eigen::Vector3i& key) {
    const std::size_t slot = slot_of(key);
    if (slots_[slot] != none) return slots_[slot];
    const auto number = std::uint32_t(keys_.size());
    slots_[slot] = number;
    keys_.push_back(key);
    if (2 * keys_.size() > slots_.size()) place(2 * slots_.size());
    return number;
  }
  /// Keeps the keys whose number `keep` names (ascending) and numbers them anew from 0.
  void retain(const std::vector<std::uint32_t>& keep) {
    for (std::size_t i = 0; i < keep.size(); ++i) keys_[i] = keys_[keep[i]];
    keys_.resize(keep.size());
    place(slots_.size());
  }

  void exchange(StateArchive& archive) {
    archive(keys_);
    if (!archive.reading()) return;
    std::size_t slots = 64;
    while (2 * keys_.size() > slots) slots *= 2;
    place(slots);
  }

  const std::vector<Eigen::Vector3i>& keys() const { return keys_; }
  const std::vector<std::uint32_t>& slots() const { return slots_; }
  std::size_t size() const { return keys_.size(); }
  const Eigen::Vector3i& key(std::size_t number) const { return keys_[number]; }

 private:
  static std::size_t hash_of(const Eigen::Vector3i& key) {
    std::uint64_t h = std::uint64_t(std::uint32_t(key.x())) * 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 32) ^ std::uint32_t(key.y())) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 29) ^ std::uint32_t(key.z())) * 0x94d049bb133111ebu;
    return h ^ (h >> 31);
  }
  std::size_t slot_of(const Eigen::Vector3i& key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(key) & mask;
    while (slots_[slot] != none && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
    return slot;
  }
  void place(std::size_t slots) {
    slots_.assign(slots, none);
    for (std::uint32_t i = 0; i < keys_.size(); ++i) slots_[slot_of(keys_[i])] = i;
  }

  std::vector<Eigen::Vector3i> keys_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace priormap
