#pragma once
#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <priormap/builder/prior_crs.hpp>
#include <priormap/geodesy/transformer.hpp>
#include <priormap/sources/building_model.hpp>

namespace priormap {

/// What the manifest says of the coordinates of one file.
struct ModelSourceFrame {
  std::string crs_name;
  std::string assumed_vertical;
  CoordinateOperation operation;
};

/// The place, as the file writes it, by which the order of axes and the operation of an srsName are judged: by srsName and file.
using DecidingPlaces = std::map<std::pair<std::string, std::string>, Eigen::Vector3d>;

/// The way from each srsName to the prior's CRS, which the first building decides where the user does not. Not thread-safe.
class ModelFrames {
 public:
  /// @param place  of the first building, as the file writes it  @param deciding  where there is none, the first building of an srsName decides
  /// @throws CrsError when the building's srsName is missing or unknown and --source-crs does not help.
  ModelFrames(const PriorOptions& options, const std::string& srs_name, const Eigen::Vector3d& place, const std::string& file, DecidingPlaces deciding, const Events& events);

  const Crs& prior() const { return *prior_; }
  /// Turns axes and coordinates of a building into the prior's, in place. Polygons with a point outside the operation's reach are emptied.
  /// @throws CrsError where its heights are declared and those of the first are not, or the other way round, or in another vertical CRS and none is asked for.
  void to_prior(BuildingModel& model, const std::string& file);
  ModelSourceFrame source(const BuildingModel& model, const std::string& file) { return frame_of(model, file).source; }

 private:
  struct Frame {
    Crs crs;
    std::optional<Transformer> to_prior;   ///< none: the same CRS
    ModelSourceFrame source;
  };
  Frame& frame_of(const BuildingModel& model, const std::string& file);
  bool swaps_axes(const BuildingModel& model, const std::string& file);
  Eigen::Vector3d deciding_place(const BuildingModel& model, const std::string& file) const;

  const PriorOptions& options_;
  const Events& events_;
  DecidingPlaces deciding_;
  std::optional<InputCrs> first_;
  std::optional<Crs> prior_;
  std::map<std::string, Frame> frames_;                                ///< by srsName
  std::map<std::pair<std::string, std::string>, bool> swaps_axes_;     ///< by srsName and file: writers differ in the order under one name
};

}  // namespace priormap
