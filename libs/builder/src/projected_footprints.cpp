#include <priormap/builder/projected_footprints.hpp>

namespace priormap {

void pack(const ProjectedFootprint& projected, ByteWriter& out) {
  pack(projected.footprint, out);
  out.put(projected.bounds);
  out.put(static_cast<std::uint32_t>(projected.polygons.size()));
  for (const Polygon2& polygon : projected.polygons) {
    out.put(static_cast<std::uint32_t>(polygon.holes.size()));
    for_each_ring(polygon, [&](const Ring2& ring) { pack(ring, out); });
  }
}

void unpack(ByteReader& in, ProjectedFootprint& projected) {
  unpack(in, projected.footprint);
  projected.bounds = in.get<Bounds2>();
  projected.polygons.resize(in.get<std::uint32_t>());
  for (Polygon2& polygon : projected.polygons) {
    polygon.holes.resize(in.get<std::uint32_t>());
    for_each_ring(polygon, [&](Ring2& ring) { unpack(in, ring); });
  }
}

void ProjectedFootprints::put(std::size_t i, const ProjectedFootprint& projected) {
  items_.put(i, projected);
  facts_[i] = {projected.bounds, projected.footprint.kind, projected.polygons.empty()};
}

void ProjectedFootprints::sort() {
  for (std::uint32_t i = 0; i < size(); ++i)
    if (!is_empty(i)) index_.add(bounds(i), i);
  index_.sort();
}

}  // namespace priormap
