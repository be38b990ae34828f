#pragma once
/// Which nodes of a deformation graph a point follows: by straight distance or by distance along the surface, and not
/// through a cut [Sumner et al. 2007, section 3, eq. 4, and section 6].

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/curtains.h"
#include "engine/geometry/deformer.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/neighbour_graph.h"

namespace sinew {

struct InfluenceOptions {
  int neighbours = 4;       ///< k of eq. 4
  bool surface = false;     ///< distances along the surface (surface_distance.h) instead of straight ones
  std::vector<Cut> cuts{};  ///< no influence passes through these
};

/// Straight: node_weights of graph_weights.h, for the shape's points and for any others.
///
/// Surface: eq. 4 with the distances of nearest_along_surface for the shape's points; one that reaches no node follows
/// by straight distance. Weights are then no function of space, so another point v takes the blend of the rows of the
/// nearest 4 points p_i of the shape that no curtain parts from it, where d_i = |v - p_i| and D is the distance to the
/// fifth:
///
///   ((1 - d_i / D) / d_i)^2, divided by their sum
///
/// which at p_i itself is that point's row. The points that are kept for this are all of the shape, or 20,000 spread
/// evenly over their order. No gradients.
class GraphInfluence {
 public:
  /// Throws InputError where a cut is not finite. `nodes` are finite.
  GraphInfluence(std::vector<Vec3> nodes, InfluenceOptions options);

  /// Weights of the shape's points, and the edges of the graph: between any two nodes that influence one common point
  /// of the shape or of its surface between the points (surface_edge_length: a box of 8 points would else fall apart
  /// at its edges).
  struct Bound {
    SkinWeights weights;
    std::vector<std::pair<Index, Index>> edges;
  };
  /// Call once, before anything else. Empty where progress (0..1) said false. Says in `notes` what followed another
  /// way.
  std::optional<Bound> bind_shape(const Shape& shape, std::vector<std::string>& notes,
                                  const std::function<bool(double)>& progress = {});

  /// Weights of other points of the same space.
  SkinWeights bind(std::span<const Vec3> points, Gradients gradients) const;

  /// Nodes and shape of another frame (Deformer::follow): cuts go where their nearest nodes went since all was made.
  void follow(std::vector<Vec3> nodes, const Shape& shape);

  /// Deformer::binding: "nodes", "neighbours"; with cuts "cuts" (the path's points, 6 columns: point and depth) and
  /// "cut_lengths" (points of each path); with surface distance "points", "points_rows" (influences of each) and
  /// "points_influences" (node, weight).
  std::vector<Deformer::Table> tables() const;
  /// Throws InputError where the tables are not such.
  static GraphInfluence from_tables(const std::vector<Deformer::Table>& tables);

 private:
  SkinWeights straight(std::span<const Vec3> points, Gradients gradients, std::size_t* cut_off,
                       const std::function<bool(double)>& progress) const;
  std::optional<Bound> bind_straight(const Shape& shape, std::vector<std::string>& notes,
                                     const std::function<bool(double)>& progress) const;
  std::optional<Bound> bind_along_surface(const Shape& shape, std::vector<std::string>& notes,
                                          const std::function<bool(double)>& progress);
  /// Rows of the places, then of the points between; empty where progress said false.
  std::optional<SkinWeights> surface_rows(const Shape& shape, const Places& places, std::vector<std::string>& notes,
                                          const std::function<bool(double)>& progress) const;
  void keep_sample(const Shape& shape, const SkinWeights& weights);
  SkinWeights blended(std::span<const Vec3> points) const;

  /// Where all was before the first follow().
  struct Made {
    std::vector<Cut> cuts;
    std::vector<Vec3> nodes, sample;
  };

  InfluenceOptions options_;
  Curtains curtains_;
  NearestTree nodes_;
  NearestTree sample_;  ///< points of the shape that others are bound to; none under straight distance
  std::vector<Index> sample_of_shape_;
  SkinWeights sample_weights_;
  std::shared_ptr<const Made> made_;
};

}  // namespace sinew
