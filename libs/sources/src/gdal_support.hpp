#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <priormap/geodesy/crs.hpp>

class GDALDataset;
class OGRSpatialReference;

namespace priormap {

/// All drivers, once; a block cache of bounded size.
void register_gdal();

/// What the block cache is to hold of one raster, as long as this lives: it grows, within bounds, so that rasters that are read in turn do not drive out each other's
/// blocks, which would be decoded again. The user's GDAL_CACHEMAX has the last word.
class CacheNeed {
 public:
  CacheNeed() = default;
  ~CacheNeed();
  CacheNeed(const CacheNeed&) = delete;
  CacheNeed& operator=(const CacheNeed&) = delete;
  /// For one thread at a time.
  void grow_to(std::int64_t bytes);

 private:
  std::int64_t bytes_ = 0;
};

/// GDAL prints nothing in this thread while this lives.
class QuietGdal {
 public:
  QuietGdal();
  ~QuietGdal();
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
  /// What GDAL last complained of, on one line.
  static std::string message();
};

/// Opens a file to read it, or what lies in a zip archive (town.zip, N43E007.hgt.zip), or a /vsi... path. Never null; whoever gets it closes it. Within a QuietGdal.
/// @param flags  GDAL_OF_RASTER or GDAL_OF_VECTOR. @param what  "raster" or "vector file", for the message
/// @throws IoError: no such file; FormatError: GDAL reads no such thing there
GDALDataset* open_gdal(const std::filesystem::path& file, unsigned int flags, const std::string& what);

/// nullopt for none, or a local engineering system.
std::optional<Crs> crs_of(const OGRSpatialReference* reference);

}  // namespace priormap
