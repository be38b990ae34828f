#pragma once
/// A solved edit as a small file that bends any other file of the same space without solving: for each layer the tables
/// that bind points (Deformer::binding) and the maps. JSON; every number reads back as the same double.
///
///   { "sinew_pose": 1, "origin": [x, y, z],
///     "layers": [ { "method": "graph", "binding": [ { "name": "nodes", "columns": 3, "values": [...] } ],
///                   "maps": [ [12 numbers, a 3x4 matrix row by row] ] } ] }
///
/// Tables and maps are relative to "origin", which is in the coordinates of the solve's input.

#include <span>
#include <string>
#include <vector>

#include "engine/document/evaluate.h"
#include "engine/geometry/deformer.h"

namespace sinew::document {

struct SolvedLayer {
  std::string method;
  std::vector<Deformer::Table> binding;
  Pose maps;
};

struct SolvedEdit {
  Vec3 origin = Vec3::Zero();
  std::vector<SolvedLayer> layers;
};

SolvedEdit solved_edit(const Evaluation& evaluation, std::span<const Layer> layers);

std::string solved_edit_text(const SolvedEdit& edit);
/// Throws InputError with PATH:LINE:COL.
SolvedEdit parse_solved_edit(const std::string& path, std::string text);

/// Moves a solved edit to another origin, so that it acts on positions relative to that. A point that no map moves
/// keeps its bits.
class PoseApplier {
 public:
  /// `methods` must outlive the applier. Throws InputError where a method is unknown or refuses its tables.
  PoseApplier(const SolvedEdit& edit, std::span<const Method> methods, const Vec3& origin);

  /// Bends a shape, or a block of a stream, whose origin is that of the constructor: positions and attributes.
  /// May be called from several threads at once.
  Shape apply(const Shape& shape) const;

 private:
  struct LayerMaps {
    const Method* method;
    std::vector<Deformer::Table> binding;  ///< relative to the edit's origin
    Pose maps;                             ///< relative to the shape's origin
  };
  Vec3 offset_;  ///< shape's origin - edit's origin
  std::vector<LayerMaps> layers_;
};

}  // namespace sinew::document
