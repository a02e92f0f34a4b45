#include "gdal_support.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <utility>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

/// GDAL would take 5 % of the machine's memory; and new memory costs more than what is done with it.
constexpr std::int64_t gdal_cache_bytes = 16 << 20, most_for_several_bytes = 64 << 20, most_gdal_cache_bytes = 512 << 20;

/// Of the rasters that are open: they share one cache.
struct AllNeeds {
  std::mutex mutex;
  std::int64_t bytes = 0;
} all_needs;

bool user_sets_cache() { return CPLGetConfigOption("GDAL_CACHEMAX", nullptr) != nullptr; }

}  // namespace

void register_gdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    if (!user_sets_cache()) GDALSetCacheMax64(gdal_cache_bytes);
  });
}

CacheNeed::~CacheNeed() {
  const std::lock_guard lock(all_needs.mutex);
  all_needs.bytes -= bytes_;
}

void CacheNeed::grow_to(std::int64_t bytes) {
  if (bytes <= bytes_) return;
  const std::lock_guard lock(all_needs.mutex);
  all_needs.bytes += bytes - std::exchange(bytes_, bytes);
  // Not all of a mosaic's tiles are read side by side.
  const std::int64_t wanted = std::min(std::max(bytes, std::min(all_needs.bytes, most_for_several_bytes)), most_gdal_cache_bytes);
  if (wanted > GDALGetCacheMax64() && !user_sets_cache()) GDALSetCacheMax64(wanted);
}

GDALDataset* open_gdal(const std::filesystem::path& file, unsigned int flags, const std::string& what) {
  const std::string name = file.string();
  if (auto* dataset = GDALDataset::Open(name.c_str(), flags | GDAL_OF_READONLY)) return dataset;
  const std::string cause = QuietGdal::message();
  if (file.extension() == ".zip")
    if (auto* dataset = GDALDataset::Open(("/vsizip/" + name).c_str(), flags | GDAL_OF_READONLY)) return dataset;
  std::error_code error;
  const bool is_plain_path = !name.starts_with("/vsi") && name.find(':') == std::string::npos;
  if (is_plain_path && !std::filesystem::exists(file, error)) throw IoError(file, "does not exist");
  throw FormatError(file, "is no " + what + " that GDAL reads" + (cause.empty() ? "" : " (" + cause + ")"));
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
