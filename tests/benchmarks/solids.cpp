#include "tests/benchmarks/solids.h"

#include <cmath>
#include <numbers>

#include "apps/samples/meshes.h"
#include "engine/geometry/bounds.h"

namespace sinew::benchmarks {

namespace {

constexpr SolidRow rows[] = {
    {"Bar", "bar", 0, 857, 2289, 0.039, 0, 0, 120, 0},
    {"Bumpy bar", "bar", 0, 1440, 4302, 0.074, 0, 0, 85, 0},
    {"Plane", "plane", 0, 5066, 16028, 0.331, 0, 0, 20, 0},
    {"Cylinder", "cylinder", 0, 7235, 23831, 0.565, 0, 0, 12, 0},
    {"Man", "cactus", 39771, 3474, 12324, 0.241, 42.8, 0.179, 24, 0.0052776},
    {"Dragon", "cactus", 100004, 3021, 9802, 0.128, 94.5, 0.442, 37, 0.0033282},
    {"Raptor", "cactus", 175100, 2512, 9372, 0.136, 167.6, 0.965, 37, 0.0025149},
    {"Armadillo", "cactus", 195948, 1688, 5373, 0.084, 96.0, 0.484, 57, 0.0023775},
};

/// The bar with waves on its sides.
Shape bumpy_bar() {
  constexpr std::array<int, 3> cells{10, 31, 10};
  Shape shape = samples::box(cells, Vec3(0.05, 1.65 / 31, 0.05));
  for (Vec3& p : shape.positions) {
    const double wave = 1 + 0.12 * std::sin(6 * std::numbers::pi * p.y() / 1.65);
    p.x() *= wave;
    p.z() *= wave;
  }
  return shape;
}

}  // namespace

std::span<const SolidRow> solid_rows() {
  return rows;
}

std::shared_ptr<const Shape> solid_shape(const SolidRow& row) {
  const std::string name = row.name;
  if (name == "Bar") return std::make_shared<Shape>(samples::box({7, 27, 7}, Vec3(0.5 / 7, 1.65 / 27, 0.5 / 7)));
  if (name == "Bumpy bar") return std::make_shared<Shape>(bumpy_bar());
  if (name == "Plane") return std::make_shared<Shape>(samples::bumpy_slab(46, 53));
  if (name == "Cylinder") return std::make_shared<Shape>(samples::cylinder(57, 7, 110));
  return std::make_shared<Shape>(samples::cactus(row.cell));
}

Case solid_case(const SolidRow& row) {
  Case c;
  c.shape = solid_shape(row);
  c.constraints = edit_of_shape(row.edit, c.shape).constraints;
  for (Handle& handle : c.constraints.handles) {
    handle.turn.reset();
    for (std::size_t i = 0; i < handle.points.size(); ++i) handle.targets[i] = c.shape->positions[handle.points[i]];
  }
  c.diagonal = bounds_of(c.shape->positions).diagonal();
  return c;
}

}  // namespace sinew::benchmarks
