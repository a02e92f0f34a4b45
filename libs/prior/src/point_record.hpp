#pragma once
#include <tuple>

#include <priormap/pointcloud/las.hpp>

namespace priormap {

/// One point of a tile on the lattice, 32 bytes: what is spilled, sorted and written. x and y count from the tile's lower-left corner
/// [0.001 CRS units], z is the height [0.001 units of the vertical CRS].
using PointRecord = LasPoint;

/// While tiles are collected: the point belongs to a neighbouring tile and is here as a witness only.
inline bool is_halo(const PointRecord& p) { return p.user_data != 0; }
inline void mark_halo(PointRecord& p) { p.user_data = 1; }

/// The order of points in a tile. Total: equal means equal in every column.
inline auto sort_key(const PointRecord& p) {
  return std::make_tuple(p.x, p.y, p.z, p.source, p.feature, p.classification, p.normal[0], p.normal[1], p.normal[2], p.sigma_mm,
                         p.intensity, p.user_data);
}
inline bool operator<(const PointRecord& a, const PointRecord& b) { return sort_key(a) < sort_key(b); }

/// Two samples of one feature of one source at one place are one point.
inline bool same_point(const PointRecord& a, const PointRecord& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.source == b.source && a.feature == b.feature;
}

}  // namespace priormap
