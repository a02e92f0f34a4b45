#include <priormap/prior/prior_writer.hpp>

#include "prior_assembly.hpp"

namespace priormap {

struct PriorWriter::Impl {
  PriorAssembly assembly;
};

PriorWriter::PriorWriter(const std::filesystem::path& directory, PriorManifest manifest, Overwrite overwrite, std::size_t memory_bytes)
    : impl_(new Impl{{directory, std::move(manifest), overwrite, memory_bytes}}) {}
PriorWriter::~PriorWriter() = default;

void PriorWriter::add(const PointCloud& points) { impl_->assembly.add(points); }
void PriorWriter::add(LatticePoint corner, std::span<LasPoint> points) { impl_->assembly.add(corner, points); }
std::uint32_t PriorWriter::add_feature(const Feature& feature) { return impl_->assembly.add_feature(feature); }
void PriorWriter::close_tile(TileKey key) { impl_->assembly.close_tile(key); }
void PriorWriter::set_sources(std::vector<PriorSource> sources) { impl_->assembly.set_sources(std::move(sources)); }
PriorManifest PriorWriter::finish(int threads, const Events& events) { return impl_->assembly.finish(threads, events); }

}  // namespace priormap
