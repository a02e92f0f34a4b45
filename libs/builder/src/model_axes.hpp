#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include <priormap/geodesy/crs.hpp>
#include <priormap/geodesy/geo_point.hpp>
#include <priormap/sources/building_model.hpp>

namespace priormap {

/// The CRS that an srsName means; nothing where there is none, or --source-crs replaces one that is unknown. @throws CrsError
std::optional<Crs> declared_crs(const std::string& srs_name, const std::string& file, bool overridden);

/// As the file writes it. @throws FormatError where the model has none
Eigen::Vector3d first_point(const BuildingModel& model, const std::string& file);

Eigen::Vector3d swapped(const Eigen::Vector3d& p);

/// Longitude and latitude of a place; nothing where the CRS does not reach it, found by the way there and back.
std::optional<GeoPoint> reach(const Crs& crs, const Eigen::Vector3d& place);

/// Data may follow the authority's axis order: the URN and URL forms of srsName say so. Files that name a CRS that way and still write the
/// easting first are common, and so is the reverse: the order that fits the CRS better counts, and the form of the name where both fit alike.
bool northing_comes_first(const std::string& srs_name, const Crs& crs, const Eigen::Vector3d& place);
/// A place of a file with its axes in the order that it has by that.
Eigen::Vector3d easting_first(const std::string& srs_name, const Crs& crs, const Eigen::Vector3d& place);

}  // namespace priormap
