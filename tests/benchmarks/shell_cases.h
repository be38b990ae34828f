#pragma once
/// What the tables of shells are made of: poses in correspondence, and what is held of them.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "deformers/shell_mesh.h"
#include "tests/benchmarks/cases.h"

namespace sinew::benchmarks {

struct ShellPoses {
  std::string name;
  std::shared_ptr<const Shape> rest;
  std::vector<std::string> names;
  std::vector<std::shared_ptr<const Shape>> poses;  ///< relative to the rest's origin
};
/// Our foal, with cells of this size.
ShellPoses posed_foal(double cell);
/// The poses of a folder of the shared data ("horse", "lion"), where that is there.
std::optional<ShellPoses> poses_of_data(const std::string& name);

/// So many patches of so many vertices: centres are farthest from those before, the first is vertex 0, and a patch has
/// the vertices nearest to its centre, by the length of edges along the mesh.
std::vector<std::vector<Index>> patches_along(const Shape& shape, std::size_t count, std::size_t size);

/// The hooves of the foal stay, its muzzle is a handle, where dragged() moves it.
Case held_foal(std::shared_ptr<const Shape> foal);

std::vector<Triangle> triangle_list(const Shape& shape);

/// The larger of the distances of each one's vertices to the other's surface.
double hausdorff(std::span<const Vec3> a, std::span<const Vec3> b, const std::vector<Triangle>& triangles);

/// Root of the mean of squared distances.
double rms_between(std::span<const Vec3> a, std::span<const Vec3> b);

/// Where the points of the shape are in the deformer's pose.
std::vector<Vec3> bent_by(const Deformer& deformer, const Shape& shape);

}  // namespace sinew::benchmarks
