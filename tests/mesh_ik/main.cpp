// sinew-mesh-ik SHAPE EDIT.json OUT: does the first layer of an edit with examples by the original mesh-based inverse
// kinematics (tests/benchmarks/mesh_ik.h), the rest shape being an example as well. For the pictures that compare.

#include <cstdio>
#include <exception>

#include "engine/document/edit.h"
#include "engine/document/examples.h"
#include "engine/document/selection.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/benchmarks/mesh_ik.h"

namespace sinew::benchmarks {

namespace {

Shape bent(const std::shared_ptr<const Shape>& rest, const document::Layer& layer) {
  document::Selector selector(rest);
  const Constraints constraints = selector.constraints(layer, rest->positions);
  std::vector<Index> held = constraints.fixed;
  std::vector<Vec3> targets;
  for (const Index i : held) targets.push_back(rest->positions[i]);
  for (const Handle& handle : constraints.handles) {
    held.insert(held.end(), handle.points.begin(), handle.points.end());
    targets.insert(targets.end(), handle.targets.begin(), handle.targets.end());
  }
  std::vector<std::vector<Vec3>> examples{rest->positions};
  for (const io::NamedPose& pose : document::examples_of(layer, *rest, {})) {
    examples.push_back(pose.shape->positions);
    for (Vec3& p : examples.back()) p += pose.shape->origin - rest->origin;
  }
  const std::vector<Index> corners = triangles_of(rest->faces);
  std::vector<MeshIk::Triangle> triangles;
  for (std::size_t c = 0; c < corners.size(); c += 3) triangles.push_back({corners[c], corners[c + 1], corners[c + 2]});
  Shape out = *rest;
  const MeshIk::Answer answer =
      MeshIk(rest->positions, std::move(triangles), std::move(examples), std::move(held)).solve(targets);
  std::printf("%s after %d iterations; weights", answer.converged ? "converged" : "not converged", answer.iterations);
  for (const double w : answer.weights) std::printf(" %.3f", w);
  std::printf("\n");
  out.positions = answer.positions;
  return out;
}

}  // namespace

}  // namespace sinew::benchmarks

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: sinew-mesh-ik SHAPE EDIT.json OUT\n");
    return 2;
  }
  try {
    const std::shared_ptr<const sinew::Shape> rest = sinew::io::read(argv[1]);
    const sinew::document::Project edit = sinew::document::read_edit(argv[2]);
    sinew::io::write(argv[3], sinew::benchmarks::bent(rest, edit.layers.at(0)), true);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sinew-mesh-ik: %s\n", error.what());
    return 1;
  }
}
