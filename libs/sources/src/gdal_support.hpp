#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <priormap/geodesy/crs.hpp>

class OGRSpatialReference;

namespace priormap {

/// All drivers, once; a block cache of bounded size.
void register_gdal();

/// Lets the block cache grow to this size, within bounds. The user's GDAL_CACHEMAX has the last word.
void hold_in_cache(std::int64_t bytes);

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

/// nullopt for none, or a local engineering system.
std::optional<Crs> crs_of(const OGRSpatialReference* reference);

}  // namespace priormap
