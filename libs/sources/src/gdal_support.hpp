#pragma once
#include <memory>
#include <optional>
#include <string>

#include <priormap/geodesy/crs.hpp>

class OGRSpatialReference;

namespace priormap {

/// All drivers, once; a block cache of bounded size.
void register_gdal();

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
