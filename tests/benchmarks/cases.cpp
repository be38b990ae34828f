#include "tests/benchmarks/cases.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>

#include "apps/samples/edits.h"
#include "apps/samples/meshes.h"
#include "apps/samples/scanner.h"
#include "engine/document/edit.h"
#include "engine/document/selection.h"
#include "engine/geometry/bounds.h"

namespace sinew::benchmarks {

double ref_seconds() {
  constexpr int n = 30;
  static const Eigen::SparseMatrix<double> laplacian = [] {
    std::vector<Eigen::Triplet<double>> entries;
    const auto index = [](int x, int y, int z) { return (x * n + y) * n + z; };
    for (int x = 0; x < n; ++x)
      for (int y = 0; y < n; ++y)
        for (int z = 0; z < n; ++z) {
          const int i = index(x, y, z);
          entries.emplace_back(i, i, 6);
          const int steps[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
          for (const auto& s : steps) {
            if (x + s[0] >= n || y + s[1] >= n || z + s[2] >= n) continue;
            const int j = index(x + s[0], y + s[1], z + s[2]);
            entries.emplace_back(i, j, -1);
            entries.emplace_back(j, i, -1);
          }
        }
    Eigen::SparseMatrix<double> L(n * n * n, n * n * n);
    L.setFromTriplets(entries.begin(), entries.end());
    return L;
  }();
  const auto start = std::chrono::steady_clock::now();
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  solver.analyzePattern(laplacian);
  solver.factorize(laplacian);
  CHECK(solver.info() == Eigen::Success);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Case animal_case(std::size_t points, std::size_t handles) {
  static std::map<std::size_t, std::shared_ptr<const Shape>> animals;
  std::shared_ptr<const Shape>& shape = animals[points];
  if (!shape) shape = std::make_shared<Shape>(samples::sample_animal(points));

  Case c;
  c.shape = shape;
  const Bounds bounds = bounds_of(shape->positions);
  c.diagonal = bounds.diagonal();
  std::vector<Index> by_height(shape->size());
  for (Index i = 0; i < by_height.size(); ++i) by_height[i] = i;
  std::sort(by_height.begin(), by_height.end(),
            [&](Index a, Index b) { return shape->positions[a].y() < shape->positions[b].y(); });

  // Spread over the lowest and the highest twentieth: the four feet, and the head.
  Handle handle;
  const std::size_t part = shape->size() / 20;
  c.held = handles / 2;
  for (std::size_t i = 0; i < handles; ++i) {
    const bool low = i < c.held;
    const std::size_t k = low ? i * part / c.held : (i - c.held) * part / (handles - c.held);
    const Index point = low ? by_height[k] : by_height[by_height.size() - 1 - k];
    handle.points.push_back(point);
    handle.targets.push_back(shape->positions[point]);
  }
  c.constraints.handles.push_back(std::move(handle));
  return c;
}

Constraints dragged(const Case& c, int steps, double share) {
  Constraints out = c.constraints;
  // A circle of radius 0.15 diagonals through the rest position, so that a drag of any length stays in reach.
  const double radius = 0.15 * c.diagonal, angle = steps * share / 0.15;
  const Vec3 offset = radius * Vec3(0.3 * (std::cos(angle) - 1), std::cos(angle) - 1, std::sin(angle));
  Handle& handle = out.handles[0];
  for (std::size_t i = c.held; i < handle.points.size(); ++i) handle.targets[i] += offset;
  return out;
}

BenchmarkEdit benchmark_edit(const std::string& name) {
  static const std::map<std::string, std::function<Shape()>> shapes = {
      {"plane", [] { return samples::bumpy_plane(); }},
      {"bar", [] { return samples::bar(); }},
      {"cactus", [] { return samples::cactus(); }},
      {"cylinder", [] { return samples::cylinder(); }}};
  return edit_of_shape(name, std::make_shared<Shape>(shapes.at(name)()));
}

BenchmarkEdit edit_of_shape(const std::string& name, std::shared_ptr<const Shape> shape) {
  const document::Project project = document::parse_edit(name + ".edit.json", samples::edit_of(name));
  document::Selector selector(shape);
  BenchmarkEdit out{shape, selector.constraints(project.layers.at(0), shape->positions)};
  return out;
}

}  // namespace sinew::benchmarks
