#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <priormap/builder/prior_options.hpp>
#include <priormap/builder/sight_options.hpp>
#include <priormap/core/atomic_output.hpp>
#include <priormap/core/diagnostics.hpp>
#include <priormap/core/events.hpp>
#include <priormap/prior/prior_manifest.hpp>

namespace priormap {

/// How building models become points.
struct ModelOptions {
  int lod = 0;
  std::string faces = "visible";
  double sigma_m = 0.3;
  bool bridges = true;
  bool vegetation = false;
  double vegetation_sigma_m = 1;
  SightOptions sight;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("lod", lod, {"only this level of detail; 0: of each building the highest", "", 0, 4});
    visit("faces", faces, {"visible or all: visible leaves out what other buildings and parts cover, undersides and floors"});
    visit("sigma", sigma_m, {"standard deviation of the models' surfaces", "m", 0.001, 65});
    visit("bridges", bridges, {"bridges too, as points of class bridge"});
    visit("vegetation", vegetation, {"plants too, as points of class vegetation: crowns change with seasons and years"});
    visit("sigma-vegetation", vegetation_sigma_m, {"standard deviation of the plants' surfaces", "m", 0.001, 65});
    sight.describe(visit);
  }

  bool visible_faces_only() const { return faces == "visible"; }
  /// @throws UsageError for faces that are neither visible nor all.
  void validate() const;
};

struct ModelReport {
  PriorManifest manifest;
  std::size_t buildings = 0, bridges = 0, plants = 0, terrain_models = 0;   ///< that gave points
  std::size_t polygons = 0;
  std::optional<SightCounts> sight;   ///< with --visible-from
  Diagnostics diagnostics;
};

/// CityGML (.gml, .xml, .gz), CityJSON (.json) and CityJSONSeq (.jsonl) files to a prior. Files are streamed twice: first for the faces that
/// hide others (some 150 bytes a face stay in memory), then for the points. srsName counts per building; where a CRS names latitude or northing
/// first, the order counts that fits its area of use better, and where both fit alike the URN and URL forms of srsName mean the authority's.
/// @throws CrsError, FormatError, IoError, UsageError
ModelReport build_model_prior(const std::vector<std::filesystem::path>& files, const PriorOptions& prior_options, const ModelOptions& model_options,
                              const std::filesystem::path& output, Overwrite overwrite, const std::string& generator, int threads, const Events& events);

/// Lines for stdout: counts, points, CRS, diagnostics.
std::string to_text(const ModelReport& report);

}  // namespace priormap
