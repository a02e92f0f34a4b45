#include "gdal_support.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cstdint>
#include <mutex>

namespace priormap {
namespace {

/// GDAL would take 5 % of the machine's memory.
constexpr std::int64_t gdal_cache_bytes = 128 << 20;

}  // namespace

void register_gdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    if (!CPLGetConfigOption("GDAL_CACHEMAX", nullptr)) GDALSetCacheMax64(gdal_cache_bytes);
  });
}

QuietGdal::QuietGdal() {
  CPLPushErrorHandler(CPLQuietErrorHandler);
  CPLErrorReset();
}

QuietGdal::~QuietGdal() { CPLPopErrorHandler(); }

std::string QuietGdal::message() {
  std::string text = CPLGetLastErrorMsg();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::optional<Crs> crs_of(const OGRSpatialReference* reference) {
  if (!reference || reference->IsLocal()) return std::nullopt;
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  const bool exported = reference->exportToWkt(&text, options) == OGRERR_NONE;
  const std::string wkt = exported ? text : "";
  CPLFree(text);
  if (wkt.empty()) return std::nullopt;
  return Crs::parse(wkt);
}

}  // namespace priormap
