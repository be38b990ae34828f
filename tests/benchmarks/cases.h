#pragma once
/// The cases that the benchmarks time, and the measure that makes figures comparable between machines.

#include <memory>
#include <string>

#include "engine/geometry/deformer.h"

namespace sinew::benchmarks {

/// REF: Eigen's SimplicialLDLT, analyse and factorize, of the 7-point Laplacian on a 30 x 30 x 30 grid. Seconds of one
/// run.
double ref_seconds();

/// A shape and what is done to it: points held where they are and points moved, all of them handles, so that no node
/// drops out of the unknowns.
struct Case {
  std::shared_ptr<const Shape> shape;
  Constraints constraints;  ///< at rest
  std::size_t held = 0;     ///< of the handle's points, the first so many are held
  double diagonal = 1;
};

/// The sample animal with so many points; its feet are held and its head is moved, `handles` points in all.
Case animal_case(std::size_t points, std::size_t handles);

/// `constraints` of the case after `steps` mouse moves of `share` of the diagonal each, on a circle to the side and
/// down.
Constraints dragged(const Case& c, int steps, double share);

/// A sample of the four Botsch-Sorkine shapes ("plane", "bar", "cactus", "cylinder") with its edit at the end.
struct BenchmarkEdit {
  std::shared_ptr<const Shape> shape;
  Constraints constraints;
};
BenchmarkEdit benchmark_edit(const std::string& name);
/// The edit of a sample, done to another shape that lies as the sample does.
BenchmarkEdit edit_of_shape(const std::string& name, std::shared_ptr<const Shape> shape);

}  // namespace sinew::benchmarks
