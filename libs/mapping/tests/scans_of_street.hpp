#pragma once
#include <functional>
#include <utility>

#include <priormap/mapping/scan_source.hpp>

#include "street.hpp"

namespace priormap::test {

/// What a laser sees that is driven along the x axis of a street: ten scans a second, each from one place.
class ScansOfStreet : public ScanSource {
 public:
  ScansOfStreet(street::World world, const street::Laser& laser, std::size_t size, std::function<double(double t_s)> way_m)
      : world_(std::move(world)), laser_(laser), size_(size), way_m_(std::move(way_m)) {}
  Eigen::Isometry3d pose(std::size_t index) const { return street::pose(way_m_(stamp_s(index)), 0.3, 1.7, 0); }
  std::size_t size() const override { return size_; }
  Scan read(std::size_t index) const override {
    Scan scan;
    scan.index = index;
    scan.stamp_s = stamp_s(index);
    scan.points = street::scan(world_, pose(index), laser_, static_cast<unsigned>(index));
    return scan;
  }
  double stamp_s(std::size_t index) const override { return 0.1 * static_cast<double>(index); }
  std::filesystem::path file(std::size_t) const override { return {}; }
  const ScanSourceInfo& info() const override { return info_; }

 private:
  street::World world_;
  street::Laser laser_;
  std::size_t size_;
  std::function<double(double)> way_m_;
  ScanSourceInfo info_;
};

}  // namespace priormap::test
