#pragma once
/// Choosing the nodes g_j of a deformation graph [Sumner et al. 2007, section 3, "layout of the deformation graph
/// nodes"].

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

/// Uniform sampling: of points dense on the surface, a random one is kept and all others within a radius of it are
/// removed, repeatedly; the radius is found by bisection, so that exactly `count` remain (fewer only where there are
/// fewer different points). The dense points are the shape's own (in a cloud, but for outliers), or random points on
/// its faces where it has faces but few points. `seed` chooses the random order; the result depends on nothing else but
/// the shape.
std::vector<Vec3> sample_nodes(const Shape& shape, std::size_t count, std::uint64_t seed);

/// The dense points that `count` nodes are sampled from, in random order: what sample_nodes starts with.
std::vector<Vec3> node_candidates(const Shape& shape, std::size_t count, std::uint64_t seed);

/// Quadric simplification that avoids long, thin triangles; the vertices that remain. For shapes with faces. `note`
/// says in one sentence what the simplification could not use (faces that would make the mesh non-manifold), else stays
/// empty.
std::vector<Vec3> simplify_to_nodes(const Shape& shape, std::size_t count, std::string& note);

}  // namespace sinew
