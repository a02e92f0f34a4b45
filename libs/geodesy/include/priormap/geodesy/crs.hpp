#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <priormap/geodesy/geo_point.hpp>
#include <priormap/geodesy/lon_lat_area.hpp>

namespace priormap {

/// A coordinate reference system (ISO 19111): horizontal, optionally with heights. Axis order inside priormap is
/// always east, north, up (longitude, latitude for geographic systems), angles in degrees at this boundary, lengths in the
/// unit of the CRS (see `horizontal_unit_m`). A value type; cheap to copy; safe to share between threads.
class Crs {
 public:
  /// From any of: "EPSG:25832", "EPSG:25832+7837", WKT1/WKT2, PROJJSON, PROJ strings with +type=crs or without,
  /// "urn:ogc:def:crs:EPSG::25832", "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837", "http://www.opengis.net/def/crs/EPSG/0/25832",
  /// "https://www.opengis.net/def/crs/EPSG/0/7415", "http://www.opengis.net/gml/srs/epsg.xml#25832", "urn:x-ogc:def:crs:EPSG:25832", "CRS:84",
  /// "urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH" (GeoInfoDok).
  /// Names such as "CH1903" are refused: they mean different systems to different people.
  /// @throws CrsError naming the text when it is none of these, or its axes point neither east and north nor to a pole.
  static Crs parse(const std::string& text);

  /// UTM zone (EPSG:326zz / 327zz, WGS 84; EPSG:258zz, ETRS89, where `prefer_etrs89`) of a longitude and latitude,
  /// with the exceptions of Norway and Svalbard.
  static Crs utm_zone(double lon_deg, double lat_deg, bool prefer_etrs89 = false);

  /// Transverse Mercator on the geographic base of `geographic`, in metres, without false easting or northing.
  static Crs transverse_mercator(const Crs& geographic, double lat_0_deg, double lon_0_deg, double k_0);

  /// "EPSG:25832+7837" where the CRS has such a name, else WKT2. Parses to the same CRS.
  const std::string& name() const;
  std::string human_name() const;     ///< as the authority calls it: "ETRS89 / UTM zone 32N + DHHN2016 height"
  std::string wkt1() const;           ///< WKT1-GDAL, for LAS WKT records (OGC 01-009, LAS 1.4 R15); @throws CrsError when WKT1 has no words for it
  std::string wkt2() const;           ///< WKT2:2019
  std::string proj_string() const;    ///< for display: leaves out what the PROJ.4 syntax cannot say
  bool is_geographic() const;
  bool is_projected() const;
  bool is_vertical() const;           ///< heights alone, such as EPSG:7837
  bool has_vertical() const;          ///< heights alone, a vertical part, or a third axis (ellipsoidal heights)
  double horizontal_unit_m() const;   ///< metres per unit of a projected CRS; 1 for geographic ones
  double vertical_unit_m() const;     ///< metres per unit of height; 1 where heights are undeclared
  bool heights_point_down() const;    ///< depths
  /// True where the authority's axis order is latitude/northing first, which data in GML may follow.
  bool authority_north_first() const;

  Crs horizontal() const;                          ///< without its heights; @throws CrsError for heights alone
  std::optional<Crs> vertical() const;             ///< the vertical part alone of a compound CRS
  /// Compound of this CRS's horizontal part and the vertical part of `vertical`. @throws CrsError when that has none.
  Crs with_vertical(const Crs& vertical) const;
  Crs geographic_base() const;                     ///< the 2D geographic CRS it is defined on

  std::optional<LonLatArea> area_of_use() const;    ///< where the authority means the horizontal part to be used; none where it states nothing
  /// Largest relative error of a short length on the grid of a projected CRS against the ellipsoid: 0.0004 in the middle of a UTM zone;
  /// infinity where the projection does not reach.
  double length_distortion(const GeoPoint& place) const;
  std::vector<double> length_distortions(std::span<const GeoPoint> places) const;   ///< the same of many places, hardly dearer than of one

  bool equivalent_to(const Crs& other) const;
  /// Heights of both count from the same surface; units and direction may differ. False where one declares no vertical CRS.
  bool same_vertical_datum(const Crs& other) const;

  struct Impl;

 private:
  explicit Crs(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace priormap
