#include "apps/samples/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "engine/geometry/topology.h"

namespace sinew::samples {

namespace {

/// To 1e-7, as floats: the last bits of sines differ between mathematical libraries.
Vec3 rounded(double x, double y, double z) {
  const Vec3 decimals(std::round(x * 1e7), std::round(y * 1e7), std::round(z * 1e7));
  return (decimals / 1e7).cast<float>().cast<double>();
}

void add_quad(Faces& faces, Index a, Index b, Index c, Index d) {
  faces.add(std::array{a, b, c});
  faces.add(std::array{a, c, d});
}

}  // namespace

Shape bumpy_plane() {
  constexpr Index side = 201;
  constexpr int bumps = 12;
  constexpr double radius = 0.031, height = 0.030;
  Shape shape;
  for (Index row = 0; row < side; ++row)
    for (Index column = 0; column < side; ++column) {
      const double x = double(column) / (side - 1), z = double(row) / (side - 1);
      const auto from_bump = [](double u) {
        return (u * bumps - std::min(std::floor(u * bumps), bumps - 1.0) - 0.5) / bumps;
      };
      const double dx = from_bump(x), dz = from_bump(z);
      const double inside = std::max(0.0, 1 - (dx * dx + dz * dz) / (radius * radius));
      shape.positions.push_back(rounded(x, height * inside * inside, z));
    }
  for (Index row = 0; row + 1 < side; ++row)
    for (Index column = 0; column + 1 < side; ++column) {
      const Index a = row * side + column;
      add_quad(shape.faces, a, a + side, a + side + 1, a + 1);
    }
  return shape;
}

Shape bumpy_slab(int columns, int rows) {
  constexpr int bumps = 12;
  constexpr double thickness = 0.02, height = 0.015;
  Shape shape = samples::box({columns, 1, rows}, Vec3(1.0 / columns, thickness, 1.0 / rows));
  for (Vec3& p : shape.positions) {
    const double x = p.x() + 0.5, z = p.z() + 0.5;
    const double bump = std::sin(bumps * std::numbers::pi * x) * std::sin(bumps * std::numbers::pi * z);
    const bool upper = p.y() > 0.5 * thickness;
    p = rounded(x, upper ? height * bump * bump : -thickness, z);
  }
  return shape;
}

Shape bar() {
  return box({20, 66, 20}, Vec3::Constant(0.025));
}

Shape box(const std::array<int, 3>& cells, const Vec3& cell) {
  Shape shape;
  std::map<std::array<int, 3>, Index> vertices;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [entry, fresh] = vertices.try_emplace(at, static_cast<Index>(shape.size()));
    if (fresh)
      shape.positions.push_back(
          rounded((at[0] - 0.5 * cells[0]) * cell[0], at[1] * cell[1], (at[2] - 0.5 * cells[2]) * cell[2]));
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
    for (const bool far : {false, true})
      for (int i = 0; i < cells[u]; ++i)
        for (int j = 0; j < cells[v]; ++j) {
          std::array<int, 3> at{};
          at[static_cast<std::size_t>(axis)] = far ? cells[static_cast<std::size_t>(axis)] : 0;
          const auto corner = [&](int di, int dj) {
            at[u] = i + di;
            at[v] = j + dj;
            return vertex(at);
          };
          const Index a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (far)
            add_quad(shape.faces, a, b, c, d);
          else
            add_quad(shape.faces, a, d, c, b);
        }
  }
  return shape;
}

Shape cylinder() {
  return cylinder(48, 6, 88);
}

Shape cylinder(Index around, Index cap_rings, Index body_rings) {
  constexpr double radius = 0.1, length = 1.15;
  Shape shape;
  const auto add_ring = [&](double r, double y) {
    for (Index i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      shape.positions.push_back(rounded(r * std::cos(angle), y, r * std::sin(angle)));
    }
  };
  shape.positions.push_back(rounded(0, 0, 0));
  for (Index k = 1; k <= cap_rings; ++k) add_ring(radius * k / (cap_rings + 1), 0);
  for (Index k = 0; k < body_rings; ++k) add_ring(radius, length * k / (body_rings - 1));
  for (Index k = cap_rings; k >= 1; --k) add_ring(radius * k / (cap_rings + 1), length);
  shape.positions.push_back(rounded(0, length, 0));

  const Index rings = 2 * cap_rings + body_rings;
  const auto at = [around](Index ring, Index i) { return 1 + ring * around + i % around; };
  const Index last = static_cast<Index>(shape.size() - 1);
  for (Index i = 0; i < around; ++i) {
    shape.faces.add(std::array{Index{0}, at(0, i), at(0, i + 1)});
    for (Index ring = 0; ring + 1 < rings; ++ring)
      add_quad(shape.faces, at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1));
    shape.faces.add(std::array{last, at(rings - 1, i + 1), at(rings - 1, i)});
  }
  return shape;
}

Shape cactus() {
  return cactus(0.0148);
}

Shape cactus(double cell) {
  const std::vector<Capsule> parts{
      {.a = {0, 0.095, 0}, .b = {0, 0.90, 0}, .ra = 0.095, .rb = 0.085, .blend = 0.05},
      {.a = {0, 0.36, 0}, .b = {0.225, 0.42, 0}, .ra = 0.055, .rb = 0.056, .blend = 0.05},
      {.a = {0.225, 0.42, 0}, .b = {0.245, 0.68, 0}, .ra = 0.056, .rb = 0.052, .blend = 0.03},
      {.a = {0, 0.52, 0}, .b = {-0.200, 0.57, 0}, .ra = 0.050, .rb = 0.052, .blend = 0.05},
      {.a = {-0.200, 0.57, 0}, .b = {-0.220, 0.77, 0}, .ra = 0.052, .rb = 0.048, .blend = 0.03}};
  return polygonized(Implicit(parts), cell);
}

namespace {

/// Values of a surface at the corners of a grid of cells that encloses it.
struct Grid {
  Vec3 corner;
  double cell;
  std::array<int, 3> count;  ///< of corners
  std::vector<double> values;

  std::size_t index(const std::array<int, 3>& at) const {
    return (static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(count[1]) + static_cast<std::size_t>(at[1])) *
               static_cast<std::size_t>(count[0]) +
           static_cast<std::size_t>(at[0]);
  }
  double value(const std::array<int, 3>& at) const { return values[index(at)]; }
  Vec3 point(const std::array<int, 3>& at) const { return corner + cell * Vec3(at[0], at[1], at[2]); }
};

Grid grid_of(const Implicit& surface, double cell) {
  Grid grid;
  grid.cell = cell;
  // Not a whole number of cells below the box: a face of the surface must not run along corners.
  grid.corner = surface.bounds().min - Vec3::Constant(1.37 * cell);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto axis = static_cast<Eigen::Index>(c);
    grid.count[c] = static_cast<int>(std::ceil((surface.bounds().max[axis] - grid.corner[axis]) / cell)) + 2;
  }
  const Implicit::Parts parts = surface.all();
  for (int z = 0; z < grid.count[2]; ++z)
    for (int y = 0; y < grid.count[1]; ++y)
      for (int x = 0; x < grid.count[0]; ++x) grid.values.push_back(surface.distance(grid.point({x, y, z}), parts));
  return grid;
}

/// The mean of the places where the surface crosses the edges of the cell at `at`.
Vec3 mean_crossing(const Grid& grid, const std::array<int, 3>& at) {
  Vec3 sum = Vec3::Zero();
  int crossings = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 4; ++side) {
      std::array<int, 3> from = at;
      from[(axis + 1) % 3] += side & 1;
      from[(axis + 2) % 3] += side >> 1;
      std::array<int, 3> to = from;
      ++to[axis];
      const double a = grid.value(from), b = grid.value(to);
      if ((a < 0) == (b < 0)) continue;
      sum += grid.point(from) + a / (a - b) * (grid.point(to) - grid.point(from));
      ++crossings;
    }
  return sum / crossings;
}

/// Each vertex to the mean of its neighbours and back onto the surface, a few times: evens out the triangles.
void relax(Shape& shape, const Implicit& surface) {
  const Implicit::Parts parts = surface.all();
  const auto edges = edges_of(shape.faces);
  for (int round = 0; round < 8; ++round) {
    std::vector<Vec3> sum(shape.size(), Vec3::Zero());
    std::vector<int> count(shape.size(), 0);
    for (const auto& [a, b] : edges) {
      sum[a] += shape.positions[b];
      sum[b] += shape.positions[a];
      ++count[a];
      ++count[b];
    }
    for (std::size_t i = 0; i < shape.size(); ++i) {
      Vec3& p = shape.positions[i];
      p = sum[i] / count[i];
      for (int step = 0; step < 2; ++step) p -= surface.distance(p, parts) * surface.normal(p, parts);
    }
  }
}

}  // namespace

Shape polygonized(const Implicit& surface, double cell) {
  const Grid grid = grid_of(surface, cell);
  Shape shape;
  std::map<std::size_t, Index> vertices;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [entry, fresh] = vertices.try_emplace(grid.index(at), static_cast<Index>(shape.size()));
    if (fresh) shape.positions.push_back(mean_crossing(grid, at));
    return entry->second;
  };
  std::array<int, 3> at{};
  for (at[2] = 1; at[2] + 1 < grid.count[2]; ++at[2])
    for (at[1] = 1; at[1] + 1 < grid.count[1]; ++at[1])
      for (at[0] = 1; at[0] + 1 < grid.count[0]; ++at[0])
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::array<int, 3> next = at;
          ++next[axis];
          const bool inside = grid.value(at) < 0;
          if (inside == (grid.value(next) < 0)) continue;
          const auto cell_at = [&](int du, int dv) {
            std::array<int, 3> c = at;
            c[(axis + 1) % 3] -= du;
            c[(axis + 2) % 3] -= dv;
            return vertex(c);
          };
          const Index a = cell_at(1, 1), b = cell_at(0, 1), c = cell_at(0, 0), d = cell_at(1, 0);
          if (inside)
            add_quad(shape.faces, a, b, c, d);
          else
            add_quad(shape.faces, a, d, c, b);
        }
  relax(shape, surface);
  for (Vec3& p : shape.positions) p = rounded(p.x(), p.y(), p.z());
  return shape;
}

}  // namespace sinew::samples
