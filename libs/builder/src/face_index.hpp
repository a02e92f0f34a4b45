#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include <priormap/builder/bounds_index.hpp>

#include "model_faces.hpp"

namespace priormap {

/// The faces of all building models, to find the spots of a face that others hide: where another face touches it looking the other way (walls that buildings share, also
/// across a joint, a roof under what stands on it), and where the space right in front lies inside another solid, be it of another building or of the same. Where solids of a building
/// state one spot twice, the later keeps it: parts come after the body and are drawn in more detail. A polygon that several solids state bounds each of them,
/// and is hidden by none of its repetitions: they are not built.
/// Const members are thread-safe after `finish`.
class FaceIndex {
 public:
  /// The faces of one model, but for closures, which hide nothing.
  /// @param model  any number of its own
  void add(std::uint32_t model, const std::vector<ModelFace>& faces);
  /// Once, after the last `add`.
  void finish() { index_.sort(); }
  /// Removes the points of a face that others hide, and their normals. @param model  as in `add`
  void remove_hidden(std::uint32_t model, const ModelFace& face, std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& normals) const;

 private:
  struct Solid {
    std::uint32_t model;
    SolidKey key;
    bool closed;   ///< its faces enclose a space
  };
  struct IndexedFace {
    Eigen::Vector3f normal;
    std::uint32_t first, end;   ///< of its vertices; rings follow each other, each closed by its first vertex
    std::uint32_t solid;
    std::uint32_t shape;        ///< the first face of the model of the same vertices that looks the same way
    bool repeated;              ///< as ModelFace's
  };
  struct Candidate;
  class Spot;
  void add(const ModelFace& face, std::uint32_t solid);
  void find_repetitions(std::uint32_t first_face);
  Eigen::Vector3d vertex(std::uint32_t i) const { return 1e-3 * vertices_mm_[i].cast<double>(); }
  std::vector<Candidate> candidates(std::uint32_t model, const ModelFace& face) const;

  bool has_origin_ = false;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<Solid> solids_;
  std::vector<IndexedFace> faces_;
  std::vector<Eigen::Vector3i> vertices_mm_;   ///< from origin_
  BoundsIndex index_;                          ///< of faces_
};

}  // namespace priormap
